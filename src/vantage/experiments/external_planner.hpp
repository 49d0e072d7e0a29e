#pragma once

#include <string>

#include "vantage/utility/utility.hpp"

namespace vantage {

struct ExternalPlannerOptions {
  std::string command;  // run by /bin/sh
  double timeout = 60;  // seconds for every answer

  /// Throws InputError naming the field.
  void validate() const;
};

/// A planner in another program, of any language. It is started once; for every choice it is given one line of JSON on
/// its standard input (docs/new-utility.md):
///
///     {"map": "/tmp/vantage-xyz/map.nrrd", "current": [4x4], "scanned": [[4x4], ...], "camera": {...},
///      "candidates": [{"index": 3, "pose": [4x4], "n_oc": ..., "n_op": ..., "n_um": ..., "travel": ...}, ...]}
///
/// The map files lie in a folder of their own, are replaced from choice to choice and removed with the utility. It
/// answers with one line {"index": 3}, naming a candidate of the line. Its standard error goes to ours. Using the
/// utility throws Error that names the command and what it answered, where it ends, is late or answers something else.
[[nodiscard]] Utility external_planner(const ExternalPlannerOptions& options);

}  // namespace vantage
