#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/core/geometry.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/json_text.hpp"
#include "vantage/files/natural_order.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/camera_parts.hpp"
#include "vantage/formats/colmap_file.hpp"
#include "vantage/recordings/layout_parts.hpp"

namespace vantage::layout_parts {
namespace {

using nlohmann::json;

std::vector<double> numbers_of(const json& list, std::size_t count, const std::string& what) {
  std::vector<double> numbers;
  require(list.is_array(), what, ": must be a list of ", count, " numbers");
  for (const json& item : list) {
    if (item.is_array()) {
      for (const json& inner : item) numbers.push_back(json_number(inner, what));
    } else {
      numbers.push_back(json_number(item, what));
    }
    require(numbers.size() <= count, what, ": has more than ", count, " numbers");
  }
  require(numbers.size() == count, what, ": has ", numbers.size(), " numbers, must be ", count);
  return numbers;
}

/// A rotation (9 numbers, row by row) and a translation (mm) as a pose in metres.
Pose pose_of(const json& rotation, const json& translation, const std::string& what) {
  const std::vector<double> r = numbers_of(rotation, 9, what), t = numbers_of(translation, 3, what);
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = r[static_cast<std::size_t>(i)];
  for (int i = 0; i < 3; ++i) matrix(i, 3) = 0.001 * t[static_cast<std::size_t>(i)];
  return rigid_pose(matrix, what);
}

/// The object that is seen once in every image of scene_gt.json, least number first: its frame can be the world's.
std::optional<std::int64_t> common_object(const json& truth) {
  std::map<std::int64_t, std::size_t> images;
  for (const auto& [image, objects] : truth.items()) {
    std::map<std::int64_t, int> here;
    if (!objects.is_array()) continue;
    for (const json& object : objects) {
      if (object.is_object() && object.contains("obj_id") && object["obj_id"].is_number_integer())
        ++here[object["obj_id"].get<std::int64_t>()];
    }
    for (const auto& [id, count] : here) images[id] += count == 1 ? 1 : 0;
  }
  for (const auto& [id, count] : images) {
    if (count == truth.size()) return id;
  }
  return std::nullopt;
}

/// World from sensor by where an object is seen, for each image that sees it.
std::map<std::int64_t, Pose> poses_in_object(const json& truth, std::int64_t id, const std::string& name) {
  std::map<std::int64_t, Pose> poses;
  for (const auto& [image, objects] : truth.items()) {
    const auto number = to_integer(image);
    if (!number || !objects.is_array()) continue;
    for (const json& object : objects) {
      if (!object.is_object() || !object.contains("obj_id") || object["obj_id"] != id) continue;
      const std::string what = fmt::format("{}: image {}", name, image);
      require(object.contains("cam_R_m2c") && object.contains("cam_t_m2c"), what, ": has no cam_R_m2c and cam_t_m2c");
      poses.emplace(*number, pose_of(object["cam_R_m2c"], object["cam_t_m2c"], what).inverse());
    }
  }
  return poses;
}

struct BopScene {
  json cameras;
  std::string name;

  [[nodiscard]] const json* camera(const std::string& frame) const {
    const auto number = number_in(frame);
    if (!number) return nullptr;
    const auto found = cameras.find(std::to_string(*number));
    return found == cameras.end() || !found->is_object() ? nullptr : &*found;
  }
};

Intrinsics bop_intrinsics(const json& camera, const std::string& what) {
  require(camera.contains("cam_K"), what, ": has no cam_K");
  return camera_parts::checked(camera_parts::from_rows(numbers_of(camera["cam_K"], 9, what + ": cam_K"), what), what);
}

/// The pose of an OpenGL camera (y up, looking along -z) as one of ours.
Pose from_opengl(const json& matrix, const std::string& what) {
  const std::vector<double> n = numbers_of(matrix, matrix.size() == 3 ? 12 : 16, what);
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < n.size(); ++i) pose(static_cast<int>(i / 4), static_cast<int>(i % 4)) = n[i];
  Pose result = rigid_pose(pose, what);
  result.linear() = result.linear() * Vec3(1, -1, -1).asDiagonal();
  return result;
}

std::optional<double> number_in_json(const json& object, const char* key, const std::string& name) {
  if (!object.contains(key)) return std::nullopt;
  return json_number(object[key], name + ": " + key);
}

/// The intrinsics that transforms.json gives for all frames or for one.
std::optional<Intrinsics> nerf_intrinsics(const json& object, const fs::path& first_image, const std::string& name) {
  const auto number = [&](const char* key) { return number_in_json(object, key, name); };
  const auto width = number("w"), height = number("h"), angle = number("camera_angle_x");
  const auto fx = number("fl_x"), fy = number("fl_y");
  if (!fx && !angle) return std::nullopt;
  Intrinsics k;
  if (width && height) k.resolution = camera_parts::resolution_of(*width, *height, name);
  const Resolution size = k.resolution ? *k.resolution : read_depth_resolution(first_image);
  k.fx = fx ? *fx : 0.5 * size.columns / std::tan(0.5 * *angle);
  k.fy = fy.value_or(k.fx);
  k.cx = number("cx").value_or(0.5 * (size.columns - 1));
  k.cy = number("cy").value_or(0.5 * (size.rows - 1));
  std::vector<double> coefficients;
  for (const char* key : {"k1", "k2", "p1", "p2", "k3", "k4"}) coefficients.push_back(number(key).value_or(0));
  const bool is_fisheye = object.contains("camera_model") && object["camera_model"].is_string() &&
                          object["camera_model"].get<std::string>().find("FISHEYE") != std::string::npos;
  if (is_fisheye) {
    const std::vector<double> four{coefficients[0], coefficients[1], coefficients[4], coefficients[5]};
    camera_parts::set_distortion(k, "fisheye", four, name);
  } else {
    camera_parts::set_distortion(k, "opencv", coefficients, name);
  }
  return camera_parts::checked(k, name);
}

/// The depth image of a frame of transforms.json: as it says, or of the colour image's name in a folder of depths.
std::optional<fs::path> nerf_depth(const fs::path& folder, const json& frame) {
  for (const char* key : {"depth_file_path", "depth_path", "depth_file"}) {
    if (!frame.contains(key) || !frame[key].is_string()) continue;
    const fs::path path = folder / frame[key].get<std::string>();
    return fs::is_regular_file(path) ? std::optional(path) : std::nullopt;
  }
  if (!frame.contains("file_path") || !frame["file_path"].is_string()) return std::nullopt;
  const fs::path color = frame["file_path"].get<std::string>();
  const std::string stem = color.extension().empty() ? color.filename().string() : color.stem().string();
  for (const char* place : {"depth/", "depths/", "depth_images/"}) {
    for (const char* ending : {".png", ".exr", ".tif", ".tiff", ".npy", ".pfm"}) {
      if (fs::is_regular_file(folder / (place + stem + ending))) return folder / (place + stem + ending);
    }
  }
  const fs::path beside = folder / (color.parent_path() / (stem + "_depth.png"));
  return fs::is_regular_file(beside) ? std::optional(beside) : std::nullopt;
}

}  // namespace

std::optional<FolderLayout> bop(const fs::path& folder, const ScanFolderOptions&) {
  if (!fs::exists(folder / "scene_camera.json")) return std::nullopt;
  const fs::path file = folder / "scene_camera.json";
  const BopScene scene{parse_json(read_file(file), file.string()), file.string()};
  require(scene.cameras.is_object(), file.string(), ": must be an object with an entry per image");
  FolderLayout layout;
  layout.kind = "BOP";
  std::map<std::int64_t, Pose> by_object;
  const bool has_world = std::any_of(scene.cameras.begin(), scene.cameras.end(), [](const json& camera) {
    return camera.is_object() && camera.contains("cam_R_w2c") && camera.contains("cam_t_w2c");
  });
  if (has_world) {
    layout.poses = "poses of scene_camera.json";
  } else {
    const fs::path truth_file = folder / "scene_gt.json";
    require(fs::exists(truth_file), folder.string(),
            ": has no poses; must have scene_gt.json, or cam_R_w2c in scene_camera.json");
    const json truth = parse_json(read_file(truth_file), truth_file.string());
    require(truth.is_object() && !truth.empty(), truth_file.string(), ": must be an object with an entry per image");
    const auto id = common_object(truth);
    require(id.has_value(), truth_file.string(),
            ": no object is seen exactly once in every image, so none can be the world");
    by_object = poses_in_object(truth, *id, truth_file.string());
    layout.poses = fmt::format("poses of scene_gt.json in the frame of object {}", *id);
  }
  for (LayoutFrame& frame : frames_of(depth_images_in(folder / "depth"))) {
    const json* camera = scene.camera(frame.name);
    const auto number = number_in(frame.name);
    if (camera == nullptr) {
      layout.left_out.push_back(fmt::format("frame {} has no entry in scene_camera.json", in_quotes(frame.name)));
      continue;
    }
    const std::string what = fmt::format("{}: image {}", file.string(), *number);
    frame.intrinsics = bop_intrinsics(*camera, what);
    const double scale =
        camera->contains("depth_scale") ? json_number((*camera)["depth_scale"], what + ": depth_scale") : 1;
    require(!layout.metres_per_unit || *layout.metres_per_unit == 0.001 * scale, what, ": depth_scale = ", scale,
            ": must be the same for all images");
    layout.metres_per_unit = 0.001 * scale;
    if (has_world && camera->contains("cam_R_w2c") && camera->contains("cam_t_w2c")) {
      frame.world_from_sensor = pose_of((*camera)["cam_R_w2c"], (*camera)["cam_t_w2c"], what).inverse();
    } else if (const auto found = by_object.find(*number); found != by_object.end()) {
      frame.world_from_sensor = found->second;
    } else {
      layout.left_out.push_back(fmt::format("frame {} has no pose", in_quotes(frame.name)));
      continue;
    }
    layout.frames.push_back(std::move(frame));
  }
  require(!layout.frames.empty(), folder.string(), ": has no image in depth/ with an entry in scene_camera.json");
  return layout;
}

std::optional<FolderLayout> nerf(const fs::path& folder, const ScanFolderOptions&) {
  const fs::path file = folder / "transforms.json";
  if (!fs::exists(file)) return std::nullopt;
  const json object = parse_json(read_file(file), file.string());
  require(object.is_object() && object.contains("frames") && object["frames"].is_array(), file.string(),
          ": has no list 'frames'");
  FolderLayout layout;
  layout.kind = "NeRF transforms.json";
  layout.poses = "OpenGL axes turned";
  for (const char* key : {"integer_depth_scale", "depth_unit_scale_factor"}) {
    if (const auto scale = number_in_json(object, key, file.string())) layout.metres_per_unit = *scale;
  }
  std::size_t number = 0;
  for (const json& entry : object["frames"]) {
    const std::string what = fmt::format("{}: frame {}", file.string(), number++);
    require(entry.is_object() && entry.contains("transform_matrix"), what, ": has no 'transform_matrix'");
    const auto depth = nerf_depth(folder, entry);
    if (!depth) {
      layout.left_out.push_back(
          fmt::format("frame {} has no depth image (depth_file_path, or depth/NAME.png)", number - 1));
      continue;
    }
    LayoutFrame frame = std::move(frames_of({*depth}).front());
    frame.world_from_sensor = from_opengl(entry["transform_matrix"], what);
    if (entry.contains("fl_x")) frame.intrinsics = nerf_intrinsics(entry, *depth, what);
    layout.frames.push_back(std::move(frame));
  }
  require(!layout.frames.empty(), file.string(), ": none of its ", number, " frames has a depth image");
  layout.intrinsics = nerf_intrinsics(object, layout.frames.front().depth, file.string());
  return layout;
}

std::optional<FolderLayout> colmap(const fs::path& folder, const ScanFolderOptions& options) {
  const auto images_file =
      first_file(folder, {"images.txt", "sparse/images.txt", "sparse/0/images.txt", "colmap/sparse/0/images.txt"});
  if (!images_file || !fs::exists(images_file->parent_path() / "cameras.txt")) return std::nullopt;
  const fs::path cameras_file = images_file->parent_path() / "cameras.txt";
  std::map<std::int64_t, Intrinsics> cameras;
  for (const ColmapCamera& camera : parse_colmap_cameras(read_file(cameras_file), cameras_file.string()))
    cameras.emplace(camera.id, camera.intrinsics);
  std::vector<fs::path> depths;
  if (!options.depth.empty()) depths = files_matching(folder, options.depth);
  for (const char* place : {"depth", "depths", "depth_images"}) {
    if (depths.empty()) depths = depth_images_in(folder / place);
  }
  require(!depths.empty(), folder.string(),
          ": is a COLMAP model without depth images; must have them in depth/, or give --depth 'PATTERN'");
  std::map<std::string, fs::path> by_name;
  for (const fs::path& depth : depths) {
    by_name.emplace(depth.filename().string(), depth);
    by_name.emplace(depth.stem().string(), depth);
  }
  FolderLayout layout;
  layout.kind = "COLMAP";
  layout.poses = "poses of images.txt";
  for (const ColmapImage& image : parse_colmap_images(read_file(*images_file), images_file->string())) {
    const fs::path name = fs::path(image.name).filename();
    auto found = by_name.find(name.string());
    if (found == by_name.end()) found = by_name.find(name.stem().string());
    const auto camera = cameras.find(image.camera);
    require(camera != cameras.end(), images_file->string(), ": image ", in_quotes(image.name), " has the camera ",
            image.camera, ", which is not in ", cameras_file.string());
    if (found == by_name.end()) {
      layout.left_out.push_back(fmt::format("image {} has no depth image", in_quotes(image.name)));
      continue;
    }
    layout.frames.push_back({.name = name.stem().string(),
                             .depth = found->second,
                             .time_s = std::nullopt,
                             .world_from_sensor = image.world_from_sensor,
                             .intrinsics = camera->second});
  }
  require(!layout.frames.empty(), images_file->string(), ": none of its images has a depth image");
  std::sort(layout.frames.begin(), layout.frames.end(),
            [](const LayoutFrame& a, const LayoutFrame& b) { return comes_before(a.name, b.name); });
  return layout;
}

}  // namespace vantage::layout_parts
