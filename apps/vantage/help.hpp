#pragma once

#include <CLI/CLI.hpp>

namespace vantage::app {

/// Gives every command its help: `--help` shows the options that most people need, in groups, with an example;
/// `--help-all` shows all of them. Call it after all commands were added.
void arrange_help(CLI::App& program);

/// The group of the options that only `--help-all` shows.
inline constexpr const char* further_options = "Further options";

}  // namespace vantage::app
