#include "vantage/runs/run_files.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

namespace vantage {
namespace {

ScanRecord record(int scan) {
  ScanRecord result;
  result.scan = scan;
  result.candidate = 7;
  result.commanded = result.believed = result.registered = view_towards(Vec3(0.1, 0.2, 2), Vec3::Zero());
  result.reason = "because of \"this\", and that";
  result.distance = 0.1 + 0.2;
  result.coverage = 1.0 / 3;
  Evaluation planned;
  planned.seen.occplane = 12;
  planned.utility = 0.7;
  if (scan > 0) result.planned = planned;
  return result;
}

std::size_t fields(const std::string& row) {
  std::size_t count = 1;
  bool in_quotes = false;
  for (const char c : row) {
    if (c == '"') in_quotes = !in_quotes;
    if (c == ',' && !in_quotes) ++count;
  }
  return count;
}

TEST(RunFiles, RowsOfViewsHaveTheColumnsOfTheirHeader) {
  std::istringstream csv(views_csv({record(0), record(1)}));
  std::string header;
  std::string first;
  std::string second;
  std::getline(csv, header);
  std::getline(csv, first);
  std::getline(csv, second);
  EXPECT_EQ(
      header,
      "scan,candidate,commanded_x,commanded_y,commanded_z,commanded_qx,commanded_qy,commanded_qz,commanded_qw,"
      "believed_x,believed_y,believed_z,believed_qx,believed_qy,believed_qz,believed_qw,registered_x,registered_y,"
      "registered_z,registered_qx,registered_qy,registered_qz,registered_qw,n_oc,n_op,n_um,f_area,f_navigation,"
      "f_quality,f_occlusion,utility,occupied,occplane,unmarked,new_occupied,mean_quality,distance,coverage,"
      "coverage_all,overlap,residual,verdict,reason,expected_utility,overlap_probability,learned_sigma,learned_angle,"
      "merged,merged_after,true_pose_x,true_pose_y,true_pose_z,true_pose_qx,true_pose_qy,true_pose_qz,true_pose_qw,"
      "pose_error,register_probability,expected_misplacement,flying_pixels,taken_back");
  EXPECT_EQ(fields(first), fields(header));
  EXPECT_EQ(fields(second), fields(header));
  EXPECT_NE(second.find("\"because of \"\"this\"\", and that\""), std::string::npos);
}

TEST(RunFiles, NumbersComeBackAsTheyWere) {
  const auto json = nlohmann::json::parse(scan_json(record(1)).dump());
  EXPECT_EQ(json.at("distance").get<double>(), 0.1 + 0.2);
  EXPECT_EQ(json.at("coverage").get<double>(), 1.0 / 3);
  EXPECT_EQ(json.at("n_op").get<int>(), 12);
  EXPECT_TRUE(scan_json(record(0)).at("n_op").is_null()) << "nothing planned the first scan";
}

TEST(RunFiles, TellWhatWasExpectedAndLearnedInMetresAndDegrees) {
  ScanRecord scan = record(1);
  EXPECT_TRUE(scan_json(scan).at("expected_utility").is_null());
  EXPECT_TRUE(scan_json(scan).at("learned_sigma").is_null());
  scan.planned->expected = Expectation{0.5, 0.75, 32};
  scan.learned_error = PoseError::from_deviations({0.1, 0.1, 0.2}, {0, 0, radians(3)});
  scan.learned_error->mean[3] = radians(2);
  const auto json = scan_json(scan);
  EXPECT_EQ(json.at("expected_utility").get<double>(), 0.5);
  EXPECT_EQ(json.at("overlap_probability").get<double>(), 0.75);
  EXPECT_NEAR(json.at("learned_sigma").get<double>(), std::sqrt(0.02), 1e-12);
  EXPECT_NEAR(json.at("learned_angle").get<double>(), std::sqrt(3), 1e-12);

  SceneOptions scene;
  scene.scene_size = scene.enclosure_size = Index3::Constant(5);
  ObjectModel model(scene, 0.01);
  EXPECT_TRUE(summary_json(model, {}).at("learned_error").is_null());
  model.scans.push_back(scan);
  const auto learned = summary_json(model, {}).at("learned_error");
  EXPECT_NEAR(learned.at("mean").at(3).get<double>(), 2, 1e-12);
  EXPECT_NEAR(learned.at("covariance").at(2).at(2).get<double>(), 0.04, 1e-12);
  EXPECT_NEAR(learned.at("covariance").at(5).at(5).get<double>(), 9, 1e-12);
}

TEST(RunFiles, WriteTheTruthWhereItIsKnown) {
  ScanRecord scan = record(1);
  EXPECT_TRUE(scan_json(scan).at("true_pose").is_null());
  EXPECT_TRUE(scan_json(scan).at("pose_error").is_null());
  EXPECT_TRUE(scan_json(scan).at("merged").get<bool>());
  scan.true_view = view_towards(Vec3(0.1, 0.2, 2.1), Vec3::Zero());
  scan.pose_error = 0.015;
  scan.merged = false;
  const auto json = scan_json(scan);
  EXPECT_EQ(json.at("true_pose").at(2).get<double>(), 2.1);
  EXPECT_EQ(json.at("pose_error").get<double>(), 0.015);
  EXPECT_FALSE(json.at("merged").get<bool>());
  EXPECT_TRUE(json.at("merged_after").is_null());
  scan.merged_after = 4;
  EXPECT_EQ(scan_json(scan).at("merged_after").get<int>(), 4);
  EXPECT_NE(views_csv({scan}).find(",false,4,0.1,0.2,2.1,"), std::string::npos);
}

TEST(RunFiles, PosesAreWrittenAsQuaternions) {
  const View view = view_towards(Vec3(1, 2, -3), Vec3(0.5, 0, 0));
  const std::array<double, 7> n = pose_numbers(view.world_from_sensor);
  const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
  EXPECT_GE(n[6], 0);
  EXPECT_TRUE(q.toRotationMatrix().isApprox(view.world_from_sensor.linear(), 1e-12));
  EXPECT_EQ(n[2], -3);
}

}  // namespace
}  // namespace vantage
