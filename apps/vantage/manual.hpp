#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vantage::app {

// Texts that packages install beside the program, made of the same table of commands and options as the help.

/// The man page of the program or of one of its commands, in roff. Steps of a command (`session new`) are sections of
/// its page. `version` is printed in the footer.
[[nodiscard]] std::string man_page(const CLI::App& command, const std::string& version);

/// Completion of commands and long options for bash.
[[nodiscard]] std::string bash_completion(const CLI::App& program);

/// The same for zsh, with the meanings of the options.
[[nodiscard]] std::string zsh_completion(const CLI::App& program);

}  // namespace vantage::app
