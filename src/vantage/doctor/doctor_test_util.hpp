#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "vantage/core/geometry.hpp"
#include "vantage/core/random.hpp"
#include "vantage/doctor/doctor.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/camera_file.hpp"
#include "vantage/formats/depth_image.hpp"

// For tests: a set of depth frames that a mistake can be made in before it is written to a folder of its own.
namespace vantage::test {

struct FrameOnDisk {
  std::string name;
  Eigen::Matrix4d pose;  // as it will be written, good or bad
};

struct SetOnDisk {
  std::filesystem::path images;  // where NAME.depth.png lie
  Mat3 intrinsics;
  std::vector<FrameOnDisk> frames;
  /// Changes the pixels of each frame, where it is given; else the images are linked.
  std::function<Gray16(Gray16)> pixels;

  void write(const std::filesystem::path& folder) const {
    std::filesystem::create_directories(folder);
    write_file_atomically(folder / "camera-intrinsics.txt", text(intrinsics));
    for (const FrameOnDisk& frame : frames) {
      write_file_atomically(folder / (frame.name + ".pose.txt"), text(frame.pose));
      const std::filesystem::path image = images / (frame.name + ".depth.png");
      const std::filesystem::path target = folder / image.filename();
      if (pixels) {
        write_file_atomically(target, encode_png16(pixels(decode_png16(read_file(image), image.string()))));
      } else {
        std::filesystem::create_symlink(image, target);
      }
    }
  }

  /// A copy with every pose changed.
  [[nodiscard]] SetOnDisk with_poses(const std::function<Eigen::Matrix4d(const Eigen::Matrix4d&)>& change) const {
    SetOnDisk copy = *this;
    for (FrameOnDisk& frame : copy.frames) frame.pose = change(frame.pose);
    return copy;
  }

  template <class Matrix>
  static std::string text(const Matrix& matrix) {
    const Eigen::IOFormat rows(Eigen::FullPrecision, Eigen::DontAlignCols, " ", "\n");
    std::ostringstream stream;
    stream << matrix.format(rows) << "\n";
    return stream.str();
  }
};

/// The frames of a folder with their poses (in `poses`, below it or the folder itself where empty).
[[nodiscard]] inline SetOnDisk read_set(const std::filesystem::path& folder, const std::string& poses) {
  SetOnDisk set;
  set.images = folder;
  const Intrinsics k = read_intrinsics(folder / "camera-intrinsics.txt");
  set.intrinsics << k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1;
  ScanFolderOptions options;
  options.poses = poses;
  for (const ScanFile& file : open_scans(folder, options).scans) {
    set.frames.push_back({file.name, file.view.world_from_sensor.matrix()});
  }
  return set;
}

[[nodiscard]] inline Eigen::Matrix4d turn(const Mat3& rotation) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = rotation;
  return matrix;
}

/// A mistake, made in a good set, and the check that has to find it.
struct Mistake {
  std::string check;
  std::string fix;  // has to be part of what the doctor says to do
  SetOnDisk set;
  DoctorOptions options;
};

/// Every mistake that the doctor knows, made in the set, which `options` read.
[[nodiscard]] inline std::vector<Mistake> all_mistakes(const SetOnDisk& good, const DoctorOptions& options) {
  using Matrix = Eigen::Matrix4d;
  std::vector<Mistake> all;
  const auto add = [&](const char* check, const char* fix, SetOnDisk set) {
    all.push_back({check, fix, std::move(set), options});
    return &all.back().options;
  };
  const double scale = options.folder.metres_per_depth_unit();
  add("depth-unit", "--depth-scale", good)->folder.depth_scale = 10 * scale;
  add("depth-unit", "--depth-scale", good)->folder.depth_scale = scale / 1000;
  add("pose-direction", "invert", good.with_poses([](const Matrix& m) -> Matrix { return m.inverse(); }));
  Mat3 optical_from_body, optical_from_gl;
  optical_from_body << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  optical_from_gl << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  add("sensor-axes", "from the right by [0 0 1; -1 0 0; 0 -1 0]",
      good.with_poses([&](const Matrix& m) -> Matrix { return m * turn(optical_from_body); }));
  add("sensor-axes", "from the right by [1 0 0; 0 -1 0; 0 0 -1]",
      good.with_poses([&](const Matrix& m) -> Matrix { return m * turn(optical_from_gl); }));
  add("rotation", "divide", good.with_poses([](const Matrix& m) {
    Matrix scaled = m;
    scaled.topLeftCorner<3, 3>() *= 1.25;
    return scaled;
  }));
  add("rotation", "second column",
      good.with_poses([](const Matrix& m) -> Matrix { return m * turn(Vec3(1, -1, 1).asDiagonal().toDenseMatrix()); }));
  add("rotation", "negate the y row", good.with_poses([](const Matrix& m) -> Matrix {
    const Matrix mirror = turn(Vec3(1, -1, 1).asDiagonal().toDenseMatrix());
    return mirror * m * mirror;
  }));
  add("rotation", "row by row", good.with_poses([](const Matrix& m) -> Matrix { return m.transpose(); }));
  Eigen::Matrix<double, 6, 1> box;
  box << 40, 50, 60, 0.3, 0.3, 0.3;
  add("box", "--box=", good)->box = box;
  SetOnDisk late = good;
  for (std::size_t i = 0; i < late.frames.size(); ++i) {
    late.frames[i].pose = good.frames[(i + 1) % good.frames.size()].pose;
  }
  add("time", "1 frame", late);
  SetOnDisk small = good;
  small.intrinsics.topRows<2>() *= 0.5;
  add("intrinsics", "by 2", small);
  Random random(7);
  SetOnDisk wild = good;
  for (FrameOnDisk& frame : wild.frames) {
    frame.pose.block<3, 1>(0, 3) += 0.2 * random.unit_vector();
    const Mat3 tilt = Eigen::AngleAxisd(radians(8), random.unit_vector()).toRotationMatrix();
    frame.pose.topLeftCorner<3, 3>() = (tilt * frame.pose.topLeftCorner<3, 3>()).eval();
  }
  add("pose-errors", "", wild);
  SetOnDisk astray = good;
  astray.frames[4].pose.block<3, 1>(0, 3) += 0.3 * random.unit_vector();
  add("pose-errors", good.frames[4].name.c_str(), astray);
  SetOnDisk along = good;  // a table or wall that runs that way shares as much of itself as before
  along.frames[4].pose(0, 3) += 0.3;
  add("pose-errors", good.frames[4].name.c_str(), along);
  return all;
}

}  // namespace vantage::test
