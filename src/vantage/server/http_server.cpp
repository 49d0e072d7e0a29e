#include "vantage/server/http_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "vantage/core/error.hpp"
#include "vantage/server/admission.hpp"
#include "vantage/server/live_run.hpp"

namespace vantage {
namespace {

constexpr std::size_t piece = std::size_t{64} * 1024;  // bytes sent between two looks at whether the server ends
constexpr std::size_t most_dropped = std::size_t{256} << 20U;  // bytes of a refused body that are read all the same
constexpr std::chrono::milliseconds event_patience{1000};
constexpr int quiet_rounds = 15;  // of event_patience, then a greeting tells the browser that we are alive

std::optional<HttpRoute::Method> method_of(const httplib::Request& request) {
  if (request.method == "GET" || request.method == "HEAD") return HttpRoute::Method::get;
  if (request.method == "POST") return HttpRoute::Method::post;
  return std::nullopt;
}

/// What was wrong with a request that the library refuses before we see it.
std::string text_of(int status) {
  if (status == 400) return "the request line or a header is not HTTP/1.1, or is longer than 8192 characters";
  if (status == 414) return "the address is longer than 8192 characters";
  if (status == 416) return "the header Range asks for what the answer does not have";
  return concat("HTTP status ", status);
}

/// Counts the caller in until the result is gone; null where `most` are in already (0: no limit).
std::shared_ptr<void> take_place(std::shared_ptr<std::atomic<int>> count, int most) {
  if (++*count > most && most > 0) {
    --*count;
    return nullptr;
  }
  return {static_cast<void*>(count.get()), [count](void*) { --*count; }};
}

void give(httplib::Response& response, const HttpAnswer& answer) {
  response.status = answer.status;
  if (!answer.file_name.empty())
    response.set_header("Content-Disposition", "attachment; filename=\"" + answer.file_name + "\"");
  if (!answer.body || answer.body->empty()) {
    response.set_content("", answer.content_type);
    return;
  }
  // In pieces, so that a slow browser does not hold up the end of the server. It is not compressed: what is long here
  // has been compressed before.
  response.set_content_provider(answer.body->size(), answer.content_type,
                                [body = answer.body](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                                  return sink.write(body->data() + offset, std::min(length, piece));
                                });
}

/// Sends the events until the browser goes away or the run is closed.
void send_events(httplib::Response& response, LiveRun& run, std::shared_ptr<void> place) {
  struct Listener {
    LiveRun::Reader reader;
    int quiet = 0;
  };
  const auto listener = std::make_shared<Listener>();
  response.set_header("X-Accel-Buffering", "no");
  response.set_chunked_content_provider(
      "text/event-stream", [&run, listener, place = std::move(place)](std::size_t, httplib::DataSink& sink) {
        const auto text = run.next(listener->reader, event_patience);
        if (!text || !sink.is_writable()) return false;
        if (text->empty() && ++listener->quiet < quiet_rounds) return true;
        listener->quiet = 0;
        const std::string now = text->empty() ? run.greeting(listener->reader) : *text;
        for (std::size_t at = 0; at < now.size(); at += piece)
          if (!sink.write(now.data() + at, std::min(piece, now.size() - at))) return false;
        return true;
      });
}

HttpAnswer answer_of(const HttpRoute& route, const HttpRequest& request) {
  try {
    return route.handle(request);
  } catch (const HttpError& error) {
    return HttpAnswer::error(error.status, error.what());
  } catch (const InputError& error) {
    return HttpAnswer::error(400, error.what());
  } catch (const std::exception& error) {
    return HttpAnswer::error(500, error.what());
  }
}

}  // namespace

HttpAnswer HttpAnswer::error(int status, const std::string& text) {
  using Json = nlohmann::ordered_json;
  HttpAnswer answer;
  answer.status = status;
  answer.body =
      std::make_shared<const std::string>(Json{{"error", text}}.dump(-1, ' ', false, Json::error_handler_t::replace));
  return answer;
}

void HttpServerOptions::validate() const {
  require(!host.empty(), "host: must not be empty");
  require(port >= 0 && port <= 65535, "port = ", port, ": must be 0 (any free one) to 65535");
  require(max_connections >= 2, "max_connections = ", max_connections, ": must be at least 2");
  require(timeout >= 1, "timeout = ", timeout, " s: must be at least 1");
  require(body_time >= 1, "body_time = ", body_time, " s: must be at least 1");
  require(is_loopback(host) || token.size() >= 16, "token: must have at least 16 characters where host = ", host,
          " lets other machines in");
  require(std::all_of(token.begin(), token.end(),
                      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_'; }),
          "token: must consist of letters, digits, - and _");
}

struct HttpServer::Connections {
  using Method = std::optional<HttpRoute::Method>;  // nothing: neither GET nor POST
  struct Served {
    HttpRoute route;
    std::shared_ptr<std::atomic<int>> now = std::make_shared<std::atomic<int>>(0);  // requests under way
  };

  HttpServerOptions options;
  int port = 0;
  std::map<std::pair<HttpRoute::Method, std::string>, Served> routes;
  std::map<std::string, LiveRun*> events;
  std::shared_ptr<std::atomic<int>> listeners = std::make_shared<std::atomic<int>>(0);
  httplib::Server server;
  std::thread thread;

  [[nodiscard]] std::string cookie_name() const { return fmt::format("vantage-{}", port); }

  /// Why the request is refused by what its head says, if it is.
  [[nodiscard]] std::optional<HttpAnswer> refusal(Method method, const httplib::Request& request) const {
    const Caller caller{.host = request.get_header_value("Host"),
                        .origin = request.get_header_value("Origin"),
                        .query_token = request.get_param_value("token"),
                        .cookies = request.get_header_value("Cookie"),
                        .authorization = request.get_header_value("Authorization")};
    if (const auto refused = why_refused(caller, options.token, cookie_name()))
      return HttpAnswer::error(refused->status, refused->text);
    if (method == HttpRoute::Method::get && events.contains(request.path)) return std::nullopt;
    const auto found = method ? routes.find({*method, request.path}) : routes.end();
    if (found == routes.end()) return no_route(request);
    if (method != HttpRoute::Method::post) return std::nullopt;
    const HttpRoute& route = found->second.route;
    if (const std::string type = content_type(request); type != route.body_type)
      return HttpAnswer::error(415, concat("Content-Type = ", type, ": must be ", route.body_type));
    if (request.get_header_value<std::uint64_t>("Content-Length") > route.max_body) return too_long(route);
    return std::nullopt;
  }

  [[nodiscard]] HttpAnswer no_route(const httplib::Request& request) const {
    const bool gets = routes.contains({HttpRoute::Method::get, request.path}) || events.contains(request.path);
    const bool posts = routes.contains({HttpRoute::Method::post, request.path});
    if (!gets && !posts) return HttpAnswer::error(404, concat(request.path, ": there is nothing under this path"));
    return HttpAnswer::error(405, concat(request.path, ": the method is ", request.method, ", must be ",
                                         gets ? (posts ? "GET or POST" : "GET") : "POST"));
  }

  [[nodiscard]] static HttpAnswer too_long(const HttpRoute& route) {
    return HttpAnswer::error(413, concat("the body is longer than ", route.max_body, " bytes"));
  }

  [[nodiscard]] static std::string content_type(const httplib::Request& request) {
    const std::string type = request.get_header_value("Content-Type");
    return lower(type.substr(0, type.find_first_of("; ")));
  }

  void listen_to_events(httplib::Response& response, LiveRun& run) const {
    auto place = take_place(listeners, options.max_connections / 2);
    if (!place) {
      give(response, HttpAnswer::error(503, concat("at most ", options.max_connections / 2,
                                                   " may listen to events at a time; try again later")));
      return;
    }
    send_events(response, run, std::move(place));
  }

  void answer(Method method, const httplib::Request& request, httplib::Response& response,
              const httplib::ContentReader* body) const {
    if (const auto refused = refusal(method, request)) {
      // To the end, or else the client finds the connection broken and not the answer.
      if (body != nullptr) (void)receive(*body, 0);
      give(response, *refused);
      return;
    }
    if (!options.token.empty() && same_secret(request.get_param_value("token"), options.token)) {
      response.set_header("Set-Cookie",
                          fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", cookie_name(), options.token));
    }
    if (const auto run = events.find(request.path); run != events.end() && method == HttpRoute::Method::get) {
      listen_to_events(response, *run->second);
      return;
    }
    const Served& served = routes.at({*method, request.path});
    HttpRequest read;
    for (const auto& [name, value] : request.params) read.query.emplace(name, value);
    read.content_type = content_type(request);
    give(response, body == nullptr ? answer_of(served.route, read) : answer_post(served, read, *body));
  }

  HttpAnswer answer_post(const Served& served, HttpRequest& read, const httplib::ContentReader& body) const {
    const HttpRoute& route = served.route;
    const auto place = take_place(served.now, route.at_once);
    Received received = receive(body, place ? route.max_body : 0);
    if (!place) {
      return HttpAnswer::error(
          503, concat(route.path, ": at most ", route.at_once, " requests are answered at a time; try again later"));
    }
    if (received.too_slow)
      return HttpAnswer::error(408, concat("the body did not arrive within ", options.body_time, " s"));
    if (received.too_long) return too_long(route);
    if (!received.complete) return HttpAnswer::error(400, "the body did not arrive completely");
    read.body = std::move(received.bytes);
    return answer_of(route, read);
  }

  struct Received {
    std::string bytes;
    bool complete = false, too_long = false, too_slow = false;
  };

  /// Reads a body; what is beyond `max` bytes is read too, within limits, and thrown away.
  [[nodiscard]] Received receive(const httplib::ContentReader& body, std::size_t max) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(options.body_time);
    Received received;
    std::size_t dropped = 0;
    received.complete = body([&](const char* data, std::size_t size) {
      received.too_slow = std::chrono::steady_clock::now() > end;
      if (received.too_slow) return false;
      if (received.too_long || received.bytes.size() + size > max) {
        received.too_long = true;
        received.bytes = {};
        return (dropped += size) <= most_dropped;
      }
      received.bytes.append(data, size);
      return true;
    });
    return received;
  }
};

HttpServer::HttpServer(HttpServerOptions options) : connections_(std::make_unique<Connections>()) {
  options.validate();
  Connections& c = *connections_;
  c.options = std::move(options);
  c.server.new_task_queue = [count = static_cast<std::size_t>(c.options.max_connections)] {
    return new httplib::ThreadPool(count);  // the library deletes it
  };
  // Not SO_REUSEPORT, with which two programs would share the port.
  c.server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  c.server.set_tcp_nodelay(true);
  c.server.set_keep_alive_max_count(1);
  c.server.set_read_timeout(c.options.timeout);
  c.server.set_write_timeout(c.options.timeout);
  c.server.set_default_headers(
      {{"Cache-Control", "no-store"},
       {"X-Content-Type-Options", "nosniff"},
       {"Referrer-Policy", "no-referrer"},
       {"Content-Security-Policy",
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
        "connect-src 'self'; form-action 'none'; base-uri 'none'; frame-ancestors 'none'"}});
  c.server.set_error_handler([](const httplib::Request&, httplib::Response& response) {
    if (response.has_header("Content-Type")) return;
    response.set_content(*HttpAnswer::error(response.status, text_of(response.status)).body, "application/json");
  });
  c.server.set_exception_handler([](const httplib::Request&, httplib::Response& response, const std::exception_ptr&) {
    give(response, HttpAnswer::error(500, "the request could not be answered"));
  });
  c.server.set_expect_100_continue_handler([&c](const httplib::Request& request, httplib::Response& response) {
    const auto refused = c.refusal(method_of(request), request);
    if (!refused) return 100;
    give(response, *refused);
    return refused->status;
  });
  // The library would take forms apart in a way of its own where it recognises them, which is by their case.
  c.server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response&) {
    for (auto& [name, value] : const_cast<httplib::Request&>(request).headers)
      if (lower(name) == "content-type" && value.starts_with("multipart")) value[0] = 'M';
    return httplib::Server::HandlerResponse::Unhandled;
  });
  const auto plain = [&c](const httplib::Request& request, httplib::Response& response) {
    c.answer(method_of(request), request, response, nullptr);
  };
  const auto with_body = [&c](const httplib::Request& request, httplib::Response& response,
                              const httplib::ContentReader& body) {
    c.answer(method_of(request), request, response, &body);
  };
  c.server.Get(".*", plain).Options(".*", plain).Delete(".*", plain);
  c.server.Post(".*", with_body).Put(".*", with_body).Patch(".*", with_body).Delete(".*", with_body);
}

HttpServer::~HttpServer() { stop(); }

void HttpServer::add(HttpRoute route) {
  require(route.path.starts_with('/'), "path = '", route.path, "': must begin with /");
  // A page of another site may send these without asking the server first; forms with files are wanted, and come only
  // from our own pages (refusal()).
  constexpr std::array simple{"text/plain", "application/x-www-form-urlencoded"};
  require(std::find(simple.begin(), simple.end(), route.body_type) == simple.end(), "body_type = ", route.body_type,
          ": must not be one that other web pages may send");
  const auto key = std::pair(route.method, route.path);
  connections_->routes.insert_or_assign(key, Connections::Served{std::move(route)});
}

void HttpServer::add_events(const std::string& path, LiveRun& run) { connections_->events[path] = &run; }

void HttpServer::start() {
  Connections& c = *connections_;
  const HttpServerOptions& o = c.options;
  c.port = o.port == 0 ? c.server.bind_to_any_port(o.host) : c.server.bind_to_port(o.host, o.port) ? o.port : -1;
  if (c.port < 0)
    throw Error(concat("cannot listen at ", o.host, ", port ", o.port,
                       ": perhaps another program does; choose another port, or 0 for any free one"));
  c.thread = std::thread([&c] { c.server.listen_after_bind(); });
  while (!c.server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void HttpServer::stop() {
  Connections& c = *connections_;
  for (const auto& [path, run] : c.events) run->close();
  c.server.stop();
  if (c.thread.joinable()) c.thread.join();
}

int HttpServer::port() const { return connections_->port; }

std::string HttpServer::url() const {
  const HttpServerOptions& o = connections_->options;
  const std::string host = o.host.find(':') == std::string::npos ? o.host : concat("[", o.host, "]");
  return fmt::format("http://{}:{}/{}", host, port(), o.token.empty() ? "" : "?token=" + o.token);
}

}  // namespace vantage
