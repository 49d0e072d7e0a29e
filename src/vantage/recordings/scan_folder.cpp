#include "vantage/recordings/scan_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/natural_order.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/conf_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/recordings/bag_frames.hpp"
#include "vantage/recordings/frame_scans.hpp"
#include "vantage/recordings/pose_source.hpp"
#include "vantage/recordings/scan_bytes.hpp"
#include "vantage/sensor/organised_normals.hpp"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::array frame_endings{".depth.png", ".depth.exr", ".depth.raw"};
constexpr const char* mask_ending = ".mask.png";
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

std::vector<std::string> names_of(const std::vector<Found>& files) {
  std::vector<std::string> names;
  for (const Found& file : files) names.push_back(file.name);
  return names;
}

fs::path intrinsics_file(const fs::path& folder, const ScanFolderOptions& options) {
  if (!options.intrinsics.empty()) return below(folder, options.intrinsics);
  constexpr std::array<const char*, 7> usual{"camera-intrinsics.txt",
                                             "camera-intrinsics.yaml",
                                             "camera-intrinsics.json",
                                             "camera_info.yaml",
                                             "intrinsics.txt",
                                             "intrinsics.json",
                                             "camera.json"};
  for (const char* name : usual) {
    if (fs::exists(folder / name)) return folder / name;
  }
  throw InputError(fmt::format("{}: has no intrinsics; must have one of {}, or give a file with --intrinsics",
                               folder.string(), fmt::join(usual, ", ")));
}

Resolution image_resolution(const Found& frame, const Intrinsics& intrinsics) {
  if (frame.path.extension() != ".raw") return read_depth_resolution(frame.path);
  require(intrinsics.resolution.has_value(), frame.path.string(),
          ": the size of a raw image is not known; the intrinsics must have it (a .yaml or .json file)");
  return *intrinsics.resolution;
}

/// The mask of a frame; nothing where it has none and needs none.
std::optional<fs::path> mask_file(const fs::path& folder, const std::string& name, const ScanFolderOptions& options) {
  fs::path mask = (options.masks.empty() ? folder : below(folder, options.masks)) / (name + mask_ending);
  if (fs::exists(mask)) return mask;
  require(options.masks.empty(), mask.string(), ": there is no such file; with --masks each frame must have one");
  return std::nullopt;
}

std::vector<Pose> sensor_poses(const fs::path& folder, const std::vector<Found>& scans,
                               const ScanFolderOptions& options) {
  std::vector<Pose> poses = poses_of_scans(folder, options.poses, names_of(scans));
  const Pose hand_eye = hand_eye_offset(options);
  for (Pose& pose : poses) pose = sensor_pose(pose, hand_eye, options);
  return poses;
}

Mask read_mask(const fs::path& path, Resolution resolution) {
  return decode_png_mask(read_file(path), resolution, path.string());
}

ScanSet open_depth_frames(const fs::path& folder, const std::vector<Found>& frames, const ScanFolderOptions& options) {
  const fs::path file = intrinsics_file(folder, options);
  const Intrinsics intrinsics = read_intrinsics(file);
  RangeCamera camera;
  try {
    camera = pinhole_camera(intrinsics, image_resolution(frames.front(), intrinsics));
  } catch (const InputError& error) {
    throw InputError(
        fmt::format("{} with {}: {}", file.string(), frames.front().path.filename().string(), error.what()));
  }
  camera.min_depth = options.depth_range[0];
  camera.max_depth = options.depth_range[1];
  const DepthEncoding encoding = depth_encoding(options);
  const std::vector<Pose> poses = sensor_poses(folder, frames, options);
  ScanSet set;
  set.camera = camera;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const fs::path path = frames[i].path;
    const View view{poses[i]};
    const std::optional<fs::path> mask = mask_file(folder, frames[i].name, options);
    set.scans.push_back({frames[i].name, view, [path, mask, camera, encoding, intrinsics, view, options] {
                           RangeImage image = read_depth_image(path, camera, encoding);
                           if (mask) image = masked(std::move(image), read_mask(*mask, camera.resolution));
                           return cropped(scan_of(undistorted(std::move(image), intrinsics)), view, options);
                         }});
  }
  return set;
}

ScanSet open_clouds(const fs::path& folder, const std::vector<Found>& files, const ScanFolderOptions& options) {
  const std::vector<Pose> poses = sensor_poses(folder, files, options);
  ScanSet set;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const fs::path path = files[i].path;
    // Only a PCD file has a viewpoint of its own, and its header has to be read for it.
    Pose cloud_from_sensor =
        cloud_format(path) == CloudFormat::pcd ? read_cloud(path).cloud_from_sensor : Pose(Pose::Identity());
    cloud_from_sensor.translation() *= options.metres_per_unit();
    const View view{options.cloud_frame == "world" ? poses[i] : Pose(poses[i] * cloud_from_sensor)};
    set.scans.push_back({files[i].name, view, [path, view, options] {
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

ScanSet open_conf(const fs::path& file, const ScanFolderOptions& options) {
  ScanSet set;
  for (const ConfScan& scan : parse_conf(read_file(file), file.string())) {
    const fs::path path = file.parent_path() / scan.file;
    require(fs::exists(path), file.string(), ": names the scan ", in_quotes(scan.file),
            ", which does not lie beside it");
    const View view{scan.world_from_scan};
    set.scans.push_back({path.stem().string(), view, [path, view, options] {
                           return cropped(read_line_scan(path, options.scanner_origin), view, options);
                         }});
  }
  return set;
}

ScanSet open_bag_scans(const fs::path& path, const ScanFolderOptions& options) {
  const BagOptions bag{.topic = options.topic,
                       .frame = options.frame,
                       .poses = options.poses,
                       .intrinsics = options.intrinsics,
                       .every = options.every};
  return scans_of(open_bag_frames(path, bag), options);
}

ScanSet open_folder(const fs::path& folder, const ScanFolderOptions& options) {
  const std::vector<Found> frames = files_ending_with(folder, frame_endings);
  if (!frames.empty()) return open_depth_frames(folder, frames, options);
  if (is_bag(folder)) return open_bag_scans(folder, options);
  const std::vector<Found> confs = files_ending_with(folder, conf_endings);
  require(confs.size() <= 1, folder.string(), ": has ", confs.size(), " .conf files; give the path of one");
  if (!confs.empty()) return open_conf(confs.front().path, options);
  std::vector<Found> clouds = files_ending_with(folder, cloud_endings);
  require(!clouds.empty(), folder.string(),
          ": has no scans; must have NAME.depth.png, .exr or .raw, NAME.ply, .pcd or .xyz, or a .conf file");
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
  DepthEncoding{.metres_per_unit = depth_scale, .no_return = std::nullopt}.validate();
  require(depth_range.allFinite() && depth_range[0] >= 0 && depth_range[1] > depth_range[0],
          "depth range = ", depth_range[0], ",", depth_range[1], " m: must be NEAR,FAR with 0 <= NEAR < FAR");
  require(!no_return || (*no_return > 0 && *no_return <= 65535), "no-return = ", no_return.value_or(0),
          ": must be within 1 and 65535");
  require(every >= 1, "every = ", every, ": must be at least 1");
  require(scanner_origin.allFinite(), "scanner origin: must be finite numbers");
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
