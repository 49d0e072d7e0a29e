#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace vantage {

/// Anything that went wrong at run time: a full disk, an unreadable file, a robot that does not answer. Exit code 1.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Misuse or bad input: the text names the field, line or file, the value, and what would be right. Exit code 2.
class InputError : public Error {
 public:
  using Error::Error;
};

/// The parts written one after the other, as `operator<<` prints them. Throws where memory is short: a stream by itself
/// would cut the text off without a word.
template <class... Parts>
[[nodiscard]] std::string concat(const Parts&... parts) {
  std::ostringstream text;
  text.exceptions(std::ios::badbit);
  text.precision(12);
  (text << ... << parts);
  return text.str();
}

/// Throws InputError with the concatenated parts unless `condition` holds.
template <class... Parts>
void require(bool condition, const Parts&... parts) {
  if (!condition) throw InputError(concat(parts...));
}

}  // namespace vantage
