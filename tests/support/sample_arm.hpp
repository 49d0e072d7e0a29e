#pragma once

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "vantage/arm/arm.hpp"
#include "vantage/core/random.hpp"

/// The arm of examples/arm.urdf for tests.
namespace vantage::test {

inline ArmDescription sample_arm() {
  const std::string path = std::string(VANTAGE_EXAMPLES) + "/arm.urdf";
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return arm_from_urdf(text.str(), path, "camera_optical",
                       [](const std::string&) -> Box3 { throw std::logic_error("the sample has no mesh"); });
}

inline Eigen::VectorXd random_joints(const ArmDescription& arm, Random& random) {
  Eigen::VectorXd joints(static_cast<Eigen::Index>(arm.joints.size()));
  for (std::size_t j = 0; j < arm.joints.size(); ++j) {
    joints[static_cast<Eigen::Index>(j)] = random.uniform(arm.joints[j].lower, arm.joints[j].upper);
  }
  return joints;
}

}  // namespace vantage::test
