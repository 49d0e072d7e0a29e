#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

namespace vantage {

class HttpConnections;
class LiveRun;

struct HttpRequest {
  std::map<std::string, std::string> query;
  std::string content_type;  // without parameters, lower case
  std::string boundary;      // its parameter of this name
  std::string body;
};

struct HttpAnswer {
  int status = 200;
  std::string content_type = "application/json";
  std::shared_ptr<const std::string> body;  // null: empty
  std::string file_name = {};               // not empty: the browser saves it under this name

  /// {"error": text}.
  [[nodiscard]] static HttpAnswer error(int status, const std::string& text);
};

/// Thrown by a handler to answer with `status` and {"error": text}.
struct HttpError : std::runtime_error {
  HttpError(int http_status, const std::string& text) : std::runtime_error(text), status(http_status) {}
  int status;
};

/// What is answered under one path. The handler runs in a thread of the server, several at a time. InputError thrown by
/// it becomes 400, any other exception 500.
struct HttpRoute {
  enum class Method { get, post };

  Method method = Method::get;
  std::string path;  // exactly this one, without the query
  std::function<HttpAnswer(const HttpRequest&)> handle = {};
  std::string body_type = "application/json";     // of a POST; browsers send it across sites only where they may
  std::size_t max_body = std::size_t{64} * 1024;  // bytes
  int at_once = 0;                                // requests answered at a time, others get 503; 0: no limit
};

struct HttpServerOptions {
  std::string host = "127.0.0.1";  // address to listen at
  int port = 0;                    // 0: any free one
  std::string token = {};          // who knows it may come in; empty: everybody, on a loopback address only
  /// At a time; one of which it is not known yet what it wants makes room for who comes. More than all routes with long
  /// answers give at once, or else those who take them slowly keep others out.
  int max_connections = 512;
  int max_listeners = 32;                                // to events, at a time
  int max_workers = 64;                                  // threads that answer requests
  std::size_t max_body_bytes = std::size_t{512} << 20U;  // of all requests that are read or answered, in sum
  int timeout = 5;     // seconds that the head of a request may take, and every 64 KiB after it in either direction
  int body_time = 60;  // seconds that the body of a request may take

  /// Throws InputError naming the field.
  void validate() const;
};

/// HTTP for the page and for robots: answers only what was added, so no file of the machine can be asked for, and only
/// to those who are let in (admission.hpp). With a token every request needs it: in the query (`?token=`, which leaves
/// a cookie behind), as cookie, or as bearer. Every error is {"error": text}. What a request may cost before it is let
/// in is limited (http_connections.hpp); the header Range is not heeded, every answer is whole.
class HttpServer {
 public:
  explicit HttpServer(HttpServerOptions options);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Before start().
  void add(HttpRoute route);
  /// Server-sent events of `run`, which must outlive the server; stop() closes it. Before start().
  void add_events(const std::string& path, LiveRun& run);

  /// Listens in threads of its own. Throws Error where the address or a thread cannot be had.
  void start();
  /// Ends all connections and threads: whatever clients do within `timeout` seconds, or when the last handler returns.
  void stop();

  [[nodiscard]] int port() const;
  /// What to open in a browser, with the token.
  [[nodiscard]] std::string url() const;

 private:
  struct Routes;
  std::unique_ptr<Routes> routes_;
  std::unique_ptr<HttpConnections> connections_;
};

/// Adds the page at `/`, `GET /api/run` and `GET /api/events` (docs/report-data.md, "Live").
void add_page(HttpServer& server, LiveRun& run);

}  // namespace vantage
