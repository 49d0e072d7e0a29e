#pragma once

#include <mutex>
#include <optional>
#include <utility>

namespace vantage {

/// What had to be read early, for the first one who asks for it, so that it is not decoded again. May be asked from
/// several threads.
template <class Value>
class ReadAhead {
 public:
  explicit ReadAhead(Value value) : value_(std::move(value)) {}

  [[nodiscard]] std::optional<Value> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(value_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::optional<Value> value_;
};

}  // namespace vantage
