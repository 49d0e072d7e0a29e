#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace vantage::app {

/// Prints a note for people on standard error: progress, warnings. One that cannot be written (a full disk, a closed
/// pipe) is lost, and the work goes on.
template <class... Values>
void print_note(fmt::format_string<Values...> format, Values&&... values) {
  const std::string text = fmt::format(format, std::forward<Values>(values)...);
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
}

/// Makes sure that descriptors 0, 1 and 2 are taken, so that no file that is opened later gets what is printed, and
/// that a closed pipe is an error of writing instead of a signal that ends the program.
void prepare_standard_streams();

/// Throws Error where something that was printed on standard output could not be written.
void finish_standard_output();

}  // namespace vantage::app
