// What clients can do to the server with the bytes that they send, or do not send.
#include "vantage/server/http_connections.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <future>
#include <thread>

#include "vantage/core/error.hpp"
#include "vantage/server/live_run.hpp"

namespace vantage {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using testing::HasSubstr;
using testing::StartsWith;

const std::string token = "0123456789abcdefXYZ";

/// A connection that sends what a test wants.
class Raw {
 public:
  explicit Raw(const HttpServer& server) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(server.port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{.tv_sec = 20, .tv_usec = 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw Error("no connection");
  }
  Raw(Raw&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}
  Raw(const Raw&) = delete;
  Raw& operator=(const Raw&) = delete;
  Raw& operator=(Raw&&) = delete;
  ~Raw() { ::close(socket_); }

  /// Whether the server took it.
  bool send(std::string_view text) {
    while (!text.empty()) {
      const auto sent = ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      text.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  /// Everything up to the end of the connection.
  std::string receive() {
    std::string all;
    std::string part(65536, '\0');
    for (ssize_t got = 0; (got = ::recv(socket_, part.data(), part.size(), 0)) > 0;)
      all.append(part, 0, static_cast<std::size_t>(got));
    return all;
  }

 private:
  int socket_;
};

/// Megabytes of memory that this process has.
double resident() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

HttpAnswer said(std::string text) { return {.body = std::make_shared<const std::string>(std::move(text))}; }

struct ServedRoutes {
  LiveRun run;
  HttpServer server;
  std::atomic<bool> holds = false;
  std::atomic<int> entered = 0;  // requests to /echo

  explicit ServedRoutes(HttpServerOptions options = {}) : server(std::move(options)) {
    server.add({.path = "/short", .handle = [](const HttpRequest&) { return said("a short answer"); }});
    const auto long_text = std::make_shared<const std::string>(std::size_t{64} << 20U, 'x');
    server.add({.path = "/long",
                .handle = [long_text](const HttpRequest&) { return HttpAnswer{.body = long_text}; },
                .at_once = 1});
    server.add({.method = HttpRoute::Method::post, .path = "/echo", .handle = [this](const HttpRequest& request) {
                  ++entered;
                  while (holds) std::this_thread::sleep_for(1ms);
                  return said(request.body);
                }});
    server.add_events("/events", run);
    server.start();
  }
  ~ServedRoutes() { holds = false; }

  std::string get(const std::string& path, const std::string& headers = "Host: localhost\r\n") {
    Raw client(server);
    client.send("GET " + path + " HTTP/1.1\r\n" + headers + "\r\n");
    return client.receive();
  }
};

TEST(HttpConnections, NoRangeShowsMoreOrLessThanTheWholeAnswer) {
  ServedRoutes open;
  ServedRoutes closed(HttpServerOptions{.token = token});
  const std::string bearer = "Authorization: Bearer " + token + "\r\n";
  int cases = 0;
  for (ServedRoutes* each : {&open, &closed}) {
    for (const char* path : {"/short", "/nothing", "/echo", "/short?token=0123456789abcdefXYZ"}) {
      for (const std::string& known : {std::string(), bearer}) {
        const std::string headers = "Host: localhost\r\n" + known, whole = each->get(path, headers);
        EXPECT_THAT(whole, HasSubstr("Accept-Ranges: none")) << path;
        for (const char* range : {"bytes=0-3", "bytes=5-", "bytes=-4", "bytes=100-4195", "bytes=100000-265535",
                                  "bytes=0-1,3-4,9000-9999", "bytes=9-1", "bytes=0-18446744073709551615", "bytes=-0",
                                  "bytes=", "bytes=x-y", "lines=1-2", "bytes=1-2;bytes=3-4"}) {
          EXPECT_EQ(each->get(path, headers + "Range: " + range + "\r\nIf-Range: \"x\"\r\n"), whole) << path << range;
          ++cases;
        }
      }
    }
  }
  EXPECT_EQ(cases, 2 * 4 * 2 * 13);
}

TEST(HttpConnections, WhatDoesNotEndTakesNoMemory) {
  ServedRoutes s(HttpServerOptions{.token = token});
  const std::string much(std::size_t{1} << 20U, 'a');
  std::string lines;
  while (lines.size() < much.size()) lines += "A: " + std::string(60, 'x') + "\r\n";
  const std::string post = "POST /echo HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer " + token +
                           "\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n";
  for (const auto& [begin, more, status] : {std::tuple<std::string, std::string, const char*>{"GET /", much, "431"},
                                            {"GET / HTTP/1.1\r\nHost: localhost\r\nX: ", much, "431"},
                                            {"GET / HTTP/1.1\r\nHost: localhost\r\n", lines, "431"},
                                            {much, much, "4"},
                                            {post, much, "400"},
                                            {post + "1;", much, "400"},
                                            {post + "1\r\na\r\n0\r\nX: ", much, "400"},
                                            {post + "1\r\na\r\n0\r\n", lines, "400"}}) {
    Raw client(s.server);
    const double before = resident();
    ASSERT_TRUE(client.send(begin));
    for (int i = 0; i < 100 && client.send(more); ++i) {
    }
    EXPECT_LT(resident() - before, 20) << begin;
    EXPECT_THAT(client.receive(), StartsWith(std::string("HTTP/1.1 ") + status)) << begin;
  }
}

TEST(HttpConnections, AHeadMustArriveInTime) {
  ServedRoutes s(HttpServerOptions{.timeout = 1});
  Raw client(s.server);
  client.send("GET /short HTTP/1.1\r\nHost: localhost\r\n");
  const auto begin = Clock::now();
  while (seconds_since(begin) < 10 && client.send("X: y\r\n")) std::this_thread::sleep_for(50ms);
  EXPECT_LT(seconds_since(begin), 3);
}

TEST(HttpConnections, ABodyMustArriveInTimeAlthoughItAlwaysMoves) {
  ServedRoutes s(HttpServerOptions{.timeout = 1, .body_time = 1});
  Raw client(s.server);
  client.send(
      "POST /echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 60000\r\n\r\n");
  const auto begin = Clock::now();
  std::jthread sender([&] {
    for (int i = 0; i < 40 && client.send("x"); ++i) std::this_thread::sleep_for(50ms);
  });
  EXPECT_THAT(client.receive(), StartsWith("HTTP/1.1 408"));
  EXPECT_LT(seconds_since(begin), 5);
}

TEST(HttpConnections, ClientsThatSayNothingKeepNobodyOut) {
  ServedRoutes s(HttpServerOptions{.max_connections = 40, .timeout = 60});
  std::vector<Raw> silent;
  for (int i = 0; i < 200; ++i) {
    silent.emplace_back(s.server);
    silent.back().send("GET /short HTTP/1.1\r\nHost: local");
  }
  const auto begin = Clock::now();
  for (int i = 0; i < 20; ++i) EXPECT_THAT(s.get("/short"), HasSubstr("a short answer"));
  EXPECT_LT(seconds_since(begin), 2);
}

TEST(HttpConnections, WhoSendsABodySlowlyTakesNoPlaceFromOthers) {
  ServedRoutes s(HttpServerOptions{.max_connections = 40, .timeout = 60});
  const std::string head = "POST /echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";
  std::vector<Raw> slow;
  for (int i = 0; i < 100; ++i) {
    slow.emplace_back(s.server);
    slow.back().send(head + "Content-Length: 100\r\n\r\n{");
  }
  for (int i = 0; i < 20; ++i) {
    Raw client(s.server);
    client.send(head + "Content-Length: 2\r\n\r\n{}");
    EXPECT_THAT(client.receive(), testing::EndsWith("{}"));
  }
}

TEST(HttpConnections, WhoIsLetInIsNotThrownOutForOthers) {
  ServedRoutes s(HttpServerOptions{.max_connections = 3, .max_listeners = 2, .timeout = 60});
  s.holds = true;
  std::vector<std::future<std::string>> answers;
  for (int i = 0; i < 3; ++i) {
    answers.push_back(std::async(std::launch::async, [&s] {
      Raw client(s.server);
      client.send(
          "POST /echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 2\r\n\r\n{}");
      return client.receive();
    }));
  }
  while (s.entered < 3) std::this_thread::sleep_for(1ms);
  EXPECT_THAT(s.get("/short"), StartsWith("HTTP/1.1 503"));
  s.holds = false;
  for (auto& answer : answers) EXPECT_THAT(answer.get(), testing::EndsWith("{}"));
  EXPECT_THAT(s.get("/short"), HasSubstr("a short answer"));
}

TEST(HttpConnections, AHundredWhoComeAtOnceAreAnsweredAtOnce) {
  ServedRoutes s;
  std::vector<Raw> clients;
  const auto begin = Clock::now();
  for (int i = 0; i < 100; ++i) clients.emplace_back(s.server);
  for (Raw& client : clients) client.send("GET /short HTTP/1.1\r\nHost: localhost\r\n\r\n");
  for (Raw& client : clients) EXPECT_THAT(client.receive(), HasSubstr("a short answer"));
  EXPECT_LT(seconds_since(begin), 0.9);
}

TEST(HttpConnections, StopsWhateverClientsDo) {
  ServedRoutes s(HttpServerOptions{.timeout = 60});
  s.run.begin({{"scans", LiveRun::Json::array()}});
  Raw silent(s.server), half(s.server), body(s.server), listener(s.server), refused(s.server);
  half.send("GET /short HTTP/1.1\r\nX: ");
  refused.send("POST /nothing HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n");
  listener.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(s.get("/short"), HasSubstr("a short answer"));
  const auto begin = Clock::now();
  s.server.stop();
  EXPECT_LT(seconds_since(begin), 2);
}

TEST(HttpConnections, StopsThoughABodyComesByteByByteAndNobodyReadsTheAnswer) {
  ServedRoutes s(HttpServerOptions{.timeout = 1, .body_time = 60});
  Raw body(s.server), deaf(s.server);
  deaf.send("GET /long HTTP/1.1\r\nHost: localhost\r\n\r\n");
  body.send("POST /echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 9999\r\n\r\n");
  std::jthread sender([&](const std::stop_token& end) {
    while (!end.stop_requested() && body.send("x")) std::this_thread::sleep_for(50ms);
  });
  std::this_thread::sleep_for(200ms);
  const auto begin = Clock::now();
  s.server.stop();
  EXPECT_LT(seconds_since(begin), 3);
}

TEST(HttpConnections, WhoDoesNotReadALongAnswerLosesIt) {
  ServedRoutes s(HttpServerOptions{.timeout = 1});
  Raw deaf(s.server);
  deaf.send("GET /long HTTP/1.1\r\nHost: localhost\r\n\r\n");
  while (s.get("/long").find("HTTP/1.1 503") != 0) std::this_thread::sleep_for(10ms);
  const auto begin = Clock::now();
  while (s.get("/long").find("HTTP/1.1 200") != 0) std::this_thread::sleep_for(100ms);
  EXPECT_LT(seconds_since(begin), 5);
}

TEST(HttpConnections, TheSumOfAllBodiesIsLimited) {
  ServedRoutes s(HttpServerOptions{.max_body_bytes = 1500});
  const auto post = [&](const std::string& length, const std::string& body) {
    Raw client(s.server);
    client.send("POST /echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n" + length + "\r\n\r\n" +
                body);
    return client.receive();
  };
  const std::string kilobyte(1000, 'x');
  EXPECT_THAT(post("Content-Length: 1000", kilobyte), HasSubstr(kilobyte));
  Raw waits(s.server);
  waits.send(
      "POST /echo HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 1000\r\n\r\n");
  while (post("Content-Length: 1000", kilobyte).find("HTTP/1.1 503") != 0) std::this_thread::sleep_for(1ms);
  EXPECT_THAT(post("Content-Length: 500", kilobyte.substr(500)), StartsWith("HTTP/1.1 200"));
  waits.send(kilobyte);
  EXPECT_THAT(waits.receive(), HasSubstr(kilobyte));
  EXPECT_THAT(post("Content-Length: 1000", kilobyte), HasSubstr(kilobyte));
}

TEST(HttpConnections, HeadersOfHttpAreUnderstood) {
  ServedRoutes s;
  const std::string head = "POST /echo HTTP/1.1\r\nhost: localhost\r\ncontent-type: application/json\r\n";
  Raw chunked(s.server), asks(s.server), only_head(s.server);
  chunked.send(head + "Transfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n2;x=y\r\nde\r\n0\r\n\r\n");
  EXPECT_THAT(chunked.receive(), testing::EndsWith("\r\n\r\nabcde"));
  asks.send(head + "Expect: 100-continue\r\nContent-Length: 2\r\n\r\n");
  std::this_thread::sleep_for(20ms);
  asks.send("{}");
  EXPECT_THAT(asks.receive(),
              testing::AllOf(StartsWith("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 200"), testing::EndsWith("{}")));
  only_head.send("HEAD /short HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(only_head.receive(), testing::AllOf(HasSubstr("Content-Length: 14"), testing::EndsWith("\r\n\r\n")));
  EXPECT_THAT(s.get("/%73hort?a=%41+b"), HasSubstr("a short answer"));
  EXPECT_THAT(s.get("/short", "Host: localhost\r\nno header\r\n"), StartsWith("HTTP/1.1 400"));
}

TEST(HttpHead, ThePathAndTheQueryOfATarget) {
  const HttpHead head = parse_target("/a%2fb+c?x=1&y=%41+%42&=e&flag&x=2&bad=%4&%zz=%");
  EXPECT_EQ(head.path, "/a/b+c");
  const std::map<std::string, std::string> expected{{"", "e"},    {"%zz", "%"}, {"bad", "%4"},
                                                    {"flag", ""}, {"x", "1"},   {"y", "A B"}};
  EXPECT_EQ(head.query, expected);
}

}  // namespace
}  // namespace vantage
