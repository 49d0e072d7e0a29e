#include "vantage/server/http_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "vantage/core/error.hpp"
#include "vantage/server/live_run.hpp"

namespace vantage {
namespace {

constexpr std::size_t piece = std::size_t{64} * 1024;  // bytes sent between two looks at whether the server ends
constexpr std::chrono::milliseconds event_patience{1000};
constexpr int quiet_rounds = 15;  // of event_patience, then a greeting tells the browser that we are alive

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Takes as long whatever the texts are.
bool same_secret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

/// The name in a Host header, without port and brackets.
std::string host_name(const std::string& header) {
  if (header.starts_with('[')) return header.substr(1, header.find(']') - 1);
  return lower(header.substr(0, header.find(':')));
}

std::string cookie_value(const std::string& cookies, const std::string& name) {
  std::size_t at = 0;
  while (at < cookies.size()) {
    const std::size_t end = std::min(cookies.find(';', at), cookies.size());
    const std::string one = cookies.substr(at, end - at);
    const std::size_t begin = one.find_first_not_of(' ');
    if (begin != std::string::npos && one.compare(begin, name.size() + 1, name + "=") == 0)
      return one.substr(begin + name.size() + 1);
    at = end + 1;
  }
  return {};
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

bool is_loopback(const std::string& host) {
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24U) == 127;
  return lower(host) == "localhost" || host == "::1";
}

void HttpServerOptions::validate() const {
  require(!host.empty(), "host: must not be empty");
  require(port >= 0 && port <= 65535, "port = ", port, ": must be 0 (any free one) to 65535");
  require(max_connections >= 2, "max_connections = ", max_connections, ": must be at least 2");
  require(timeout >= 1, "timeout = ", timeout, " s: must be at least 1");
  require(is_loopback(host) || token.size() >= 16, "token: must have at least 16 characters where host = ", host,
          " lets other machines in");
  require(std::all_of(token.begin(), token.end(),
                      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_'; }),
          "token: must consist of letters, digits, - and _");
}

struct HttpServer::Connections {
  HttpServerOptions options;
  int port = 0;
  std::map<std::pair<HttpRoute::Method, std::string>, HttpRoute> routes;
  std::map<std::string, LiveRun*> events;
  std::shared_ptr<std::atomic<int>> listeners = std::make_shared<std::atomic<int>>(0);
  httplib::Server server;
  std::thread thread;

  /// Why the request is refused, if it is.
  [[nodiscard]] std::optional<HttpAnswer> refusal(const httplib::Request& request) const {
    if (options.token.empty()) {
      if (is_loopback(host_name(request.get_header_value("Host")))) return std::nullopt;
      return HttpAnswer::error(403, "this server answers only to its own name, localhost");
    }
    const std::string bearer = request.get_header_value("Authorization");
    for (const std::string& given :
         {request.get_param_value("token"), cookie_value(request.get_header_value("Cookie"), cookie_name()),
          bearer.starts_with("Bearer ") ? bearer.substr(7) : std::string()})
      if (same_secret(given, options.token)) return std::nullopt;
    return HttpAnswer::error(401, "the token is missing or wrong; open the address that the program printed");
  }

  [[nodiscard]] std::string cookie_name() const { return fmt::format("vantage-{}", port); }

  void listen_to_events(httplib::Response& response, LiveRun& run) const {
    auto place = std::shared_ptr<void>(nullptr, [count = listeners](void*) { --*count; });
    if (++*listeners > options.max_connections / 2) {
      give(response, HttpAnswer::error(503, "too many browsers look at this run"));
      return;
    }
    send_events(response, run, std::move(place));
  }

  void answer(HttpRoute::Method method, const httplib::Request& request, httplib::Response& response,
              const httplib::ContentReader* body) const {
    if (const auto refused = refusal(request)) {
      give(response, *refused);
      return;
    }
    if (same_secret(request.get_param_value("token"), options.token) && !options.token.empty()) {
      response.set_header("Set-Cookie",
                          fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", cookie_name(), options.token));
    }
    if (const auto run = events.find(request.path); run != events.end() && method == HttpRoute::Method::get) {
      listen_to_events(response, *run->second);
      return;
    }
    const auto route = routes.find({method, request.path});
    if (route == routes.end()) {
      const auto other = method == HttpRoute::Method::get ? HttpRoute::Method::post : HttpRoute::Method::get;
      const bool known = routes.contains({other, request.path}) || events.contains(request.path);
      give(response, known ? HttpAnswer::error(405, "not with this method") : HttpAnswer::error(404, "no such path"));
      return;
    }
    give(response,
         body != nullptr ? answer_post(route->second, request, *body) : answer_of(route->second, plain(request)));
  }

  static HttpRequest plain(const httplib::Request& request) {
    HttpRequest result;
    for (const auto& [name, value] : request.params) result.query.emplace(name, value);
    const std::string type = request.get_header_value("Content-Type");
    result.content_type = lower(type.substr(0, type.find_first_of("; ")));
    return result;
  }

  static HttpAnswer answer_post(const HttpRoute& route, const httplib::Request& request,
                                const httplib::ContentReader& body) {
    HttpRequest read = plain(request);
    if (read.content_type != route.body_type)
      return HttpAnswer::error(415, concat("Content-Type must be ", route.body_type));
    bool too_long = false;
    const bool complete = body([&](const char* data, std::size_t size) {
      too_long = read.body.size() + size > route.max_body;
      if (!too_long) read.body.append(data, size);
      return !too_long;
    });
    if (too_long) return HttpAnswer::error(413, concat("the body is longer than ", route.max_body, " bytes"));
    if (!complete) return HttpAnswer::error(400, "the body did not arrive completely");
    return answer_of(route, read);
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
    response.set_content(*HttpAnswer::error(response.status, concat("HTTP status ", response.status)).body,
                         "application/json");
  });
  c.server.Get(".*", [&c](const httplib::Request& request, httplib::Response& response) {
    c.answer(HttpRoute::Method::get, request, response, nullptr);
  });
  c.server.Post(".*",
                [&c](const httplib::Request& request, httplib::Response& response, const httplib::ContentReader& body) {
                  c.answer(HttpRoute::Method::post, request, response, &body);
                });
}

HttpServer::~HttpServer() { stop(); }

void HttpServer::add(HttpRoute route) {
  require(route.path.starts_with('/'), "path = '", route.path, "': must begin with /");
  // A page of another site may send these without asking the server first.
  constexpr std::array simple{"text/plain", "application/x-www-form-urlencoded", "multipart/form-data"};
  require(std::find(simple.begin(), simple.end(), route.body_type) == simple.end(), "body_type = ", route.body_type,
          ": must not be one that other web pages may send");
  const auto key = std::pair(route.method, route.path);
  connections_->routes.insert_or_assign(key, std::move(route));
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
