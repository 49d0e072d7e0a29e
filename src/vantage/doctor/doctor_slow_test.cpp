#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_folder.hpp"
#include "vantage/doctor/doctor.hpp"
#include "vantage/doctor/doctor_test_util.hpp"
#include "vantage/doctor/pose_errors.hpp"

namespace vantage {
namespace {

struct RealSet {
  const char* folder;
  const char* poses;
  double depth_scale;
  double empty_from;  // metres: where an empty room would begin, behind most of what is near
  int found_alone;    // of four shifts of every frame alone, how many are found at least
};

class DoctorOnRealFrames : public testing::TestWithParam<RealSet> {};

TEST_P(DoctorOnRealFrames, PassesTheUntouchedSetAndFindsEveryMistakeMadeInIt) {
  const RealSet& real = GetParam();
  const std::filesystem::path folder = std::filesystem::path(VANTAGE_SHARED_DATA) / "scans" / real.folder;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  DoctorOptions options;
  options.folder.depth_scale = real.depth_scale;
  DoctorOptions as_it_lies = options;
  as_it_lies.folder.poses = real.poses;
  for (const Finding& finding : examine(folder, as_it_lies, [](const std::string&) {}).findings) {
    ADD_FAILURE() << "untouched: " << finding.check << ": " << finding.wrong << " (" << finding.evidence << ")";
  }
  const test::SetOnDisk good = test::read_set(folder, real.poses);
  std::vector<test::Mistake> mistakes = test::all_mistakes(good, options);
  // A sensor in an empty room: nothing but what is near gives an answer, the rest is unknown.
  test::SetOnDisk empty_room = good;
  const double near_units = real.empty_from / real.depth_scale;
  empty_room.pixels = [near_units](Gray16 image) {
    for (std::uint16_t& value : image.values) value = value > near_units ? 0 : value;
    return image;
  };
  mistakes.push_back({"no-return", "--no-return", empty_room, options});
  for (const test::Mistake& mistake : mistakes) {
    SCOPED_TRACE(mistake.check + " " + mistake.fix);
    const TestFolder copy;
    mistake.set.write(copy / "set");
    const Diagnosis diagnosis = examine(copy / "set", mistake.options, [](const std::string&) {});
    EXPECT_THAT(diagnosis.findings,
                testing::Contains(testing::AllOf(testing::Field(&Finding::check, mistake.check),
                                                 testing::Field(&Finding::fix, testing::HasSubstr(mistake.fix)))));
  }
  EXPECT_EQ(mistakes.size(), 16U);
}

TEST_P(DoctorOnRealFrames, FindsAFrameThatIsOffAlone) {
  const RealSet& real = GetParam();
  const std::filesystem::path folder = std::filesystem::path(VANTAGE_SHARED_DATA) / "scans" / real.folder;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  ScanFolderOptions reading;
  reading.depth_scale = real.depth_scale;
  reading.depth_range = {0, 1e6};
  reading.no_return = 65535;
  reading.poses = real.poses;
  Evidence evidence = gather(open_scans(folder, reading), 4.5, reading, [](std::size_t, std::size_t) {});
  int found = 0, others = 0, cases = 0;
  for (FrameEvidence& frame : evidence.frames) {
    const Pose truth = frame.world_from_sensor;
    for (const Vec3& shift : {Vec3(0.3, 0, 0), Vec3(-0.3, 0, 0), Vec3(0, 0.3, 0), Vec3(0, -0.3, 0)}) {
      frame.world_from_sensor = Eigen::Translation3d(shift) * truth;
      for (const Finding& finding : check_pose_errors(evidence, as_given(evidence), 0.05)) {
        const bool names_it = finding.fix.find(frame.name) != std::string::npos;
        ++(names_it ? found : others);
      }
      ++cases;
    }
    frame.world_from_sensor = truth;
  }
  std::cout << real.folder << ": found " << found << " of " << cases << ", " << others << " other findings\n";
  EXPECT_GE(found, real.found_alone);
  EXPECT_EQ(others, 0);
}

INSTANTIATE_TEST_SUITE_P(Sets, DoctorOnRealFrames,
                         testing::Values(RealSet{"ur5_tray", "", 0.001, 0.6, 90},
                                         RealSet{"apc_shelf", "pose_robot", 0.0001, 0.45, 55}),
                         [](const auto& set) { return std::string(set.param.folder); });

}  // namespace
}  // namespace vantage
