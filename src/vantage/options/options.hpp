#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/options/former_names.hpp"
#include "vantage/options/text_value.hpp"

// One description serves the YAML file, the command line and the documents. An options struct has beside it
//
//     template <class Field>
//     void describe(MyOptions& o, Field&& field) {
//       field("max-views", o.max_views, "", "stop after this many scans");
//     }
//
// with name, member, unit and meaning of each option; option_fields() makes of it what the functions here and the
// command line take.
namespace vantage {

/// One option of a struct that must outlive it.
struct OptionField {
  enum class Kind { flag, number, list, text };

  std::string name, unit, meaning;
  Kind kind = Kind::text;
  std::string expected;                       // what a value must be, for errors
  std::function<bool(std::string_view)> set;  // false, and no change, where the text is not understood
  std::function<std::string()> text;          // the value now
  std::vector<FormerName> former = {};        // names that still work, with a hint
};

/// How an option is read and shown; an optional one may be `none`.
template <class T>
struct OptionValue {
  static std::string print(const T& value) { return TextValue<T>::print(value); }
  static std::string expected() { return TextValue<T>::expected(); }
  /// False, and no change, where the text is not understood.
  static bool assign(T& member, std::string_view text) {
    const auto value = TextValue<T>::parse(text);
    if (value) member = *value;
    return value.has_value();
  }
};

template <class T>
struct OptionValue<std::optional<T>> {
  static std::string print(const std::optional<T>& value) {
    return value ? TextValue<T>::print(*value) : std::string(no_value);
  }
  static std::string expected() { return TextValue<T>::expected() + ", or none"; }
  static bool assign(std::optional<T>& member, std::string_view text) {
    const auto value = text == no_value ? std::nullopt : TextValue<T>::parse(text);
    if (value || text == no_value) member = value;
    return value || text == no_value;
  }
};

/// Makes fields of what describe() tells.
class OptionCollector {
 public:
  template <class T>
  void operator()(std::string_view name, T& member, std::string_view unit, std::string_view meaning) {
    fields.push_back({std::string(name), std::string(unit), std::string(meaning), kind_of<T>(),
                      OptionValue<T>::expected(),
                      [&member](std::string_view text) { return OptionValue<T>::assign(member, text); },
                      [&member] { return OptionValue<T>::print(member); }, former_names(name)});
  }

  std::vector<OptionField> fields;

 private:
  template <class T>
  static constexpr OptionField::Kind kind_of() {
    if constexpr (requires {
                    typename T::value_type;
                    T().has_value();
                  }) {
      return kind_of<typename T::value_type>() == OptionField::Kind::flag ? OptionField::Kind::text
                                                                          : kind_of<typename T::value_type>();
    } else if constexpr (std::is_same_v<T, bool>) {
      return OptionField::Kind::flag;
    } else if constexpr (std::is_arithmetic_v<T>) {
      return OptionField::Kind::number;
    } else if constexpr (std::is_same_v<T, DepthDeviation> || requires { T::RowsAtCompileTime; }) {
      return OptionField::Kind::list;
    } else {
      return OptionField::Kind::text;
    }
  }
};

/// The options of a struct, in the order in which describe() names them.
template <class Options>
[[nodiscard]] std::vector<OptionField> option_fields(Options& options) {
  OptionCollector collector;
  describe(options, collector);
  return std::move(collector.fields);
}

/// Those of the fields that have one of the names, in the order of the fields.
[[nodiscard]] std::vector<OptionField> fields_named(const std::vector<OptionField>& fields,
                                                    const std::vector<std::string>& names);

/// Sets an option from text. Throws InputError "PLACE = 'TEXT': must be ...".
void set_option(const OptionField& field, std::string_view text, const std::string& place);

/// Sets the options that a YAML map names; lists like [0, 0, 1] are the same as texts like 0,0,1. Throws InputError
/// with `name`, the line and what would be right where the YAML is malformed, a key is unknown (the nearest name is
/// suggested) or stands twice, a value is of the wrong type, or a newer program wrote the file (configuration_head()).
/// `also_known` keys belong to others and are passed over. Returns a line for people per former name that is used.
std::vector<std::string> set_options_from_yaml(const std::vector<OptionField>& fields, std::string_view yaml,
                                               const std::string& name,
                                               const std::vector<std::string>& also_known = {});

/// A comment for the head of a configuration, by which an older program knows that it does not understand a newer one.
[[nodiscard]] std::string configuration_head();
/// Throws InputError where the comments at the beginning say that the configuration is of a newer format.
void require_known_configuration(std::string_view yaml, const std::string& name);

/// All options as YAML, one per line, with unit and meaning as comments; set_options_from_yaml() gives the same values.
[[nodiscard]] std::string options_as_yaml(const std::vector<OptionField>& fields);

/// A Markdown table of the options: name, default, unit, meaning.
[[nodiscard]] std::string options_as_markdown(const std::vector<OptionField>& fields);

/// The name with the least edit distance to what was written, empty where none is similar.
[[nodiscard]] std::string nearest_name(std::string_view written, const std::vector<std::string>& names);

}  // namespace vantage
