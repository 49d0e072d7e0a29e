#include "vantage/server/multipart.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& body, const std::string& boundary = "B") {
  return input_error_of([&] { (void)parse_multipart(body, boundary); });
}

TEST(Multipart, FindsThePartsOfABody) {
  // The example of RFC 7578, section 4.3, without its nesting, and a body with dashes and line ends in it.
  const std::string body =
      "--AaB03x\r\ncontent-disposition: form-data; name=\"field1\"\r\n\r\nJoe Blow\r\n--AaB03x\r\n"
      "Content-Type: text/plain\r\nContent-Disposition: form-data; name=\"pics\"; filename=\"file1.txt\"\r\n\r\n"
      "--AaB03x2\r\n\r\n--\r\n--AaB03x--\r\n";
  const std::vector<FormPart> parts = parse_multipart(body, "AaB03x");
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].name, "field1");
  EXPECT_EQ(parts[0].body, "Joe Blow");
  EXPECT_EQ(parts[1].file_name, "file1.txt");
  EXPECT_EQ(parts[1].body, "--AaB03x2\r\n\r\n--");
  EXPECT_THAT(refusal(body.substr(0, body.size() - 12), "AaB03x"), HasSubstr("is cut off"));
}

TEST(Multipart, TakesWhatRfc2046Allows) {
  const std::string bare = "\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\n1\r\n--B--";
  const std::string folded =
      "--B\r\nContent-Disposition: form-data;\r\n\tname=\"a\";\r\n filename=x.ply\r\n\r\n1\r\n--B--";
  const std::string many =
      "--B\r\nX-Other: y\r\nCONTENT-DISPOSITION : form-data; NAME=\"a\"\r\nContent-Transfer-Encoding: "
      "Binary\r\n\r\n1\r\n--B--";
  int cases = 0;
  for (const std::string& body : {"--B" + bare, "\r\n--B" + bare, "a preamble\r\n--Bee\r\n--B" + bare, "--B \t " + bare,
                                  "--B" + bare + "\r\n", "--B" + bare + " \r\nan epilogue\r\n--B\r\n", folded, many}) {
    const std::vector<FormPart> parts = parse_multipart(body, "B");
    ASSERT_EQ(parts.size(), 1U) << body;
    EXPECT_EQ(parts[0].name, "a") << body;
    EXPECT_EQ(parts[0].body, "1") << body;
    ++cases;
  }
  EXPECT_EQ(cases, 8);
  EXPECT_EQ(parse_multipart(folded, "B")[0].file_name, "x.ply");
  EXPECT_EQ(parse_multipart("--B\r\nContent-Disposition: form-data; name=a\r\n\r\n\r\n--B--", "B")[0].body, "");
  EXPECT_THAT(parse_multipart("--B--\r\n", "B"), testing::IsEmpty());
}

TEST(Multipart, RefusesWhatItIsNot) {
  const std::string one = "--B\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\n1\r\n";
  EXPECT_THAT(refusal(""), HasSubstr("has no line with the boundary of the header Content-Type, B"));
  EXPECT_THAT(refusal(one + "--B--", ""), HasSubstr("has no boundary"));
  EXPECT_THAT(refusal(one + "--B--", std::string(71, 'B')), HasSubstr("must have 1 to 70"));
  EXPECT_THAT(refusal(one + one + "--B--"), HasSubstr("two parts 'a'"));
  EXPECT_THAT(refusal(one), HasSubstr("part 1 is cut off"));
  EXPECT_THAT(refusal("--B\r\n\r\n1\r\n--B--"), HasSubstr("no Content-Disposition with a name"));
  EXPECT_THAT(refusal("--B\r\nContent-Disposition: form-data; name=a\r\n--B--"), HasSubstr("is cut off"));
  EXPECT_THAT(
      refusal("--B\r\nContent-Disposition: form-data; name=a\r\nContent-Transfer-Encoding: base64\r\n\r\n1\r\n--B--"),
      HasSubstr("Content-Transfer-Encoding = base64: must be binary"));
  EXPECT_THAT(refusal("--B\r\nX: " + std::string(5000, 'x') + "\r\n\r\n1\r\n--B--"), HasSubstr("more than 4096 bytes"));
  std::string many;
  for (char name = 'a'; name < 'a' + 17; ++name)
    many += std::string("--B\r\nContent-Disposition: form-data; name=") + name + "\r\n\r\n1\r\n";
  EXPECT_THAT(refusal(many + "--B--"), HasSubstr("more than 16 parts"));
}

TEST(Multipart, ParametersOfAHeader) {
  for (const auto& [header, name, value] :
       {std::tuple{"form-data; name=\"depth\"; filename=\"a.png\"", "name", "depth"},
        {"form-data; name=depth", "name", "depth"},
        {"form-data;name=depth;filename=a.png", "filename", "a.png"},
        {"form-data ; NAME = \"depth\" ; filename = a.png ", "filename", "a.png"},
        {"form-data; filename=\"x; name=wrong\"; name=right", "name", "right"},
        {"form-data; filename=\"a \\\"b\\\" \\\\ c\"; name=x", "filename", "a \"b\" \\ c"},
        {"form-data; filename=\"C:\\scans\\a.ply\"", "filename", "C:\\scans\\a.ply"},
        {"form-data; filename=plain.ply; filename*=utf-8''other.ply", "filename", "plain.ply"},
        {"form-data; flag; name=x", "name", "x"},
        {"form-data; myname=x", "name", ""},
        {"form-data", "name", ""},
        {"form-data; name", "name", ""},
        {"form-data; name=\"open", "name", "open"},
        {"multipart/form-data; charset=utf-8; boundary=\"a b\"", "boundary", "a b"},
        {"multipart/form-data; Boundary=----WebKit7", "boundary", "----WebKit7"}})
    EXPECT_EQ(header_parameter(header, name), value) << header;
}

}  // namespace
}  // namespace vantage
