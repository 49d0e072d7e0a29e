#include "help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace vantage::app {
namespace {

struct Group {
  std::string_view title;
  std::vector<std::string_view> options;
};

struct CommandHelp {
  std::vector<Group> groups;
  std::string_view example;
};

const std::vector<Group>& groups_of_scans() {
  static const std::vector<Group> groups{
      {"Scene", {"--box", "--voxel", "--views", "--radius"}},
      {"Reading scans",
       {"--depth-scale", "--depth-range", "--unit", "--poses", "--intrinsics", "--masks", "--hand-eye", "--topic",
        "--frame", "--every", "--sensor"}},
      {"Registration", {"--registration", "--pose-error", "--pose-angle-error"}},
      {"Planning", {"--utility", "--workspace", "--robot", "--deadline"}},
      {"Output", {"--out", "--overwrite", "--report", "--watertight", "--top", "--json", "--config"}}};
  return groups;
}

CommandHelp help_of(const std::string& command) {
  if (command == "reconstruct") {
    return {{{"Scene", {"--size", "--voxel", "--camera", "--depth-noise", "--sensor", "--candidates"}},
             {"Planning", {"--utility", "--search", "--robot", "--workspace", "--max-views", "--seed"}},
             {"Robot that misses",
              {"--positioning-error", "--orientation-error", "--registration", "--convolve", "--believed-error"}},
             {"Output", {"--out", "--overwrite", "--report", "--watertight", "--serve", "--config"}}},
            "vantage reconstruct mug --out runs/mug"};
  }
  if (command == "plan") {
    return {groups_of_scans(),
            "vantage plan FRAMES --box=0,0,0.1,0.3,0.3,0.3 --depth-range 0.25,1.5 --out runs/object"};
  }
  if (command == "new") {
    return {groups_of_scans(), "vantage session new object --box=0,0,0.1,0.3,0.3,0.3 --depth-range 0.25,1.5"};
  }
  if (command == "add") {
    return {{{"Reading scans",
              {"--depth-scale", "--unit", "--poses", "--intrinsics", "--masks", "--hand-eye", "--topic", "--frame",
               "--every", "--candidate"}}},
            "vantage session add object frame-000150.depth.png"};
  }
  if (command == "doctor") {
    return {{{"Scene", {"--box", "--voxel"}},
             {"Reading scans",
              {"--depth-scale", "--depth-range", "--unit", "--poses", "--intrinsics", "--masks", "--hand-eye",
               "--topic", "--frame"}},
             {"Output", {"--json"}}},
            "vantage doctor FRAMES --depth-range 0.25,1.5"};
  }
  if (command == "evaluate") {
    return {{{"Views", {"--candidates", "--camera", "--utility", "--search", "--rays"}},
             {"Output", {"--top", "--json", "--config"}}},
            "vantage evaluate runs/mug/map.nrrd --candidates sphere:320:2 --utility gua"};
  }
  return {};
}

bool asked_for_all(const CLI::App* app) {
  for (; app; app = app->get_parent()) {
    if (app->get_help_all_ptr() && app->get_help_all_ptr()->count() > 0) return true;
  }
  return false;
}

/// `session new` for the step of a command.
std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent && parent->get_parent() ? full_name(*parent) + " " + command.get_name() : command.get_name();
}

/// Shows further options only where all are asked for; otherwise says how many there are.
class HelpFormatter : public CLI::Formatter {
 public:
  explicit HelpFormatter(const CLI::App* command) : command_(command) {}

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
    const auto further =
        app->get_options([](const CLI::Option* option) { return option->get_group() == further_options; });
    for (std::size_t at = 0; (at = text.find("\n\n\n", at)) != std::string::npos;) text.erase(at, 1);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    text += '\n';
    if (!further.empty() && !asked_for_all(command_)) {
      text += fmt::format("\n{} further options: vantage {} --help-all\n", further.size(), full_name(*app));
    }
    return text;
  }
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    if (group == further_options && !asked_for_all(command_)) return {};
    return CLI::Formatter::make_group(std::move(group), is_positional, std::move(options));
  }
  std::string make_usage(const CLI::App* app, std::string name) const override {
    std::string text = CLI::Formatter::make_usage(app, std::move(name));
    const std::string_view example = help_of(app->get_name()).example;
    return example.empty() ? text : text + fmt::format("Example: {}\n", example);
  }

 private:
  const CLI::App* command_;
};

void arrange(CLI::App& command) {
  command.set_help_all_flag("--help-all", "Print all options and exit");
  const CommandHelp help = help_of(command.get_name());
  if (!help.groups.empty()) {
    for (CLI::Option* option : command.get_options()) {
      if (option->get_group().empty()) continue;  // hidden
      if (option->get_positional() || option == command.get_help_ptr() || option == command.get_help_all_ptr())
        continue;
      option->group(further_options);
      for (const Group& group : help.groups) {
        const bool in_group = std::any_of(group.options.begin(), group.options.end(), [&](std::string_view name) {
          return option->check_lname(std::string(name.substr(2)));
        });
        if (in_group) option->group(std::string(group.title));
      }
    }
  }
  const auto formatter = std::make_shared<HelpFormatter>(&command);
  formatter->column_width(34);
  command.formatter(formatter);
  for (CLI::App* step : command.get_subcommands({})) arrange(*step);
}

}  // namespace

void arrange_help(CLI::App& program) { arrange(program); }

}  // namespace vantage::app
