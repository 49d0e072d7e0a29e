#include "vantage/server/http_server.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/server/http_connections.hpp"
#include "vantage/server/live_run.hpp"

namespace vantage {
namespace {

constexpr std::size_t small_body = std::size_t{64} * 1024;  // bytes

std::optional<HttpRoute::Method> method_of(const HttpHead& head) {
  if (head.method == "GET" || head.method == "HEAD") return HttpRoute::Method::get;
  if (head.method == "POST") return HttpRoute::Method::post;
  return std::nullopt;
}

/// Counts the caller in until the result is gone; null where `most` are in already (0: no limit).
std::shared_ptr<void> take_place(std::shared_ptr<std::atomic<int>> count, int most) {
  if (++*count > most && most > 0) {
    --*count;
    return nullptr;
  }
  return {static_cast<void*>(count.get()), [count](void*) { --*count; }};
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
  require(is_address(host), "host = '", host, "': must be an address like 127.0.0.1 or ::1, or a name");
  require(port >= 0 && port <= 65535, "port = ", port, ": must be 0 (any free one) to 65535");
  require(max_connections >= 2, "max_connections = ", max_connections, ": must be at least 2");
  require(max_listeners >= 1 && max_listeners < max_connections, "max_listeners = ", max_listeners,
          ": must be at least 1 and less than max_connections = ", max_connections);
  require(max_workers >= 1, "max_workers = ", max_workers, ": must be at least 1");
  require(timeout >= 1, "timeout = ", timeout, " s: must be at least 1");
  require(body_time >= 1, "body_time = ", body_time, " s: must be at least 1");
  require(!token.empty() || is_loopback(host), "token: must be given where host = ", host, " lets other machines in");
  require(token.empty() || token.size() >= shortest_token, "token: has ", token.size(),
          " characters; must have at least ", shortest_token);
  require(std::all_of(token.begin(), token.end(),
                      [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_'; }),
          "token: must consist of letters, digits, - and _");
}

struct HttpServer::Routes {
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

  [[nodiscard]] std::string cookie_name() const { return concat("vantage-", port); }

  [[nodiscard]] HttpAnswer no_route(const HttpHead& head) const {
    const bool gets = routes.contains({HttpRoute::Method::get, head.path}) || events.contains(head.path);
    const bool posts = routes.contains({HttpRoute::Method::post, head.path});
    if (!gets && !posts) return HttpAnswer::error(404, concat(head.path, ": there is nothing under this path"));
    return HttpAnswer::error(405, concat(head.path, ": the method is ", head.method, ", must be ",
                                         gets ? (posts ? "GET or POST" : "GET") : "POST"));
  }

  [[nodiscard]] HttpDecision decide(const HttpHead& head) const {
    if (const auto refused = why_refused(head.caller, options.token, cookie_name()))
      return {.answer = HttpAnswer::error(refused->status, refused->text)};
    const Method method = method_of(head);
    const auto run = events.find(head.path);
    const auto route = method ? routes.find({*method, head.path}) : routes.end();
    HttpDecision decision = run != events.end() && method == HttpRoute::Method::get ? listening(*run->second)
                            : route != routes.end()                                 ? handling(route->second, head)
                                                    : HttpDecision{.answer = no_route(head)};
    if (!options.token.empty() && same_secret(head.caller.query_token, options.token))
      decision.cookie = concat(cookie_name(), "=", options.token, "; HttpOnly; SameSite=Strict; Path=/");
    return decision;
  }

  [[nodiscard]] HttpDecision listening(LiveRun& run) const {
    auto place = take_place(listeners, options.max_listeners);
    if (place) return {.events = &run, .place = std::move(place)};
    return {.answer = HttpAnswer::error(
                503, concat("at most ", options.max_listeners, " may listen to events at a time; try again later"))};
  }

  [[nodiscard]] static HttpDecision handling(const Served& served, const HttpHead& head) {
    const HttpRoute& route = served.route;
    if (route.method == HttpRoute::Method::post && head.content_type != route.body_type)
      return {.answer =
                  HttpAnswer::error(415, concat("Content-Type = ", head.content_type, ": must be ", route.body_type))};
    // A small body takes no place before it is there, so that those who send it slowly take none from others.
    if (route.max_body <= small_body)
      return {.after_body = [&served] { return entering(served); }, .max_body = route.max_body};
    return entering(served);
  }

  [[nodiscard]] static HttpDecision entering(const Served& served) {
    const HttpRoute& route = served.route;
    auto place = take_place(served.now, route.at_once);
    if (!place)
      return {.answer = HttpAnswer::error(503, concat(route.path, ": at most ", route.at_once,
                                                      " requests are answered at a time; try again later"))};
    return {.handle = [&route](const HttpRequest& request) { return answer_of(route, request); },
            .max_body = route.max_body,
            .place = std::move(place)};
  }
};

HttpServer::HttpServer(HttpServerOptions options) : routes_(std::make_unique<Routes>()) {
  options.validate();
  routes_->options = std::move(options);
  connections_ = std::make_unique<HttpConnections>(
      routes_->options, [routes = routes_.get()](const HttpHead& head) { return routes->decide(head); });
}

HttpServer::~HttpServer() { stop(); }

void HttpServer::add(HttpRoute route) {
  require(route.path.starts_with('/'), "path = '", route.path, "': must begin with /");
  // A page of another site may send these without asking the server first; forms with files are wanted, and come only
  // from our own pages (why_refused()).
  constexpr std::array simple{"text/plain", "application/x-www-form-urlencoded"};
  require(std::find(simple.begin(), simple.end(), route.body_type) == simple.end(), "body_type = ", route.body_type,
          ": must not be one that other web pages may send");
  const auto key = std::pair(route.method, route.path);
  routes_->routes.insert_or_assign(key, Routes::Served{std::move(route)});
}

void HttpServer::add_events(const std::string& path, LiveRun& run) { routes_->events[path] = &run; }

void HttpServer::start() {
  routes_->port = connections_->listen();
  connections_->start();
}

void HttpServer::stop() {
  for (const auto& [path, run] : routes_->events) run->close();
  connections_->stop();
}

int HttpServer::port() const { return routes_->port; }

std::string HttpServer::url() const {
  const HttpServerOptions& o = routes_->options;
  const std::string host = o.host.find(':') == std::string::npos ? o.host : concat("[", o.host, "]");
  return concat("http://", host, ":", port(), "/", o.token.empty() ? "" : "?token=" + o.token);
}

}  // namespace vantage
