#include "manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace vantage::app {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  std::vector<const CLI::App*> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (!command->get_group().empty()) commands.push_back(command);  // those without a group are hidden
  }
  return commands;
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  return app.get_options(
      [](const CLI::Option* option) { return option->nonpositional() && !option->get_group().empty(); });
}

/// `vantage session new` for a step, with `separator` between the words.
std::string full_name(const CLI::App& command, const std::string& separator) {
  const CLI::App* parent = command.get_parent();
  return parent ? full_name(*parent, separator) + separator + command.get_name() : command.get_name();
}

/// The text as roff prints it: no escapes, hyphens that can be copied, no line that begins with a request.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
  }
  const bool is_request = !result.empty() && (result[0] == '.' || result[0] == '\'');
  return is_request ? fmt::format("\\&{}", result) : result;
}

std::string option_line(const CLI::Option& option) {
  std::string text;
  for (const std::string& name : option.get_snames()) text += fmt::format("\\-{}, ", roff(name));
  for (const std::string& name : option.get_lnames()) text += fmt::format("\\-\\-{}, ", roff(name));
  if (text.size() > 2) text.resize(text.size() - 2);
  if (option.get_items_expected_max() == 0) return fmt::format("\\fB{}\\fR", text);
  return fmt::format("\\fB{}\\fR \\fI{}\\fR", text, roff(option.get_type_name()));
}

void add_options(std::string& page, const CLI::App& command) {
  const auto positionals = command.get_options([](const CLI::Option* option) { return option->get_positional(); });
  for (const CLI::Option* option : positionals) {
    page += fmt::format(".TP\n\\fI{}\\fR\n{}\n", roff(option->get_name(true)), roff(option->get_description()));
  }
  for (const CLI::Option* option : options_of(command)) {
    page += fmt::format(".TP\n{}\n{}", option_line(*option), roff(option->get_description()));
    const std::string value = option->get_default_str();
    if (!value.empty() && option->get_items_expected_max() > 0) page += fmt::format(" (default: {})", roff(value));
    page += '\n';
  }
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += fmt::format("{}{}", text.empty() ? "" : " ", word);
  return text;
}

std::vector<std::string> words_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::App* each : commands_of(command)) words.push_back(each->get_name());
  for (const CLI::Option* option : options_of(command)) {
    for (const std::string& name : option->get_lnames()) words.push_back(fmt::format("--{}", name));
  }
  return words;
}

/// The text in single quotes of a shell.
std::string quoted(const std::string& text) {
  std::string inside;
  for (const char c : text) c == '\'' ? inside += "'\\''" : inside += c;
  return fmt::format("'{}'", inside);
}

/// A meaning as zsh's _arguments takes it.
std::string zsh_meaning(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

void add_zsh_command(std::string& script, const CLI::App& command) {
  script += fmt::format("_{}() {{\n", full_name(command, "_"));
  const std::vector<const CLI::App*> steps = commands_of(command);
  std::string arguments;
  for (const CLI::Option* option : options_of(command)) {
    for (const std::string& name : option->get_lnames()) {
      const std::string value = option->get_items_expected_max() > 0 ? ":value:_files" : "";
      arguments += fmt::format(" \\\n    {}",
                               quoted(fmt::format("--{}[{}]{}", name, zsh_meaning(option->get_description()), value)));
    }
  }
  if (steps.empty()) {
    script += fmt::format("  _arguments{} \\\n    '*:file:_files'\n}}\n", arguments);
    return;
  }
  script += fmt::format(
      "  local line state\n  _arguments -C{} \\\n    '1:command:->command' '*::argument:->argument'\n", arguments);
  script += "  case $state in\n    command)\n      local -a commands=(\n";
  for (const CLI::App* step : steps) {
    script += fmt::format("        {}\n",
                          quoted(fmt::format("{}:{}", step->get_name(), zsh_meaning(step->get_description()))));
  }
  script += "      )\n      _describe command commands ;;\n    argument)\n      case $line[1] in\n";
  for (const CLI::App* step : steps) {
    script += fmt::format("        {}) _{} ;;\n", step->get_name(), full_name(*step, "_"));
  }
  script += "      esac ;;\n  esac\n}\n";
}

void add_zsh_commands(std::string& script, const CLI::App& command) {
  for (const CLI::App* step : commands_of(command)) add_zsh_commands(script, *step);
  add_zsh_command(script, command);
}

void add_bash_cases(std::string& script, const CLI::App& command) {
  script += fmt::format("    {}) words={} ;;\n", quoted(full_name(command, " ")), quoted(joined(words_of(command))));
  for (const CLI::App* step : commands_of(command)) add_bash_cases(script, *step);
}

}  // namespace

std::string man_page(const CLI::App& command, const std::string& version) {
  const std::string name = full_name(command, "-");
  std::string page = fmt::format(".TH {} 1 \"\" \"vantage {}\" \"User Commands\"\n", upper(roff(name)), version);
  page += fmt::format(".SH NAME\n{} \\- {}\n", roff(name), roff(command.get_description()));
  const std::vector<const CLI::App*> steps = commands_of(command);
  page += fmt::format(".SH SYNOPSIS\n.B {}\n", roff(full_name(command, " ")));
  if (!steps.empty()) page += ".I command\n";
  for (const CLI::Option* option :
       command.get_options([](const CLI::Option* each) { return each->get_positional(); })) {
    page += fmt::format(".I {}\n", roff(option->get_name(true)));
  }
  page += "[\\fIoptions\\fR]\n.SH OPTIONS\n";
  add_options(page, command);
  if (!steps.empty()) page += ".SH COMMANDS\n";
  for (const CLI::App* step : steps) {
    if (!command.get_parent()) {
      page += fmt::format(".TP\n\\fBvantage {}\\fR\n{}; see \\fBvantage\\-{}\\fR(1)\n", roff(step->get_name()),
                          roff(step->get_description()), roff(step->get_name()));
      continue;
    }
    page += fmt::format(".SS {}\n{}\n", roff(full_name(*step, " ")), roff(step->get_description()));
    add_options(page, *step);
  }
  page +=
      ".SH EXIT STATUS\n0: done. 1: failed at run time. 2: misuse or bad input; the message names the option, file "
      "or line and what would be right.\n";
  if (command.get_parent()) page += ".SH SEE ALSO\n.BR vantage (1)\n";
  return page;
}

std::string bash_completion(const CLI::App& program) {
  std::string script =
      "# Completion of vantage for bash.\n_vantage() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} command=vantage each words=\n"
      "  for each in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
      "    case \"$command $each\" in\n";
  std::string names;
  for (const CLI::App* command : commands_of(program)) {
    names += fmt::format("{}{}", names.empty() ? "" : "|", quoted(full_name(*command, " ")));
    for (const CLI::App* step : commands_of(*command)) names += fmt::format("|{}", quoted(full_name(*step, " ")));
  }
  script += fmt::format("      {}) command=\"$command $each\" ;;\n    esac\n  done\n  case $command in\n", names);
  add_bash_cases(script, program);
  script += "  esac\n  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}\n";
  script += "complete -o default -F _vantage vantage\n";  // files where no word fits
  return script;
}

std::string zsh_completion(const CLI::App& program) {
  std::string script = "#compdef vantage\n# Completion of vantage for zsh.\n";
  add_zsh_commands(script, program);
  return script + "_vantage \"$@\"\n";
}

}  // namespace vantage::app
