#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "notes.hpp"
#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/options/options.hpp"

namespace vantage::app {

/// What the help calls a value of this kind.
inline const char* type_name(OptionField::Kind kind) {
  switch (kind) {
    case OptionField::Kind::number:
      return "NUMBER";
    case OptionField::Kind::list:
      return "NUMBERS";
    case OptionField::Kind::flag:
    case OptionField::Kind::text:
      break;
  }
  return "TEXT";
}

/// Lines about former names of options.
inline void print_hints(const std::vector<std::string>& hints) {
  for (const std::string& hint : hints) print_note("vantage: {}\n", printable(hint));
}

/// Adds one option: `--name VALUE`, or `--name` and `--no-name` for a flag.
inline void add_option(CLI::App& command, const OptionField& field) {
  const std::string help = field.unit.empty() ? field.meaning : fmt::format("{} [{}]", field.meaning, field.unit);
  if (field.kind == OptionField::Kind::flag) {
    command.add_flag_function(
        fmt::format("--{0},!--no-{0}", field.name),
        [field](std::int64_t count) { set_option(field, count > 0 ? "true" : "false", "--" + field.name); }, help);
    return;
  }
  CLI::Option* option = command.add_option_function<std::string>(
      "--" + field.name, [field](const std::string& text) { set_option(field, text, "--" + field.name); }, help);
  option->type_name(type_name(field.kind));
  if (field.text() != no_value) option->default_str(field.text());
}

/// Adds the former names of an option, which no help shows and which print a hint.
inline void add_former_names(CLI::App& command, const OptionField& field) {
  for (const FormerName& former : field.former) {
    OptionField renamed = field;
    renamed.name = former.name;
    renamed.former = {};
    renamed.set = [field, former](std::string_view text) {
      print_hints({rename_hint("--" + former.name, former, "--" + field.name)});
      return field.set(text);
    };
    add_option(command, renamed);
    command.get_option("--" + former.name)->group("");
  }
}

/// Adds the options as `--name VALUE`, flags as `--name` and `--no-name`, with defaults, units and meanings in the
/// help, and `--config FILE` for all of them at once: what stands on the command line wins over the file. The options
/// that the fields belong to must outlive the parsing; a bad value is an InputError that names the option. `also_known`
/// are names of other commands' options that a common configuration file may hold.
inline void add_options(CLI::App& command, const std::vector<OptionField>& fields,
                        const std::vector<std::string>& also_known = {}) {
  // CLI11 runs callbacks in the order in which options were added, so the file comes first.
  command.add_option_function<std::string>(
      "--config",
      [fields, also_known](const std::string& path) {
        const std::string text = read_file(path);
        // A full disk leaves such files: defaults are not what anybody means by one.
        require(!trimmed(text).empty(), path, ": is empty; must have lines 'option: value', or leave --config out");
        print_hints(set_options_from_yaml(fields, text, path, also_known));
      },
      "YAML file with options; see `vantage config`");
  for (const OptionField& field : fields) {
    add_option(command, field);
    add_former_names(command, field);
  }
}

/// The fields and those of another struct with a describe() behind them. The struct must outlive them.
template <class Options>
std::vector<OptionField> with_fields(std::vector<OptionField> fields, Options& options) {
  for (OptionField& field : option_fields(options)) fields.push_back(std::move(field));
  return fields;
}

/// Appends the fields whose values are not the defaults.
template <class Options>
void append_changed(std::vector<OptionField>& fields, Options& options) {
  Options defaults;
  const std::vector<OptionField> unchanged = option_fields(defaults);
  std::vector<OptionField> mine = option_fields(options);
  for (std::size_t i = 0; i < mine.size(); ++i) {
    if (mine[i].text() != unchanged[i].text()) fields.push_back(std::move(mine[i]));
  }
}

/// The same for a struct with a describe().
template <class Options>
void add_options(CLI::App& command, Options& options) {
  add_options(command, option_fields(options));
}

}  // namespace vantage::app
