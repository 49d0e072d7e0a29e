#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/depth_image.hpp"
#include "vantage/map/scan.hpp"
#include "vantage/recordings/pose_source.hpp"

namespace vantage {

/// How to read a folder of scans.
struct ScanFolderOptions {
  /// Metres per unit of a depth image of whole numbers; what the data set says, else 0.001, if not given.
  std::optional<double> depth_scale = std::nullopt;
  /// Metres. Nearer is unknown, farther is "nothing up to there".
  Eigen::Vector2d depth_range{0, 4.5};
  /// Value of a depth image that says "nothing there", where the sensor knows it.
  std::optional<int> no_return = std::nullopt;
  /// Value that says "not measured", beside 0 and, of 16 bits, 65535; may be infinite.
  std::optional<PixelValue> unknown = std::nullopt;
  DepthAlong depth_along = DepthAlong::axis;
  /// Which files are the depth images, as a pattern below the scans' folder ("depth/*.png"); empty: recognised.
  std::string depth = "";
  /// Folder of pose files or trajectory, in the scans' folder or by its own path; empty: beside the scans; none: poses
  /// are not known, and every scan says that it was taken from the origin.
  std::string poses = "";
  PoseMatch match = PoseMatch::automatic;  // of the poses of a trajectory with scans
  /// File, likewise; empty: one of the usual names.
  std::string intrinsics = "";
  /// Folder of masks NAME.mask.png, likewise; empty: those that lie beside the scans.
  std::string masks = "";
  /// Folder of confidence images and the least confidence that counts, FOLDER,LEAST; empty: all pixels count.
  std::string confidence = "";
  /// y and z of the point where the sight lines of a Stanford scan meet, metres in its frame.
  Eigen::Vector2d scanner_origin{0.18, 1.3};
  /// Unit of poses, clouds and floating-point depths: m, cm, mm or inch.
  std::string unit = "m";
  /// Pose of the sensor in the frame of the robot's hand, whose poses are given then: seven numbers x,y,z,qx,qy,qz,qw
  /// or a pose file; empty: the poses are the sensor's.
  std::string hand_eye = "";
  /// World box cx cy cz sx sy sz, metres: what is measured outside says nothing.
  std::optional<Eigen::Matrix<double, 6, 1>> crop = std::nullopt;
  /// Frame of a cloud's points, sensor or world; then the pose says only where the sensor was.
  std::string cloud_frame = "sensor";
  /// Of a bag: the topic with depth images or clouds, and the frame of /tf that is the world; empty: what the bag
  /// suggests.
  std::string topic = "";
  std::string frame = "";
  /// Of a bag: takes every n-th frame.
  int every = 1;

  /// Throws InputError naming the option.
  void validate() const;
  [[nodiscard]] double metres_per_unit() const;
  [[nodiscard]] double metres_per_depth_unit() const { return depth_scale.value_or(0.001); }
  [[nodiscard]] bool has_poses() const { return poses != without_poses; }
  /// For what cannot find poses: throws InputError where they are not known.
  void require_poses() const;
  /// Whether `hand_eye` names a file, rather than being empty or numbers.
  [[nodiscard]] bool hand_eye_is_file() const { return !hand_eye.empty() && hand_eye.find(',') == std::string::npos; }
};

template <class Field>
void describe(ScanFolderOptions& o, Field&& field) {
  field("depth-scale", o.depth_scale, "m",
        "what one unit of a depth image means; what the data set says, else 0.001, if not given");
  field("depth-range", o.depth_range, "m", "nearest and farthest depth to trust; beyond is free space up to the limit");
  field("no-return", o.no_return, "", "value of a depth image that says that nothing is there");
  field("unknown", o.unknown, "",
        "value that says that nothing was measured, beside 0 (and 65535 of 16 bits); may be inf");
  field("depth-along", o.depth_along, "",
        "what depths are measured along: axis (z), or ray (distance from the sensor)");
  field("depth", o.depth, "",
        "pattern of the depth images below the folder, like depth/*.png; recognised if not given");
  field("poses", o.poses, "",
        "folder of pose files or trajectory (TUM), or none: found from the scans; beside the frames if not given");
  field("match", o.match, "",
        "how poses of a trajectory belong to frames: time (names are seconds), order, name (numbers), or auto");
  field("intrinsics", o.intrinsics, "", "file with the intrinsics; one of the usual names if not given");
  field("masks", o.masks, "",
        "folder of masks NAME.mask.png, whose black pixels are unknown; beside the frames, where there, if not given");
  field("confidence", o.confidence, "",
        "FOLDER,LEAST: images of the frames' names whose pixels below LEAST make those of the depth unknown");
  field("unit", o.unit, "", "unit of poses, clouds and floating-point depths: m, cm, mm or inch");
  field("hand-eye", o.hand_eye, "unit",
        "pose of the sensor in the robot's hand, x,y,z,qx,qy,qz,qw or a pose file; then the poses are the hand's");
  field("crop", o.crop, "m", "box cx,cy,cz,sx,sy,sz; what is measured outside of it says nothing");
  field("cloud-frame", o.cloud_frame, "", "frame of the points of clouds: sensor, or world");
  field("topic", o.topic, "", "topic of a bag with depth images or clouds; the only one if not given");
  field("frame", o.frame, "", "frame of a bag's /tf that is the world; the root of the sensor's tree if not given");
  field("every", o.every, "", "takes every n-th frame of a bag");
  field("scanner-origin", o.scanner_origin, "m", "y,z of the sight lines' origin of a line scanner (.conf)");
}

/// One scan of a set: where it was taken, as far as is believed, and how to get it.
struct ScanFile {
  std::string name;
  View view;
  std::function<Scan()> read;  // opens the file; throws InputError naming it
  bool is_masked = false;      // whether a mask or confidences take pixels away
};

struct ScanSet {
  std::vector<ScanFile> scans;        // by name, numbers by value
  std::optional<RangeCamera> camera;  // of depth images
  std::string description;            // one line: "TUM RGB-D: 613 depth images, trajectory groundtruth.txt"
  std::vector<std::string> left_out;  // what is named but cannot be used, a sentence each: "scan 'a' has no pose"
};

/// The scans of
/// - a folder with depth images `NAME.depth.png` (also .exr, .tif, .npy, .pfm, .raw), intrinsics
/// (`camera-intrinsics.txt`,
///   `camera_info.yaml`, `intrinsics.json` ...) and `NAME.pose.txt` or `NAME.pose.json` each, or a trajectory whose
///   times are the names, or as long as there are frames;
/// - a folder with clouds `NAME.ply`, `.pcd`, `.xyz`, `.xyzn` in the sensor's frame and such poses;
/// - a Stanford `.conf` with its range grids, or the folder it lies in;
/// - a bag of ROS 1 or ROS 2 (see is_bag()).
/// Poses and intrinsics are read at once, images and clouds on demand. Throws InputError naming the file and what is
/// missing.
[[nodiscard]] ScanSet open_scans(const std::filesystem::path& path, const ScanFolderOptions& options = {});

}  // namespace vantage
