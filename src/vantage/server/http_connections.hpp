#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "vantage/server/http_head.hpp"
#include "vantage/server/http_server.hpp"

namespace vantage {

/// What becomes of a request: an answer at once (its body is not wanted then), the events of a run, what `handle`
/// answers to its body, or what is decided when its body is there.
struct HttpDecision {
  std::optional<HttpAnswer> answer = {};
  LiveRun* events = nullptr;
  std::function<HttpAnswer(const HttpRequest&)> handle = {};
  std::function<HttpDecision()> after_body = {};
  std::size_t max_body = 0;          // bytes
  std::string cookie = {};           // for Set-Cookie
  std::shared_ptr<void> place = {};  // let go when the request is over
};

/// The connections of an HTTP server. One thread reads heads and bodies and writes answers, for all clients and never
/// waiting for one; handlers run in threads of their own. So a slow client costs a socket and some kilobytes, for a
/// limited time: heads have a longest length and time, bodies too, and the sum of all bodies is limited. Where all
/// connections are taken, the oldest of those whose request is not decided on yet makes room.
class HttpConnections {
 public:
  using Decide = std::function<HttpDecision(const HttpHead&)>;

  /// `decide` is called by one thread; it must neither wait nor throw.
  HttpConnections(const HttpServerOptions& options, Decide decide);
  ~HttpConnections();
  HttpConnections(const HttpConnections&) = delete;
  HttpConnections& operator=(const HttpConnections&) = delete;

  /// Takes the address, and says at which port. Throws Error where it is not to be had.
  [[nodiscard]] int listen();
  /// Answers from now on. Throws Error where no thread is to be had.
  void start();
  void stop();

 private:
  class Network;
  std::unique_ptr<Network> network_;
};

}  // namespace vantage
