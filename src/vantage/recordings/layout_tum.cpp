#include <fmt/format.h>

#include <array>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/recordings/layout_parts.hpp"
#include "vantage/recordings/pose_source.hpp"

namespace vantage::layout_parts {
namespace {

constexpr double tum_metres_per_unit = 1.0 / 5000;

/// The lines `timestamp file` of depth.txt, or those parts of an associations file that name a depth image.
std::vector<LayoutFrame> listed_frames(const fs::path& list, FolderLayout& layout) {
  const std::string bytes = read_file(list);
  TextReader text(bytes, list.string());
  std::vector<LayoutFrame> frames;
  while (text.next_line_with_words()) {
    if (trimmed(text.rest_of_line())[0] == '#') continue;
    // An associations file has the pair of the depth image before or after that of the colour image.
    std::optional<LayoutFrame> found;
    while (!text.at_end_of_line()) {
      const double time = text.finite_number("timestamp");
      const std::string file(text.word());
      if (file.empty()) text.fail("the name of the file is missing");
      if (found && file.find("depth") == std::string::npos) continue;
      found = LayoutFrame{.name = fs::path(file).stem().string(), .depth = list.parent_path() / file, .time_s = time};
    }
    if (fs::is_regular_file(found->depth)) {
      frames.push_back(std::move(*found));
    } else {
      layout.left_out.push_back(fmt::format("frame {} has no file {}", in_quotes(found->name), found->depth.string()));
    }
  }
  require(!frames.empty(), list.string(), ": names no depth image that is there");
  return frames;
}

/// The intrinsics that the benchmark publishes for its three sensors; the sequences do not hold them.
std::optional<Intrinsics> published_intrinsics(const fs::path& folder) {
  const std::string name = fs::weakly_canonical(folder).filename().string();
  constexpr std::array<std::pair<const char*, std::array<double, 4>>, 3> sensors{
      {{"freiburg1", {517.3, 516.5, 318.6, 255.3}},
       {"freiburg2", {520.9, 521.0, 325.1, 249.7}},
       {"freiburg3", {535.4, 539.2, 320.1, 247.6}}}};
  for (const auto& [sensor, k] : sensors) {
    if (name.find(sensor) != std::string::npos)
      return Intrinsics{
          .fx = k[0], .fy = k[1], .cx = k[2], .cy = k[3], .resolution = Resolution{640, 480}, .distortion = {}};
  }
  return std::nullopt;
}

}  // namespace

std::optional<FolderLayout> tum(const fs::path& folder, const ScanFolderOptions& options) {
  const auto list = first_file(folder, {"depth.txt"});
  const auto trajectory = first_file(folder, {"groundtruth.txt"});
  if (!list || (!trajectory && options.poses.empty())) return std::nullopt;
  FolderLayout layout{.kind = "TUM RGB-D",
                      .poses = {},
                      .frames = {},
                      .intrinsics = published_intrinsics(folder),
                      .metres_per_unit = tum_metres_per_unit,
                      .left_out = {}};
  layout.frames = listed_frames(*list, layout);
  take_poses(layout, options.poses.empty() ? *trajectory : below(folder, options.poses), options);
  return layout;
}

std::optional<FolderLayout> icl_nuim(const fs::path& folder, const ScanFolderOptions& options) {
  const auto trajectory = first_file(folder, {"*.gt.freiburg"});
  if (!trajectory) return std::nullopt;
  // The set's cameras have y up (fy = -480), so that its frames are left-handed: turned over in y, in camera and world,
  // they are the same frames of a right-handed world.
  FolderLayout layout{
      .kind = "ICL-NUIM",
      .poses = {},
      .frames = {},
      .intrinsics =
          Intrinsics{
              .fx = 481.2, .fy = 480, .cx = 319.5, .cy = 239.5, .resolution = Resolution{640, 480}, .distortion = {}},
      .metres_per_unit = tum_metres_per_unit,
      .left_out = {}};
  const auto list = first_file(folder, {"associations.txt", "associate.txt"});
  layout.frames = list ? listed_frames(*list, layout) : frames_of(depth_images_in(folder / "depth"));
  for (LayoutFrame& frame : layout.frames) frame.time_s.reset();  // they are numbers
  ScanFolderOptions by_number = options;
  if (options.match == PoseMatch::automatic) by_number.match = PoseMatch::name;
  take_poses(layout, *trajectory, by_number);
  Eigen::Matrix4d mirror = Eigen::Matrix4d::Identity();
  mirror(1, 1) = -1;
  for (LayoutFrame& frame : layout.frames)
    frame.world_from_sensor = Pose(Eigen::Matrix4d(mirror * frame.world_from_sensor->matrix() * mirror));
  return layout;
}

}  // namespace vantage::layout_parts
