#pragma once

// Asio uses std::exchange without including what declares it.
#include <utility>

#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <optional>
#include <thread>
#include <vector>

#include "vantage/server/http_server.hpp"

namespace vantage {

/// Threads for handlers, which may wait. They are made when they are needed, so that few requests need few.
class HttpWorkers {
 public:
  explicit HttpWorkers(int most) : most_(static_cast<std::size_t>(most)) {}
  ~HttpWorkers() { stop(); }
  HttpWorkers(const HttpWorkers&) = delete;
  HttpWorkers& operator=(const HttpWorkers&) = delete;

  /// Throws std::system_error where no thread is to be had.
  void start();
  /// Returns when the handlers that run have returned.
  void stop();

  /// What `handle` returns, which runs in one of the threads and lives as long as the coroutine that waits here. For
  /// coroutines of one thread.
  boost::asio::awaitable<HttpAnswer> run(const std::function<HttpAnswer()>& handle);

 private:
  boost::asio::awaitable<HttpAnswer> answer(const std::function<HttpAnswer()>& handle);
  void add_thread();

  std::size_t most_;
  boost::asio::io_context context_;
  std::optional<boost::asio::executor_work_guard<boost::asio::io_context::executor_type>> guard_;
  std::vector<std::thread> threads_;
  std::atomic<std::size_t> busy_ = 0;  // answers under way or waiting for a thread
};

}  // namespace vantage
