#include "vantage/server/http_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "vantage/core/error.hpp"
#include "vantage/server/live_run.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

const std::string token = "0123456789abcdefXYZ";

Json empty_run() { return {{"meta", {{"state", "running"}}}, {"scans", Json::array()}, {"next", nullptr}}; }

HttpAnswer said(std::string text) { return {.body = std::make_shared<const std::string>(std::move(text))}; }

/// A server on a free port with the page and a few routes.
struct Served {
  LiveRun run;
  HttpServer server;
  std::unique_ptr<httplib::Client> client;
  std::atomic<bool> entered = false, holds = false;  // /api/one

  explicit Served(HttpServerOptions options = {}) : server(std::move(options)) {
    std::signal(SIGPIPE, SIG_IGN);  // the client writes to connections that the server has closed
    add_page(server, run);
    const auto echo = [](const HttpRequest& request) { return said(request.body); };
    server.add({.method = HttpRoute::Method::post, .path = "/api/echo", .handle = echo, .max_body = 1000});
    server.add(
        {.method = HttpRoute::Method::post, .path = "/api/form", .handle = echo, .body_type = "multipart/form-data"});
    const auto hold = [this, echo](const HttpRequest& request) {
      entered = true;
      while (holds) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return echo(request);
    };
    server.add({.method = HttpRoute::Method::post, .path = "/api/one", .handle = hold, .at_once = 1});
    server.add({.path = "/api/fail", .handle = [](const HttpRequest& request) -> HttpAnswer {
                  if (request.query.contains("conflict")) throw HttpError(409, "not now");
                  if (request.query.contains("input")) throw InputError("view = -1: must be positive");
                  throw std::runtime_error("broken");
                }});
    server.start();
    client = std::make_unique<httplib::Client>("127.0.0.1", server.port());
    client->set_read_timeout(60);
  }

  httplib::Result get(const std::string& path, const httplib::Headers& headers = {}) {
    return client->Get(path, headers);
  }
  httplib::Result post(const std::string& body, const std::string& type = "application/json") {
    return client->Post("/api/echo", body, type);
  }
};

std::string error_of(const httplib::Result& result) { return Json::parse(result->body).at("error"); }

TEST(HttpServer, ServesThePageAndTheRun) {
  Served s;
  const auto page = s.get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_EQ(page->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_THAT(page->body, HasSubstr("<!"));
  EXPECT_EQ(s.get("/api/run")->status, 503);
  s.run.begin(empty_run());
  const auto run = s.get("/api/run");
  EXPECT_EQ(run->status, 200);
  EXPECT_EQ(Json::parse(run->body)["revision"], 0);
}

TEST(HttpServer, SendsEventsToSeveralListenersUntilItStops) {
  Served s;
  s.run.begin(empty_run());
  std::vector<std::string> heard(3);
  std::atomic<int> greeted = 0;
  std::vector<std::jthread> threads;
  for (std::string& text : heard) {
    threads.emplace_back([&, port = s.server.port()] {
      httplib::Client client("127.0.0.1", port);
      client.set_read_timeout(60);
      client.Get("/api/events", [&](const char* data, std::size_t size) {
        if (text.empty()) ++greeted;
        text.append(data, size);
        return text.find("event: plan") == std::string::npos || text.find("\n\n", text.size() - 2) == std::string::npos;
      });
    });
  }
  while (greeted < 3) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  s.run.add("scan", {{"scan", 0}});
  s.run.add("plan", {{"chosen", 5}});
  threads.clear();
  for (const std::string& text : heard) {
    EXPECT_THAT(text, testing::StartsWith("event: hello\n"));
    EXPECT_THAT(text,
                HasSubstr("id: 1\nevent: scan\ndata: {\"scan\":0}\n\nid: 2\nevent: plan\ndata: {\"chosen\":5}\n\n"));
  }
}

TEST(HttpServer, StopsAlthoughListenersWait) {
  Served s;
  s.run.begin(empty_run());
  std::atomic<bool> greeted = false;
  std::jthread listener([&, port = s.server.port()] {
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(60);
    client.Get("/api/events", [&](const char*, std::size_t) {
      greeted = true;
      return true;
    });
  });
  while (!greeted) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  s.server.stop();
  EXPECT_FALSE(s.get("/api/run"));
}

TEST(HttpServer, AListenerThatNeverReadsHoldsNobodyUp) {
  Served s(HttpServerOptions{.timeout = 1});
  s.run.begin(empty_run());
  const int silent = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(s.server.port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::connect(silent, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  const std::string request = "GET /api/events HTTP/1.1\r\nHost: localhost\r\n\r\n";
  ASSERT_EQ(::send(silent, request.data(), request.size(), 0), static_cast<ssize_t>(request.size()));
  const std::string long_text(1 << 20, 'x');
  for (int i = 0; i < 32; ++i) s.run.add("state", {{"message", long_text}});
  EXPECT_EQ(s.get("/api/run")->status, 200);
  s.server.stop();
  ::close(silent);
}

TEST(HttpServer, LimitsTheNumberOfListeners) {
  Served s(HttpServerOptions{.max_listeners = 2});
  s.run.begin(empty_run());
  std::atomic<int> greeted = 0;
  std::atomic<bool> end = false;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&, port = s.server.port()] {
      httplib::Client client("127.0.0.1", port);
      client.set_read_timeout(60);
      client.Get("/api/events", [&, first = true](const char*, std::size_t) mutable {
        if (std::exchange(first, false)) ++greeted;
        return !end;
      });
    });
  }
  while (greeted < 2) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(s.get("/api/events")->status, 503);
  EXPECT_EQ(s.get("/api/run")->status, 200);
  end = true;
  s.server.stop();
}

TEST(HttpServer, AnswersMistakesWithJson) {
  Served s;
  for (const auto& [path, status, text] :
       {std::tuple{"/nowhere", 404, "/nowhere: there is nothing under this path"},
        {"/../../etc/passwd", 404, "/../../etc/passwd: there is nothing under this path"},
        {"/%2e%2e/etc/passwd", 404, "/../etc/passwd: there is nothing under this path"},
        {"/api/echo", 405, "/api/echo: the method is GET, must be POST"},
        {"/api/fail?conflict=1", 409, "not now"},
        {"/api/fail?input=1", 400, "view = -1: must be positive"},
        {"/api/fail", 500, "broken"}}) {
    const auto answer = s.get(path);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, status) << path;
    EXPECT_EQ(error_of(answer), text) << path;
  }
  for (const auto& other : {s.client->Delete("/api/run"), s.client->Put("/api/run", "{}", "application/json"),
                            s.client->Patch("/api/run", "{}", "application/json"), s.client->Options("/api/run")}) {
    EXPECT_EQ(other->status, 405);
    EXPECT_THAT(error_of(other), HasSubstr("must be GET"));
  }
  const auto too_long = s.get("/" + std::string(9000, 'a'));
  EXPECT_EQ(too_long->status, 414);
  EXPECT_THAT(error_of(too_long), HasSubstr("8192"));
}

TEST(HttpServer, TakesOnlyBodiesOfTheRightTypeAndSize) {
  Served s;
  EXPECT_EQ(s.post("{}")->body, "{}");
  EXPECT_EQ(s.post("{\"a\":1}", "application/json; charset=utf-8")->body, "{\"a\":1}");
  EXPECT_EQ(s.post("{}", "text/plain")->status, 415);
  EXPECT_EQ(s.post(std::string(1000, 'a'))->status, 200);
  const auto too_long = s.post(std::string(1001, 'a'));
  EXPECT_EQ(too_long->status, 413);
  EXPECT_EQ(error_of(too_long), "the body is longer than 1000 bytes");
  const auto chunked = s.client->Post(
      "/api/echo",
      [](std::size_t offset, httplib::DataSink& sink) {
        const std::string part(100, 'a');
        if (offset < 5000) return sink.write(part.data(), part.size());
        sink.done();
        return true;
      },
      "application/json");
  ASSERT_TRUE(chunked);
  EXPECT_EQ(chunked->status, 413);
}

TEST(HttpServer, ReadsLongBodiesThatItRefusesSoThatTheAnswerArrives) {
  Served s(HttpServerOptions{.token = token});
  const std::string long_body(std::size_t{8} << 20U, 'a');
  for (int i = 0; i < 5; ++i) {
    const auto stranger = s.post(long_body);
    ASSERT_TRUE(stranger);
    EXPECT_EQ(stranger->status, 401);
    const auto friendly = s.client->Post("/api/echo?token=" + token, long_body, "application/json");
    ASSERT_TRUE(friendly);
    EXPECT_EQ(friendly->status, 413);
  }
}

TEST(HttpServer, HandsFormsOverAsTheyCame) {
  Served s;
  const std::string form = "--B\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\n1\r\n--B--\r\n";
  EXPECT_EQ(s.client->Post("/api/form", form, "multipart/form-data; boundary=B")->body, form);
  EXPECT_EQ(s.client->Post("/api/form", form, "Multipart/Form-Data; boundary=B")->body, form);
  EXPECT_EQ(s.client->Post("/api/echo", form, "multipart/form-data; boundary=B")->status, 415);
}

TEST(HttpServer, ABodyMustArriveInTime) {
  Served s(HttpServerOptions{.body_time = 1});
  const auto slow = s.client->Post(
      "/api/echo",
      [](std::size_t, httplib::DataSink& sink) {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return sink.write("a", 1);
      },
      "application/json");
  if (slow) {
    EXPECT_EQ(slow->status, 408);
    EXPECT_THAT(error_of(slow), HasSubstr("within 1 s"));
  }
  EXPECT_EQ(s.post("{}")->status, 200);
}

TEST(HttpServer, LimitsHowManyPostsAreUnderWay) {
  Served s;
  s.holds = true;
  std::jthread first([&, port = s.server.port()] {
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(60);
    EXPECT_EQ(client.Post("/api/one", "{}", "application/json")->status, 200);
  });
  while (!s.entered) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const auto second = s.client->Post("/api/one", "{}", "application/json");
  EXPECT_EQ(second->status, 503);
  EXPECT_THAT(error_of(second), HasSubstr("at most 1 requests"));
  s.holds = false;
  first.join();
  EXPECT_EQ(s.client->Post("/api/one", "{}", "application/json")->status, 200);
}

TEST(HttpServer, RefusesRequestsInAnothersName) {
  Served s;
  s.run.begin(empty_run());
  for (const char* host : {"evil.example", "127.evil.example", "localhost.evil.example:80"})
    EXPECT_EQ(s.get("/api/run", {{"Host", host}})->status, 403) << host;
  for (const char* host : {"localhost", "localhost:1234", "127.0.0.1:80", "[::1]:80"})
    EXPECT_EQ(s.get("/api/run", {{"Host", host}})->status, 200) << host;
}

TEST(HttpServer, WithATokenNothingIsSeenWithoutIt) {
  Served s(HttpServerOptions{.token = token});
  s.run.begin(empty_run());
  for (const char* path :
       {"/", "/api/run", "/api/events", "/api/run?token=", "/api/run?token=0123456789abcdefXYz", "/x"})
    EXPECT_EQ(s.get(path)->status, 401) << path;
  EXPECT_EQ(s.post("{}")->status, 401);
  EXPECT_EQ(s.get("/api/run", {{"Authorization", "Bearer " + token}})->status, 200);
  const auto page = s.get("/?token=" + token);
  EXPECT_EQ(page->status, 200);
  EXPECT_THAT(s.server.url(), testing::EndsWith("/?token=" + token));
  const std::string cookie = page->get_header_value("Set-Cookie");
  EXPECT_THAT(cookie, HasSubstr("HttpOnly; SameSite=Strict"));
  const std::string pair = cookie.substr(0, cookie.find(';'));
  EXPECT_EQ(s.get("/api/run", {{"Cookie", "other=1; " + pair}})->status, 200);
  EXPECT_EQ(s.get("/api/run", {{"Cookie", pair + "x"}})->status, 401);
}

TEST(HttpServer, OptionsAreChecked) {
  EXPECT_THROW(HttpServerOptions({.port = 70000}).validate(), InputError);
  EXPECT_THROW(HttpServerOptions({.host = "0.0.0.0"}).validate(), InputError);
  EXPECT_THROW(HttpServerOptions({.host = "0.0.0.0", .token = "short"}).validate(), InputError);
  EXPECT_THROW(HttpServerOptions({.token = "short"}).validate(), InputError);
  EXPECT_THROW(HttpServerOptions({.token = token + "; Path=/"}).validate(), InputError);
  for (const char* host : {"", "0", "127.1", "0x7f.1", "1.2.3.4.5", "a b", "localhost:80", "http://localhost"})
    EXPECT_THROW(HttpServerOptions({.host = host, .token = token}).validate(), InputError) << host;
  for (const char* host : {"127.0.0.1", "::1", "localhost", "robot-7.lab.example", "fe80::1%eth0", "7up"})
    EXPECT_NO_THROW(HttpServerOptions({.host = host, .token = token}).validate()) << host;
  EXPECT_NO_THROW(HttpServerOptions({.host = "0.0.0.0", .token = token}).validate());
  HttpServer server({});
  EXPECT_THROW(server.add({.path = "/a", .body_type = "text/plain"}), InputError);
}

TEST(HttpServer, TwoServersDoNotShareAPort) {
  const Served first;
  LiveRun run;
  HttpServer second(HttpServerOptions{.port = first.server.port()});
  EXPECT_THROW(second.start(), Error);
}

TEST(HttpServer, DoesNotCompressWhatIsCompressed) {
  Served s;
  s.run.begin(empty_run());
  s.client->set_decompress(false);
  EXPECT_FALSE(s.get("/api/run", {{"Accept-Encoding", "gzip, br"}})->has_header("Content-Encoding"));
}

}  // namespace
}  // namespace vantage
