#include "vantage/server/http_workers.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <system_error>

namespace vantage {

namespace asio = boost::asio;

void HttpWorkers::start() {
  guard_.emplace(context_.get_executor());
  threads_.emplace_back([this] { context_.run(); });
}

void HttpWorkers::stop() {
  guard_.reset();
  context_.stop();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

asio::awaitable<HttpAnswer> HttpWorkers::run(const std::function<HttpAnswer()>& handle) {
  if (busy_ >= threads_.size() && threads_.size() < most_) add_thread();
  ++busy_;
  return asio::co_spawn(context_.get_executor(), answer(handle), asio::use_awaitable);
}

asio::awaitable<HttpAnswer> HttpWorkers::answer(const std::function<HttpAnswer()>& handle) {
  struct Done {
    std::atomic<std::size_t>& count;
    ~Done() { --count; }
  } done{busy_};
  co_return handle();
}

void HttpWorkers::add_thread() {
  try {
    threads_.emplace_back([this] { context_.run(); });
  } catch (const std::system_error&) {
    // The threads that there are answer one after the other.
  }
}

}  // namespace vantage
