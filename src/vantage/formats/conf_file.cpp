#include "vantage/formats/conf_file.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/pose_file.hpp"

namespace vantage {

std::vector<ConfScan> parse_conf(std::string_view bytes, const std::string& name) {
  TextReader text(bytes, name);
  std::vector<ConfScan> scans;
  while (text.next_line_with_words()) {
    const std::string_view keyword = text.word();
    if (keyword != "bmesh" && keyword != "mesh") continue;
    ConfScan scan;
    scan.file = text.word();
    if (scan.file.empty()) text.fail("the name of the scan's file is missing");
    if (std::filesystem::path(scan.file).has_parent_path())
      text.fail(fmt::format("{}: must be the name of a file beside this one", in_quotes(scan.file)));
    std::array<double, 7> n{};
    constexpr std::array<const char*, 7> columns{"tx", "ty", "tz", "qx", "qy", "qz", "qw"};
    for (std::size_t i = 0; i < n.size(); ++i) n[i] = text.finite_number(columns[i]);
    const Eigen::Quaterniond rotation(n[6], n[3], n[4], n[5]);
    // The files give the rotation of the axes, which is the inverse of that of the points.
    scan.world_from_scan =
        pose_from_quaternion({n[0], n[1], n[2]}, rotation.conjugate(), fmt::format("{}: {}", name, scan.file));
    scans.push_back(std::move(scan));
  }
  require(!scans.empty(), name, ": has no line 'bmesh FILE tx ty tz qx qy qz qw'");
  return scans;
}

}  // namespace vantage
