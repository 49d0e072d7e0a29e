#include "vantage/doctor/pose_files.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "vantage/core/error.hpp"
#include "vantage/core/geometry.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/files/natural_order.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {
namespace {

constexpr double close = 1e-3;  // what the reader of poses lets pass as rounding

bool is_transposed(const Eigen::Matrix4d& m) {
  return m.block<3, 1>(0, 3).norm() < close && m.block<1, 3>(3, 0).norm() > close;
}

Eigen::Matrix4d upright(const Eigen::Matrix4d& m) { return is_transposed(m) ? Eigen::Matrix4d(m.transpose()) : m; }

/// The factor of a scaled rotation, mirrored or not; nothing where the axes are not perpendicular and equally long.
std::optional<double> scale_of(const Eigen::Matrix4d& m) {
  const Mat3 linear = m.topLeftCorner<3, 3>();
  const double scale = std::cbrt(std::abs(linear.determinant()));
  if (!(scale > 0) || !std::isfinite(scale)) return std::nullopt;
  const Mat3 product = linear.transpose() * linear / (scale * scale);
  return (product - Mat3::Identity()).cwiseAbs().maxCoeff() < 10 * close ? std::optional(scale) : std::nullopt;
}

/// "12 of 24 poses, the first FILE".
std::string which(const std::vector<const RawPose*>& bad, std::size_t of) {
  return concat(bad.size(), " of ", of, " poses, the first in ", bad.front()->file.filename().string());
}

}  // namespace

std::optional<Eigen::Matrix4d> parse_raw_pose(std::string_view bytes) {
  std::vector<double> numbers;
  std::string word;
  for (const char c : std::string(bytes) + " ") {
    if (c != ' ' && c != '\t' && c != '\n' && c != '\r' && c != ',') {
      word += c;
    } else if (!word.empty()) {
      numbers.push_back(to_double(word).value_or(std::nan("")));
      word.clear();
    }
  }
  if (numbers.size() != 16) return std::nullopt;
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
}

std::vector<RawPose> raw_poses(const std::filesystem::path& folder) {
  constexpr std::string_view ending = ".pose.txt";
  std::vector<RawPose> poses;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= ending.size() || !name.ends_with(ending)) continue;
    if (const auto matrix = parse_raw_pose(read_file(entry.path()))) poses.push_back({entry.path(), *matrix});
  }
  std::sort(poses.begin(), poses.end(), [](const RawPose& a, const RawPose& b) {
    return comes_before(a.file.filename().string(), b.file.filename().string());
  });
  return poses;
}

std::vector<Finding> check_rotations(const std::vector<RawPose>& poses) {
  std::vector<const RawPose*> broken, transposed, scaled, mirrored;
  double factor = 1;
  for (const RawPose& pose : poses) {
    const Eigen::Matrix4d matrix = upright(pose.matrix);
    const std::optional<double> scale = pose.matrix.allFinite() ? scale_of(matrix) : std::nullopt;
    if (!scale) {
      broken.push_back(&pose);
      continue;
    }
    if (is_transposed(pose.matrix)) transposed.push_back(&pose);
    if (std::abs(*scale - 1) > close) {
      if (scaled.empty()) factor = *scale;
      scaled.push_back(&pose);
    }
    if (matrix.topLeftCorner<3, 3>().determinant() < 0) mirrored.push_back(&pose);
  }
  std::vector<Finding> findings;
  const auto add = [&](const std::vector<const RawPose*>& bad, const std::string& wrong, const std::string& fix) {
    if (!bad.empty()) findings.push_back({"rotation", wrong, fix, which(bad, poses.size())});
  };
  add(broken, "the upper left 3x3 numbers are no rotation: columns not perpendicular, of unlike length, or not numbers",
      "write the pose as rotation and position, camera to world; check the file for lost or swapped numbers");
  add(transposed, "the matrices are transposed: the position is in the last row", "write them row by row");
  add(scaled, concat("the rotations are scaled by ", factor, ": their columns must have length 1"),
      concat("divide the upper left 3x3 numbers by ", factor, "; see whether the position is in metres"));
  add(mirrored, "the rotations are mirrored (left-handed): their determinant is -1, it must be 1",
      "see which axis points the wrong way, and negate it");
  return findings;
}

std::optional<std::vector<RawPose>> fixed(const std::vector<RawPose>& poses, int flipped) {
  std::vector<RawPose> result;
  for (const RawPose& pose : poses) {
    if (!pose.matrix.allFinite()) return std::nullopt;
    Eigen::Matrix4d matrix = upright(pose.matrix);
    const std::optional<double> scale = scale_of(matrix);
    if (!scale) return std::nullopt;
    matrix.topLeftCorner<3, 3>() /= *scale;
    if (matrix.topLeftCorner<3, 3>().determinant() < 0) {
      if (flipped < 3) {
        matrix.block<3, 1>(0, flipped) *= -1;
      } else {
        matrix.row(2) *= -1;
      }
    }
    matrix.row(3) << 0, 0, 0, 1;
    result.push_back({pose.file, matrix});
  }
  return result;
}

}  // namespace vantage
