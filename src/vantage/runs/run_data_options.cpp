#include "vantage/core/error.hpp"
#include "vantage/options/options.hpp"
#include "vantage/runs/run_data.hpp"

namespace vantage {
namespace {

/// Notes every option as the command line writes it.
struct OptionTexts {
  std::vector<std::pair<std::string, std::string>> texts;

  template <class T>
  void operator()(const std::string& name, const T& value, const std::string&, const std::string&) {
    texts.emplace_back("--" + name, text(value));
  }
  static std::string text(bool value) { return value ? "yes" : "no"; }
  static std::string text(const std::string& value) { return value; }
  template <class T>
  static std::string text(const std::optional<T>& value) {
    return value ? text(*value) : "";
  }
  template <class T>
  static std::string text(const T& value) {
    if constexpr (requires { T::RowsAtCompileTime; }) {
      std::string list;
      for (Eigen::Index i = 0; i < value.size(); ++i) list += concat(i == 0 ? "" : ",", value[i]);
      return list;
    } else if constexpr (std::is_arithmetic_v<T>) {
      return concat(value);
    } else {
      return OptionValue<T>::print(value);
    }
  }
};

}  // namespace

RunData run_data(const ReconstructOptions& options, const std::string& object, const std::string& program,
                 const TriangleMesh& truth) {
  RunData run;
  run.command = "reconstruct";
  run.object = object;
  run.program = program;
  run.seed = options.seed;
  run.simulated = true;
  run.state = RunData::State::running;
  const SceneOptions scene = options.scene_options();
  run.grid = scene.grid();
  run.enclosure = scene.enclosure();
  run.camera = options.range_camera();
  run.candidates = options.candidate_views();
  run.candidates_text = options.candidates;
  run.truth = truth;

  ReconstructOptions given = options, standard;
  OptionTexts of_run, of_standard;
  describe(given, of_run);
  describe(standard, of_standard);
  for (std::size_t i = 0; i < of_run.texts.size(); ++i) {
    const std::string& name = of_run.texts[i].first;
    const bool always = name == "--camera" || name == "--candidates" || name == "--search" || name == "--registration";
    if (always || of_run.texts[i].second != of_standard.texts[i].second) run.options.push_back(of_run.texts[i]);
  }
  return run;
}

}  // namespace vantage
