#pragma once

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <string>
#include <type_traits>

#include "vantage/core/error.hpp"
#include "vantage/reconstruction/options.hpp"

namespace vantage::app {

/// Adds every described field of an options struct to a subcommand as `--name`, with its default, unit and meaning in
/// the help. The struct must outlive the parsing.
class OptionAdder {
 public:
  explicit OptionAdder(CLI::App& command) : command_(command) {}

  template <class T>
  void operator()(const std::string& name, T& member, const std::string& unit, const std::string& meaning) {
    const std::string text = unit.empty() ? meaning : fmt::format("{} [{}]", meaning, unit);
    if constexpr (std::is_same_v<T, bool>) {
      command_.add_flag(fmt::format("--{0},!--no-{0}", name), member, text);
    } else if constexpr (requires { T::RowsAtCompileTime; }) {
      add_vector(name, member, text);
    } else {
      command_.add_option("--" + name, member, text)->capture_default_str();
    }
  }

 private:
  template <class Vector>
  void add_vector(const std::string& name, Vector& member, const std::string& text) {
    std::string value;
    for (int i = 0; i < member.size(); ++i) value += fmt::format("{}{}", i == 0 ? "" : ",", member[i]);
    command_
        .add_option_function<std::string>(
            "--" + name,
            [name, &member](const std::string& given) {
              const std::vector<double> numbers =
                  numbers_from_text(name, given, static_cast<std::size_t>(member.size()));
              for (int i = 0; i < member.size(); ++i) {
                member[i] = static_cast<typename Vector::Scalar>(numbers[static_cast<std::size_t>(i)]);
                require(static_cast<double>(member[i]) == numbers[static_cast<std::size_t>(i)], name, ": '", given,
                        "' must be whole numbers");
              }
            },
            text)
        ->default_str(value);
  }

  CLI::App& command_;
};

template <class Options>
void add_options(CLI::App& command, Options& options) {
  describe(options, OptionAdder(command));
}

}  // namespace vantage::app
