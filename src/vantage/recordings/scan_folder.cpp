#include "vantage/recordings/scan_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/natural_order.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/conf_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/recordings/bag_frames.hpp"
#include "vantage/recordings/camera_source.hpp"
#include "vantage/recordings/folder_layout.hpp"
#include "vantage/recordings/frame_scans.hpp"
#include "vantage/recordings/pixel_choice.hpp"
#include "vantage/recordings/pose_source.hpp"
#include "vantage/recordings/read_ahead.hpp"
#include "vantage/recordings/scan_bytes.hpp"
#include "vantage/sensor/organised_normals.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::array frame_endings{".depth.png", ".depth.exr", ".depth.tif", ".depth.tiff",
                                   ".depth.npy", ".depth.pfm", ".depth.raw"};
constexpr std::array cloud_endings{".ply", ".pcd", ".xyz", ".xyzn"};
constexpr std::array conf_endings{".conf"};

/// A scan's file and its name without the endings that tell what it is.
struct Found {
  std::string name;
  fs::path path;
};

bool ends_with(const std::string& text, std::string_view ending) {
  return text.size() > ending.size() && text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

std::vector<Found> files_ending_with(const fs::path& folder, std::span<const char* const> endings) {
  std::vector<Found> found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    for (const std::string_view ending : endings) {
      if (file[0] != '.' && ends_with(file, ending))
        found.push_back({file.substr(0, file.size() - ending.size()), entry.path()});
    }
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return comes_before(a.name, b.name); });
  for (std::size_t i = 1; i < found.size(); ++i) {
    require(found[i - 1].name != found[i].name, found[i].path.string(), ": stands beside ",
            found[i - 1].path.filename().string(), "; a scan must be one file");
  }
  return found;
}

/// A scan that has a pose.
struct Posed {
  Found file;
  Pose world_from_sensor;
};

/// The scans that have a pose, with it; the others are named in the set as left out.
std::vector<Posed> posed_scans(const fs::path& folder, const std::vector<Found>& scans,
                               const ScanFolderOptions& options, ScanSet& set) {
  std::vector<FrameKey> keys;
  for (const Found& scan : scans) keys.push_back({scan.name, std::nullopt});
  const MatchedPoses matched = poses_of_scans(folder, options.poses, keys, options.match);
  const Pose hand_eye = hand_eye_offset(options);
  std::vector<Posed> posed;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (matched.poses[i]) {
      posed.push_back({scans[i], sensor_pose(*matched.poses[i], hand_eye, options)});
    } else {
      set.left_out.push_back(fmt::format("scan {} {}", in_quotes(scans[i].name), matched.why_not[i]));
    }
  }
  return posed;
}

bool has_mask(const fs::path& folder, const std::string& name) { return fs::exists(folder / (name + ".mask.png")); }

ScanSet open_depth_frames(const fs::path& folder, const std::vector<Found>& frames, const ScanFolderOptions& options) {
  const fs::path file = intrinsics_file(folder, options.intrinsics);
  const Intrinsics intrinsics = read_intrinsics(file);
  RangeCamera camera;
  std::shared_ptr<ReadAhead<DepthPixels>> first;  // says how large the images are
  const auto place = [&](const InputError& error) {
    return fmt::format("{} with {}: {}", file.string(), frames.front().path.filename().string(), error.what());
  };
  try {
    const fs::path& path = frames.front().path;
    DepthPixels pixels = decode_depth(read_file(path), intrinsics.resolution, path.string());
    camera = pinhole_camera(intrinsics, std::visit([](const auto& image) { return image.resolution; }, pixels));
    first = std::make_shared<ReadAhead<DepthPixels>>(std::move(pixels));
  } catch (const ResolutionError& error) {
    throw ResolutionError(place(error));
  } catch (const InputError& error) {
    throw InputError(place(error));
  }
  camera.min_depth = options.depth_range[0];
  camera.max_depth = options.depth_range[1];
  ScanSet set{{}, camera, {}, {}};
  for (const auto& [frame, world_from_sensor] : posed_scans(folder, frames, options, set)) {
    const fs::path path = frame.path;
    const View view{world_from_sensor};
    require_pixel_choices(folder, {frame.name}, options);
    const bool is_masked = !options.masks.empty() || !options.confidence.empty() || has_mask(folder, frame.name);
    set.scans.push_back({as_utf8(frame.name), view,
                         [folder, name = frame.name, path, camera, intrinsics, view, options,
                          ahead = path == frames.front().path ? first : nullptr] {
                           std::optional<DepthPixels> pixels = ahead ? ahead->take() : std::nullopt;
                           if (!pixels) pixels = decode_depth(read_file(path), camera.resolution, path.string());
                           require_resolution(*pixels, camera.resolution, path.string());
                           const auto counts = counted_pixels(folder, {name}, options, camera.resolution);
                           return scan_of_depth(*pixels, intrinsics, counts, view, options);
                         },
                         is_masked});
  }
  return set;
}

ScanSet open_clouds(const fs::path& folder, const std::vector<Found>& files, const ScanFolderOptions& options) {
  ScanSet set;
  for (const auto& [file, world_from_sensor] : posed_scans(folder, files, options, set)) {
    const fs::path path = file.path;
    // Only a PCD file has a viewpoint of its own, and its header has to be read for it.
    Pose cloud_from_sensor =
        cloud_format(path) == CloudFormat::pcd ? read_cloud(path).cloud_from_sensor : Pose(Pose::Identity());
    cloud_from_sensor.translation() *= options.metres_per_unit();
    const View view{options.cloud_frame == "world" ? world_from_sensor : Pose(world_from_sensor * cloud_from_sensor)};
    set.scans.push_back({as_utf8(file.name), view, [path, view, options] {
                           return cropped(scan_of_cloud(read_cloud(path), view.world_from_sensor, options), view,
                                          options);
                         }});
  }
  return set;
}

/// A scan of the Stanford repository: parallel sight lines in x, meeting in one point of y and z, looking along -z.
Scan read_line_scan(const fs::path& path, const Eigen::Vector2d& origin) {
  CloudFile file = read_cloud(path);
  require(file.grid.rows > 0, path.string(),
          ": has no element 'range_grid'; it is not a scan of the Stanford repository");
  PointScan scan;
  scan.points = std::move(file.cloud.points);
  for (const Vec3& point : scan.points) scan.origins.emplace_back(point.x(), origin[0], origin[1]);
  scan.axis = -Vec3::UnitZ();
  scan.normals = organised_normals(file.grid, file.point_of_cell, scan.points, scan.origins);
  return scan;
}

/// The file of a scan that a .conf names, with or without its ending; nothing where it is not there.
std::optional<fs::path> conf_scan_file(const fs::path& folder, const std::string& name) {
  for (const char* ending : {"", ".ply"}) {
    const fs::path path = folder / (name + ending);
    if (fs::is_regular_file(path)) return path;
  }
  return std::nullopt;
}

ScanSet open_conf(const fs::path& file, const ScanFolderOptions& options) {
  ScanSet set;
  for (const ConfScan& scan : parse_conf(read_file(file), file.string())) {
    const std::optional<fs::path> path = conf_scan_file(file.parent_path(), scan.file);
    if (!path) {
      set.left_out.push_back(
          fmt::format("scan {} does not lie beside {}", in_quotes(scan.file), file.filename().string()));
      continue;
    }
    const View view{options.has_poses() ? scan.world_from_scan : Pose::Identity()};
    set.scans.push_back({as_utf8(path->stem().string()), view, [path = *path, view, options] {
                           return cropped(read_line_scan(path, options.scanner_origin), view, options);
                         }});
  }
  require(!set.scans.empty(), file.string(), ": none of the ", set.left_out.size(),
          " scans that it names lies beside it; ", set.left_out.front());
  return set;
}

ScanSet open_bag_scans(const fs::path& path, const ScanFolderOptions& options) {
  require(options.has_poses(), "poses = none: ", path.string(), " is a bag, and poses are found of folders alone");
  const BagOptions bag{.topic = options.topic,
                       .frame = options.frame,
                       .poses = options.poses,
                       .intrinsics = options.intrinsics,
                       .every = options.every};
  return scans_of(open_bag_frames(path, bag), options);
}

ScanSet open_folder(const fs::path& folder, const ScanFolderOptions& options) {
  const std::vector<Found> frames =
      options.depth.empty() ? files_ending_with(folder, frame_endings) : std::vector<Found>();
  if (!frames.empty()) return open_depth_frames(folder, frames, options);
  if (is_bag(folder)) return open_bag_scans(folder, options);
  if (auto layout = recognise_layout(folder, options)) return scans_of_layout(folder, std::move(*layout), options);
  const std::vector<Found> confs = files_ending_with(folder, conf_endings);
  require(confs.size() <= 1, folder.string(), ": has ", confs.size(), " .conf files; give the path of one");
  if (!confs.empty()) return open_conf(confs.front().path, options);
  std::vector<Found> clouds = files_ending_with(folder, cloud_endings);
  require(!clouds.empty(), folder.string(),
          ": has no scans; must have NAME.depth.png, .exr, .tif, .npy, .pfm or .raw, NAME.ply, .pcd or .xyz, a .conf "
          "file, or the layout "
          "of a "
          "data set (docs/input.md); depth images of other names are given with --depth 'PATTERN'");
  return open_clouds(folder, clouds, options);
}

/// One frame or cloud, with pose and intrinsics from its folder.
ScanSet open_file(const fs::path& path, const ScanFolderOptions& options) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const std::string file = path.filename().string();
  for (const char* ending : frame_endings) {
    if (ends_with(file, ending))
      return open_depth_frames(folder, {{file.substr(0, file.size() - std::string_view(ending).size()), path}},
                               options);
  }
  for (const char* ending : cloud_endings) {
    if (ends_with(file, ending)) return open_clouds(folder, {{path.stem().string(), path}}, options);
  }
  throw InputError(fmt::format("{}: is no scan; must be one of NAME{}, NAME{}, or a .conf file", path.string(),
                               fmt::join(frame_endings, ", NAME"), fmt::join(cloud_endings, ", NAME")));
}

}  // namespace

double ScanFolderOptions::metres_per_unit() const {
  constexpr std::array<std::pair<std::string_view, double>, 4> units{
      {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}}};
  for (const auto& [name, metres] : units) {
    if (unit == name) return metres;
  }
  throw InputError("unit = '" + unit + "': must be m, cm, mm or inch");
}

void ScanFolderOptions::validate() const {
  (void)metres_per_unit();
  require(!crop || (crop->allFinite() && (crop->tail<3>().array() > 0).all()),
          "crop: must be cx,cy,cz,sx,sy,sz with positive sizes");
  require(cloud_frame == "sensor" || cloud_frame == "world", "cloud-frame = '", cloud_frame,
          "': must be sensor or world");
  if (!confidence.empty()) (void)confidence_choice(confidence);
  DepthEncoding{.metres_per_unit = metres_per_depth_unit(), .no_return = std::nullopt}.validate();
  require(depth_range.allFinite() && depth_range[0] >= 0 && depth_range[1] > depth_range[0],
          "depth range = ", depth_range[0], ",", depth_range[1], " m: must be NEAR,FAR with 0 <= NEAR < FAR");
  require(!no_return || !unknown || unknown->value != *no_return, "unknown = ", unknown ? unknown->value : 0,
          ": is the value of no-return");
  require(!no_return || (*no_return > 0 && *no_return <= 65535), "no-return = ", no_return.value_or(0),
          ": must be within 1 and 65535");
  require(has_poses() || (hand_eye.empty() && !crop && cloud_frame == "sensor"),
          "poses = none: hand-eye, crop and cloud-frame world need poses");
  require(every >= 1, "every = ", every, ": must be at least 1");
  require(scanner_origin.allFinite(), "scanner origin: must be finite numbers");
}

void ScanFolderOptions::require_poses() const {
  require(has_poses(), "poses = none: only `vantage plan` finds poses; give poses here");
}

ScanSet open_scans(const fs::path& path, const ScanFolderOptions& options) {
  options.validate();
  try {
    require(fs::exists(path), path.string(), ": there is no such file or folder");
    if (fs::is_directory(path)) return open_folder(path, options);
    if (is_bag(path)) return open_bag_scans(path, options);
  } catch (const fs::filesystem_error& error) {
    throw InputError(fmt::format("{}: cannot be read: {}", path.string(), error.code().message()));
  }
  if (path.extension() == ".conf") return open_conf(path, options);
  return open_file(path, options);
}

}  // namespace vantage
