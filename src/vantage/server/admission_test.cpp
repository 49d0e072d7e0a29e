#include "vantage/server/admission.hpp"

#include <gmock/gmock.h>

namespace vantage {
namespace {

const std::string token = "0123456789abcdefXYZ";

int status_of(const Caller& caller, const std::string& expected) {
  const auto refusal = why_refused(caller, expected, "vantage-1");
  return refusal ? refusal->status : 200;
}

TEST(Admission, SecretsAreTheSameOnlyWhereEveryCharacterIs) {
  EXPECT_TRUE(same_secret(token, token));
  EXPECT_TRUE(same_secret("", ""));
  EXPECT_FALSE(same_secret("", token));
  EXPECT_FALSE(same_secret(token, ""));
  EXPECT_FALSE(same_secret(token + token, token)) << "repeated";
  EXPECT_FALSE(same_secret(token.substr(0, 18), token));
  int cases = 0;
  for (std::size_t i = 0; i < token.size(); ++i, ++cases) {
    std::string other = token;
    other[i] = '-';
    EXPECT_FALSE(same_secret(other, token));
  }
  EXPECT_EQ(cases, 19);
}

TEST(Admission, WithoutATokenTheRequestMustNameThisMachine) {
  for (const char* host : {"localhost", "LOCALHOST:80", "127.0.0.1:8350", "127.5.6.7", "[::1]:8350"})
    EXPECT_EQ(status_of({.host = host}, ""), 200) << host;
  for (const char* host : {"", "example.org", "192.168.0.2", "127.example.org", "localhost.example.org"})
    EXPECT_EQ(status_of({.host = host}, ""), 403) << host;
}

TEST(Admission, TheTokenComesInThreeWays) {
  const Caller stranger{.host = "robot.example"};
  EXPECT_EQ(status_of(stranger, token), 401);
  Caller caller = stranger;
  caller.query_token = token;
  EXPECT_EQ(status_of(caller, token), 200);
  caller = stranger;
  caller.cookies = "vantage-2=" + token;
  EXPECT_EQ(status_of(caller, token), 401) << "the cookie of another server";
  caller.cookies += "; vantage-1=" + token;
  EXPECT_EQ(status_of(caller, token), 200);
  caller = stranger;
  caller.authorization = "Basic " + token;
  EXPECT_EQ(status_of(caller, token), 401);
  caller.authorization = "Bearer " + token;
  EXPECT_EQ(status_of(caller, token), 200);
}

TEST(Admission, PagesOfOtherServersAreRefusedEvenWithTheToken) {
  Caller caller{.host = "robot.example:8350", .origin = "http://robot.example:8350", .query_token = token};
  EXPECT_EQ(status_of(caller, token), 200);
  for (const char* origin : {"http://evil.example", "null", "http://robot.example", "http://evil-robot.example:8350"}) {
    caller.origin = origin;
    EXPECT_EQ(status_of(caller, token), 403) << origin;
  }
}

}  // namespace
}  // namespace vantage
