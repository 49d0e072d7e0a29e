#include "vantage/server/http_connections.hpp"

// Asio uses std::exchange without including what declares it.
#include <utility>

#include <atomic>
#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <limits>
#include <list>
#include <thread>

#include "vantage/core/error.hpp"
#include "vantage/server/http_head.hpp"
#include "vantage/server/http_workers.hpp"
#include "vantage/server/live_run.hpp"
#include "vantage/server/multipart.hpp"

namespace vantage {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::awaitable;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using tcp = asio::ip::tcp;

constexpr std::size_t longest_head = std::size_t{16} * 1024;   // bytes of request line and headers
constexpr std::size_t longest_target = 8192;                   // bytes of path and query
constexpr std::size_t piece = std::size_t{64} * 1024;          // bytes that must go out, or come in, within `timeout`
constexpr std::size_t most_dropped = std::size_t{256} << 20U;  // bytes of a refused body that are read all the same
constexpr std::chrono::milliseconds event_pause{50};           // between two looks for new events
constexpr std::chrono::seconds longest_silence{15};  // then a greeting lets the browser know that we are alive

/// Completes a coroutine's step and leaves its error in `failed` instead of throwing it.
auto into(error_code& failed) { return asio::redirect_error(asio::use_awaitable, failed); }

struct Connection {
  explicit Connection(tcp::socket socket) : stream(std::move(socket)) {}

  beast::tcp_stream stream;
  beast::flat_buffer buffer{longest_head + piece};
  bool is_let_in = false;  // it is decided what becomes of its request; others make room for new ones
  bool wants_body = true;  // false: HEAD
};

HttpHead head_of(const http::request_header<>& request) {
  const auto text = [&](http::field field) { return std::string(request[field]); };
  HttpHead head = parse_target(std::string_view(request.target().data(), request.target().size()));
  head.method = std::string(request.method_string());
  const std::string type = text(http::field::content_type);
  head.content_type = lower(type.substr(0, type.find_first_of("; \t")));
  head.boundary = header_parameter(type, "boundary");
  head.caller = {.host = text(http::field::host),
                 .origin = text(http::field::origin),
                 .query_token = head.query.contains("token") ? head.query.at("token") : std::string(),
                 .cookies = text(http::field::cookie),
                 .authorization = text(http::field::authorization)};
  return head;
}

/// What to answer to a head that could not be read, nothing where nobody listens any more.
std::optional<HttpAnswer> answer_to(const error_code& failed) {
  if (failed == http::error::header_limit || failed == http::error::buffer_overflow)
    return HttpAnswer::error(431, concat("the request line and headers are longer than ", longest_head, " bytes"));
  if (failed == http::error::end_of_stream || failed.category() != make_error_code(http::error::bad_field).category())
    return std::nullopt;
  return HttpAnswer::error(400, concat("the request is not HTTP/1.1: ", failed.message()));
}

HttpAnswer too_long(std::size_t max_body) {
  return HttpAnswer::error(413, concat("the body is longer than ", max_body, " bytes"));
}

/// Whether the client has closed the connection.
bool is_gone(tcp::socket& socket) {
  char byte = 0;
  const auto received = ::recv(socket.native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return received == 0 || (received < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

}  // namespace

class HttpConnections::Network {
 public:
  Network(const HttpServerOptions& options, Decide decide)
      : options_(options), decide_(std::move(decide)), acceptor_(context_), workers_(options.max_workers) {}
  ~Network() { stop(); }
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  [[nodiscard]] int listen();
  void start();
  void stop();

 private:
  using Shared = std::shared_ptr<Connection>;
  using Parser = http::request_parser<http::empty_body>;

  [[nodiscard]] std::chrono::seconds patience() const { return std::chrono::seconds(options_.timeout); }
  [[nodiscard]] tcp::endpoint endpoint() const;
  awaitable<void> accept_all();
  [[nodiscard]] bool make_room();
  void end(const Shared& connection);

  awaitable<void> serve(Shared connection, bool is_full);
  awaitable<void> answer_request(Connection& c);
  /// An answer where the request is refused. What is decided after the body goes into `decision`.
  awaitable<std::optional<HttpAnswer>> answer_body(Connection& c, Parser& parser, const HttpHead& head,
                                                   HttpDecision& decision);
  awaitable<std::optional<HttpAnswer>> read_body(Connection& c, http::request_parser<http::string_body>& parser,
                                                 std::size_t max);
  awaitable<void> refuse(Connection& c, HttpAnswer answer);
  awaitable<void> send(Connection& c, HttpAnswer answer, std::string cookie);
  awaitable<void> send_events(Connection& c, LiveRun& run, std::string cookie);
  awaitable<bool> write(Connection& c, std::string_view text);

  HttpServerOptions options_;
  Decide decide_;
  std::size_t body_bytes_ = 0;         // that are promised to requests; of the network's thread, as the next ones
  std::list<Shared> connections_;      // the oldest first
  std::atomic<std::size_t> open_ = 0;  // connections_.size()
  asio::io_context context_;
  tcp::acceptor acceptor_;
  HttpWorkers workers_;  // destroyed first: what they run belongs to connections
  std::thread thread_;
};

tcp::endpoint HttpConnections::Network::endpoint() const {
  error_code failed;
  const auto port = static_cast<std::uint16_t>(options_.port);
  const auto address = asio::ip::make_address(options_.host, failed);
  if (!failed) return {address, port};
  asio::io_context context;
  tcp::resolver resolver(context);
  const auto found = resolver.resolve(options_.host, std::to_string(options_.port), failed);
  if (failed || found.empty()) throw Error(concat("host = ", options_.host, ": is no address of this machine"));
  return found.begin()->endpoint();
}

int HttpConnections::Network::listen() {
  const tcp::endpoint at = endpoint();
  error_code failed;
  const auto step = [&](auto&& call) {
    if (!failed) call();
  };
  step([&] { acceptor_.open(at.protocol(), failed); });
  // Not SO_REUSEPORT, with which two programs would share the port.
  step([&] { acceptor_.set_option(tcp::acceptor::reuse_address(true), failed); });
  step([&] { acceptor_.bind(at, failed); });
  step([&] { acceptor_.listen(asio::socket_base::max_listen_connections, failed); });
  if (failed)
    throw Error(concat("cannot listen at ", options_.host, ", port ", options_.port, " (", failed.message(),
                       "): perhaps another program does; choose another port, or 0 for any free one"));
  return acceptor_.local_endpoint().port();
}

void HttpConnections::Network::start() {
  try {
    workers_.start();
    asio::co_spawn(context_, accept_all(), asio::detached);
    thread_ = std::thread([this] { context_.run(); });
  } catch (const std::system_error& error) {
    throw Error(concat("cannot start the threads of the server (", error.what(),
                       "): the limit of processes (ulimit -u, or the container's) is reached"));
  }
}

void HttpConnections::Network::stop() {
  if (thread_.joinable()) {
    asio::post(context_, [this] {
      error_code ignored;
      acceptor_.close(ignored);
      for (const Shared& each : connections_)
        if (!each->is_let_in) each->stream.close();
    });
    // What is answered may go out.
    const auto end = Clock::now() + patience();
    while (open_ > 0 && Clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    context_.stop();
    thread_.join();
  }
  workers_.stop();
  connections_.clear();  // before the context that they belong to
}

awaitable<void> HttpConnections::Network::accept_all() {
  asio::steady_timer pause(context_);
  while (acceptor_.is_open()) {
    error_code failed, ignored;
    tcp::socket socket = co_await acceptor_.async_accept(into(failed));
    if (!acceptor_.is_open()) co_return;
    if (failed) {  // there are no more files to be had
      pause.expires_after(event_pause);
      co_await pause.async_wait(into(ignored));
      continue;
    }
    socket.set_option(tcp::no_delay(true), ignored);
    try {
      const auto connection = std::make_shared<Connection>(std::move(socket));
      const bool is_full = !make_room();
      connections_.push_back(connection);
      open_ = connections_.size();
      asio::co_spawn(context_, serve(connection, is_full), asio::detached);
    } catch (const std::exception&) {
      // There is no memory; whoever came has to come again.
    }
  }
}

bool HttpConnections::Network::make_room() {
  while (connections_.size() >= static_cast<std::size_t>(options_.max_connections)) {
    const auto oldest =
        std::find_if(connections_.begin(), connections_.end(), [](const Shared& each) { return !each->is_let_in; });
    if (oldest == connections_.end()) return false;
    (*oldest)->stream.close();
    connections_.erase(oldest);
  }
  return true;
}

void HttpConnections::Network::end(const Shared& connection) {
  error_code ignored;
  connection->stream.socket().shutdown(tcp::socket::shutdown_both, ignored);
  connection->stream.close();
  connections_.remove(connection);
  open_ = connections_.size();
}

/// One more than there may be gets 503; whoever comes then takes its place.
awaitable<void> HttpConnections::Network::serve(Shared connection, bool is_full) {
  try {
    if (is_full) {
      co_await refuse(*connection, HttpAnswer::error(503, "all connections are taken; try again later"));
    } else {
      co_await answer_request(*connection);
    }
  } catch (const std::exception&) {
    // There is no memory for the answer: the client finds the connection closed.
  }
  end(connection);
}

awaitable<void> HttpConnections::Network::answer_request(Connection& c) {
  Parser parser;
  parser.header_limit(longest_head);
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());  // what is too long is said later
  error_code failed;
  c.stream.expires_after(patience());
  co_await http::async_read_header(c.stream, c.buffer, parser, into(failed));
  if (failed) {
    auto answer = answer_to(failed);
    if (answer) co_await refuse(c, *std::move(answer));
    co_return;
  }
  const auto& request = parser.get();
  if (request.target().size() > longest_target) {
    HttpAnswer answer = HttpAnswer::error(414, concat("the address is longer than ", longest_target, " characters"));
    co_await refuse(c, std::move(answer));
    co_return;
  }
  const HttpHead head = head_of(request);
  c.wants_body = head.method != "HEAD";
  HttpDecision decision = decide_(head);
  std::optional<HttpAnswer> refused = decision.answer;
  c.is_let_in = !refused && !decision.after_body;
  if (decision.events != nullptr) {
    co_await send_events(c, *decision.events, decision.cookie);
  } else if (!refused) {
    refused = co_await answer_body(c, parser, head, decision);
  }
  decision = {};  // others may have its place
  if (refused) co_await refuse(c, *std::move(refused));
}

awaitable<std::optional<HttpAnswer>> HttpConnections::Network::answer_body(Connection& c, Parser& parser,
                                                                           const HttpHead& head,
                                                                           HttpDecision& decision) {
  const std::size_t announced =
      parser.chunked() ? decision.max_body : static_cast<std::size_t>(parser.content_length().value_or(0));
  if (announced > decision.max_body) co_return too_long(decision.max_body);
  if (body_bytes_ + announced > options_.max_body_bytes)
    co_return HttpAnswer::error(503, concat("requests of ", body_bytes_, " bytes are under way; try again later"));
  struct Promise {
    std::size_t &sum, bytes;
    ~Promise() { sum -= bytes; }
  } promise{body_bytes_, announced};
  body_bytes_ += announced;
  const bool asks_first = beast::iequals(parser.get()[http::field::expect], "100-continue");
  http::request_parser<http::string_body> whole(std::move(parser));
  if (asks_first && !co_await write(c, "HTTP/1.1 100 Continue\r\n\r\n")) co_return std::nullopt;
  auto refused = co_await read_body(c, whole, decision.max_body);
  if (refused) co_return refused;
  const std::string cookie = decision.cookie;
  if (decision.after_body) {
    HttpDecision decided = decision.after_body();
    decision = std::move(decided);
  }
  if (decision.answer) co_return decision.answer;
  c.is_let_in = true;
  const HttpRequest read{head.query, head.content_type, head.boundary, std::move(whole.get().body())};
  const std::function<HttpAnswer()> handle = [&] { return decision.handle(read); };
  HttpAnswer given = co_await workers_.run(handle);
  co_await send(c, std::move(given), cookie);
  co_return std::nullopt;
}

awaitable<std::optional<HttpAnswer>> HttpConnections::Network::read_body(
    Connection& c, http::request_parser<http::string_body>& parser, std::size_t max) {
  parser.body_limit(max);
  const auto end = Clock::now() + std::chrono::seconds(options_.body_time);
  while (!parser.is_done()) {
    error_code failed;
    c.stream.expires_after(patience());
    co_await http::async_read_some(c.stream, c.buffer, parser, into(failed));
    if (failed == http::error::body_limit) co_return too_long(max);
    if (failed) co_return HttpAnswer::error(400, "the body did not arrive completely: " + failed.message());
    if (Clock::now() > end && !parser.is_done())
      co_return HttpAnswer::error(408, concat("the body did not arrive within ", options_.body_time, " s"));
  }
  co_return std::nullopt;
}

/// Answers without wanting the rest of the request; it is read and thrown away all the same, within limits, or else the
/// client finds the connection broken and not the answer.
awaitable<void> HttpConnections::Network::refuse(Connection& c, HttpAnswer answer) {
  c.is_let_in = false;
  co_await send(c, std::move(answer), {});
  error_code failed;
  c.stream.socket().shutdown(tcp::socket::shutdown_send, failed);
  const auto end = Clock::now() + std::chrono::seconds(options_.body_time);
  std::size_t dropped = 0;
  c.buffer.clear();
  while (!failed && dropped < most_dropped && Clock::now() < end) {
    c.stream.expires_after(patience());
    const auto space = c.buffer.prepare(piece);
    dropped += co_await c.stream.async_read_some(space, into(failed));
  }
}

awaitable<void> HttpConnections::Network::send(Connection& c, HttpAnswer answer, std::string cookie) {
  const std::string_view body = answer.body ? std::string_view(*answer.body) : std::string_view();
  std::string first = head_text(answer, cookie, body.size());
  if (c.wants_body && body.size() <= piece) first += body;
  if (!co_await write(c, first) || !c.wants_body || body.size() <= piece) co_return;
  (void)co_await write(c, body);
}

awaitable<void> HttpConnections::Network::send_events(Connection& c, LiveRun& run, std::string cookie) {
  HttpAnswer answer;
  answer.content_type = "text/event-stream";
  const std::string head = head_text(answer, cookie, std::nullopt);  // they end with the connection
  if (!co_await write(c, head) || !c.wants_body) co_return;
  LiveRun::Reader reader;
  asio::steady_timer pause(context_);
  auto heard = Clock::now();
  while (auto text = run.next(reader, std::chrono::milliseconds(0))) {
    std::string greeting;
    if (text->empty() && Clock::now() - heard >= longest_silence) greeting = run.greeting(reader);
    if (text->empty() && greeting.empty()) {
      error_code ignored;
      pause.expires_after(event_pause);
      co_await pause.async_wait(into(ignored));
      if (is_gone(c.stream.socket())) co_return;
      continue;
    }
    heard = Clock::now();
    const std::string_view now = greeting.empty() ? std::string_view(*text) : greeting;
    if (!co_await write(c, now)) co_return;
  }
}

/// Whether all of it was taken; each piece within `timeout`.
awaitable<bool> HttpConnections::Network::write(Connection& c, std::string_view text) {
  error_code failed;
  for (std::size_t at = 0; at < text.size() && !failed; at += piece) {
    const std::string_view now = text.substr(at, piece);
    c.stream.expires_after(patience());
    co_await asio::async_write(c.stream, asio::buffer(now.data(), now.size()), into(failed));
  }
  co_return !failed;
}

HttpConnections::HttpConnections(const HttpServerOptions& options, Decide decide)
    : network_(std::make_unique<Network>(options, std::move(decide))) {}
HttpConnections::~HttpConnections() = default;
int HttpConnections::listen() { return network_->listen(); }
void HttpConnections::start() { network_->start(); }
void HttpConnections::stop() { network_->stop(); }

}  // namespace vantage
