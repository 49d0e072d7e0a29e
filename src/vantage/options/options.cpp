#include "vantage/options/options.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "vantage/core/error.hpp"
#include "vantage/core/number_text.hpp"
#include "vantage/files/format_version.hpp"
#include "vantage/files/yaml_text.hpp"

namespace vantage {
namespace {

constexpr std::string_view head_start = "# configuration of vantage, format ";
constexpr int configuration_format = 1;

/// Letters to insert, delete or replace, and neighbours to swap, to make one text of the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> two_back(b.size() + 1), back(b.size() + 1), row(b.size() + 1);
  std::iota(back.begin(), back.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({back[j] + 1, row[j - 1] + 1, back[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_back[j - 2] + 1);
    }
    std::swap(two_back, back);
    std::swap(back, row);
  }
  return back[b.size()];
}

/// The text of a value: a scalar, or a flat list as its items with commas between.
std::string value_text(const YAML::Node& value, std::string_view key, const std::string& name) {
  if (value.IsNull()) return std::string(no_value);
  if (value.IsScalar()) return value.Scalar();
  std::string text;
  for (std::size_t i = 0; value.IsSequence() && i < value.size(); ++i) {
    require(value[i].IsScalar(), place_of(value, name), ": ", key, ": must be a value or a flat list");
    text.append(i == 0 ? "" : ",").append(value[i].Scalar());
  }
  require(value.IsSequence(), place_of(value, name), ": ", key, ": must be a value or a flat list");
  return text;
}

bool is_plain_yaml(std::string_view text) {
  const auto is_safe = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
           c == '/' || c == ',' || c == '-' || c == '+' || c == ':';
  };
  if (text.empty() || !std::all_of(text.begin(), text.end(), is_safe)) return false;
  if (text == "null" || text == "Null" || text == "NULL") return false;  // YAML's word for nothing
  // A colon is safe inside a word ("sphere:80:2"), not at its end; a dash not in front.
  return text.back() != ':' && text.front() != '-' && text.front() != ',' && text.front() != ':';
}

std::string as_yaml(const OptionField& field) {
  const std::string text = field.text();
  if (field.kind == OptionField::Kind::list && text.find(',') != std::string::npos) {
    std::string list = "[";
    for (const char c : text) list.append(c == ',' ? ", " : std::string(1, c));
    return list + "]";
  }
  if (field.kind != OptionField::Kind::text || is_plain_yaml(text)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string unit_and_meaning(const OptionField& field) {
  return field.unit.empty() ? field.meaning : fmt::format("{} [{}]", field.meaning, field.unit);
}

std::string escaped_cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, 1, '\\');
  return text;
}

/// The field of this name, or that had it once.
auto field_called(const std::vector<OptionField>& fields, const std::string& name) {
  const auto has_name = [&](const OptionField& field) { return field.name == name; };
  const auto had_name = [&](const OptionField& field) {
    return std::any_of(field.former.begin(), field.former.end(), [&](const auto& each) { return each.name == name; });
  };
  const auto found = std::find_if(fields.begin(), fields.end(), has_name);
  return found != fields.end() ? found : std::find_if(fields.begin(), fields.end(), had_name);
}

[[noreturn]] void fail_unknown(const std::string& key, const std::string& place,
                               const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(key, names);
  const std::string hint =
      nearest.empty() ? "`vantage config` prints all there are" : fmt::format("did you mean '{}'?", nearest);
  throw InputError(fmt::format("{}: unknown option {}; {}", place, in_quotes(key), hint));
}

}  // namespace

std::string nearest_name(std::string_view written, const std::vector<std::string>& names) {
  std::string best;
  std::size_t least = std::max<std::size_t>(2, written.size() / 3) + 1;
  if (written.size() > 100) return best;  // no name, and not worth the time
  for (const std::string& name : names) {
    const std::size_t distance = edit_distance(written, name);
    if (distance < least) {
      least = distance;
      best = name;
    }
  }
  return best;
}

std::vector<OptionField> fields_named(const std::vector<OptionField>& fields, const std::vector<std::string>& names) {
  std::vector<OptionField> chosen;
  for (const OptionField& field : fields) {
    if (std::find(names.begin(), names.end(), field.name) != names.end()) chosen.push_back(field);
  }
  return chosen;
}

void set_option(const OptionField& field, std::string_view text, const std::string& place) {
  if (field.set(text)) return;
  throw InputError(fmt::format("{} = {}: must be {}", place, in_quotes(text), field.expected));
}

std::string configuration_head() { return fmt::format("{}{}\n", head_start, configuration_format); }

void require_known_configuration(std::string_view yaml, const std::string& name) {
  while (yaml.starts_with('#')) {
    int found = 0;
    const std::string_view line = yaml.substr(0, yaml.find('\n'));
    if (line.starts_with(head_start)) found = leading_number(line.substr(head_start.size()));
    require_known_format(found, configuration_format, name);
    yaml.remove_prefix(std::min(line.size() + 1, yaml.size()));
  }
}

std::vector<std::string> set_options_from_yaml(const std::vector<OptionField>& fields, std::string_view yaml,
                                               const std::string& name, const std::vector<std::string>& also_known) {
  require_known_configuration(yaml, name);
  std::vector<std::string> hints;
  const YAML::Node root = parse_yaml(yaml, name);
  if (root.IsNull()) return hints;  // an empty file changes nothing
  require(root.IsMap(), name, ": must be a list of lines 'option: value'");
  std::set<std::string> seen;
  for (const auto& entry : root) {
    require(entry.first.IsScalar(), place_of(entry.first, name), ": the name of an option must be a word");
    const std::string& key = entry.first.Scalar();
    const std::string place = place_of(entry.first, name);
    const auto field = field_called(fields, key);
    const std::string& now = field != fields.end() ? field->name : key;
    require(seen.insert(now).second, place, ": option ", in_quotes(now), " stands twice");
    if (field != fields.end()) {
      for (const FormerName& former : field->former)
        if (former.name == key) hints.push_back(rename_hint(fmt::format("{}: {}", place, key), former, now));
      set_option(*field, value_text(entry.second, key, name), fmt::format("{}: {}", place, key));
    } else if (std::find(also_known.begin(), also_known.end(), key) == also_known.end()) {
      std::vector<std::string> names = also_known;
      for (const OptionField& known : fields) names.push_back(known.name);
      fail_unknown(key, place, names);
    }
  }
  return hints;
}

std::string options_as_yaml(const std::vector<OptionField>& fields) {
  std::size_t width = 0;
  for (const OptionField& field : fields) width = std::max(width, field.name.size() + 2 + as_yaml(field).size());
  std::string yaml;
  for (const OptionField& field : fields) {
    yaml +=
        fmt::format("{:{}}  # {}\n", fmt::format("{}: {}", field.name, as_yaml(field)), width, unit_and_meaning(field));
  }
  return yaml;
}

std::string options_as_markdown(const std::vector<OptionField>& fields) {
  std::string table = "| option | default | unit | meaning |\n|---|---|---|---|\n";
  for (const OptionField& field : fields) {
    const std::string value = field.text();
    table += fmt::format("| `{}` | {} | {} | {} |\n", field.name,
                         value.empty() ? "" : fmt::format("`{}`", escaped_cell(value)), escaped_cell(field.unit),
                         escaped_cell(field.meaning));
  }
  return table;
}

}  // namespace vantage
