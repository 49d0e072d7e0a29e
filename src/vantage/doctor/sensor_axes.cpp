#include <algorithm>
#include <array>

#include "vantage/core/error.hpp"
#include "vantage/doctor/hypothesis.hpp"

namespace vantage {
namespace {

struct Named {
  Mat3 given_from_optical;  // columns: where x right, y down, z forward lie in the axes that the poses are for
  const char* name;
};

Mat3 columns(const Vec3& right, const Vec3& down, const Vec3& forward) {
  Mat3 matrix;
  matrix << right, down, forward;
  return matrix;
}

std::string axes_text(const Mat3& given_from_optical) {
  const std::array<const char*, 3> directions{"right", "down", "forward"};
  const std::array<const char*, 3> opposites{"left", "up", "backward"};
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    int column = 0;
    given_from_optical.row(axis).cwiseAbs().maxCoeff(&column);
    const bool positive = given_from_optical(axis, column) > 0;
    const auto place = static_cast<std::size_t>(column);
    text += concat(axis == 0 ? "" : ", ", "xyz"[axis], " ", positive ? directions[place] : opposites[place]);
  }
  return text;
}

std::string rows_text(const Mat3& m) {
  std::string text = "[";
  for (int row = 0; row < 3; ++row) {
    text += concat(row == 0 ? "" : "; ", m(row, 0) + 0.0, " ", m(row, 1) + 0.0, " ", m(row, 2) + 0.0);
  }
  return text + "]";
}

enum class Which { usual, unusual };

std::vector<Hypothesis> with_axes(const Reading& base, Which which) {
  const std::array<Named, 2> known{
      Named{columns(Vec3::UnitX(), -Vec3::UnitY(), -Vec3::UnitZ()), " (as OpenGL and Blender have them)"},
      Named{columns(-Vec3::UnitY(), -Vec3::UnitZ(), Vec3::UnitX()), " (body axes, as ROS has them)"}};
  std::vector<Hypothesis> hypotheses;
  std::array<int, 3> order{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 turn = Mat3::Zero();
      for (int axis = 0; axis < 3; ++axis) {
        turn(order[static_cast<std::size_t>(axis)], axis) = (signs >> axis & 1) != 0 ? -1 : 1;
      }
      if (turn.determinant() < 0 || turn.isIdentity()) continue;
      std::string name;
      for (const Named& one : known) name += one.given_from_optical == turn ? one.name : "";
      if (name.empty() == (which == Which::usual)) continue;
      Hypothesis each{"sensor-axes", {}, {}, base};
      for (Pose& pose : each.reading.world_from_sensor) pose.linear() = pose.linear() * turn;
      each.wrong = concat("the poses are for a camera with ", axes_text(turn), name,
                          "; they must be for the optical axes x right, y down, z forward");
      each.fix = concat("multiply every rotation from the right by ", rows_text(turn));
      hypotheses.push_back(std::move(each));
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return hypotheses;
}

}  // namespace

std::vector<Hypothesis> usual_axes(const Reading& base) { return with_axes(base, Which::usual); }
std::vector<Hypothesis> unusual_axes(const Reading& base) { return with_axes(base, Which::unusual); }

std::vector<Hypothesis> inverted_poses_of_usual_axes(const Reading& base) {
  std::vector<Hypothesis> all;
  for (const Hypothesis& inverted : inverted_poses(base)) {
    for (Hypothesis& each : with_axes(inverted.reading, Which::usual)) {
      each.check = inverted.check;
      each.wrong = inverted.wrong + "; and " + each.wrong;
      each.fix = inverted.fix + ", then " + each.fix;
      all.push_back(std::move(each));
    }
  }
  return all;
}

}  // namespace vantage
