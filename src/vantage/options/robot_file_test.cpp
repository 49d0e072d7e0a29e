#include "vantage/options/robot_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_folder.hpp"
#include "vantage/arm/arm.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/robot/free_flyer.hpp"
#include "vantage/robot/gantry.hpp"
#include "vantage/robot/turntable.hpp"

namespace vantage {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

class RobotFile : public ::testing::Test {
 protected:
  [[nodiscard]] ReconstructOptions loaded(const std::string& yaml, const std::set<std::string>& given = {}) const {
    write_file_atomically(folder_ / "robot.yaml", yaml);
    ReconstructOptions options;
    options.robot = (folder_ / "robot.yaml").string();
    load_robot(options, given);
    return options;
  }
  [[nodiscard]] std::string error_of(const std::string& yaml) const {
    return input_error_of([&] { (void)loaded(yaml); });
  }

  TestFolder folder_;
};

constexpr const char* two_joints = R"(<robot name="r"><link name="base"/><link name="middle"/><link name="camera"/>
  <joint name="a" type="continuous"><parent link="base"/><child link="middle"/><axis xyz="0 0 1"/></joint>
  <joint name="b" type="prismatic"><parent link="middle"/><child link="camera"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="2" effort="1" velocity="1"/></joint></robot>)";

TEST_F(RobotFile, MakesEachKind) {
  EXPECT_NE(dynamic_cast<const FreeFlyer*>(loaded("kind: free-flyer\nbody-radius: 0.3\n").robot_model.get()), nullptr);
  const ReconstructOptions gantry = loaded("kind: gantry\naxes: [0, 0, 0, 3, 2, 1]\ntilt: [-90, 0]\n");
  const auto* as_gantry = dynamic_cast<const Gantry*>(gantry.robot_model.get());
  ASSERT_NE(as_gantry, nullptr);
  EXPECT_EQ(as_gantry->options().axes.max(), Vec3(3, 2, 1));
  const ReconstructOptions table = loaded("kind: turntable\narc-radius: 2\nbody-radius: 0.1\n");
  const auto* as_table = dynamic_cast<const Turntable*>(table.robot_model.get());
  ASSERT_NE(as_table, nullptr);
  EXPECT_EQ(as_table->options().radius, 2);
  EXPECT_EQ(as_table->options().head_radius, 0.1) << "the program's body radius";
  EXPECT_EQ(table.travel_unit(), "m") << "the path is not asked for";
}

TEST_F(RobotFile, MakesAnArmFromAUrdfBesideIt) {
  write_file_atomically(folder_ / "two.urdf", two_joints);
  const ReconstructOptions options =
      loaded("kind: arm\nurdf: two.urdf\nhome: [90, 0.5]\nbase-position: [0, 0, 1]\ntravel: path\n");
  const auto* arm = dynamic_cast<const Arm*>(options.robot_model.get());
  ASSERT_NE(arm, nullptr);
  // A quarter turn and half a metre out.
  EXPECT_TRUE(arm->home()->view.position().isApprox(Vec3(0, 0.5, 1)));
  EXPECT_EQ(options.travel_unit(), "rad");
}

TEST_F(RobotFile, OtherKeysAreOptionsThatTheUsersOwnWinOver) {
  const std::string yaml = "kind: free-flyer\nbody-radius: 0.3\nvoxel: 0.01\ntravel: straight\n";
  const ReconstructOptions options = loaded(yaml, {"voxel"});
  EXPECT_EQ(options.body_radius, 0.3);
  EXPECT_EQ(options.travel, "straight");
  EXPECT_EQ(options.voxel, 0.02) << "given by the user, who left it as it was";
}

TEST_F(RobotFile, NotesWhatIsSet) {
  ReconstructOptions options;
  std::set<std::string> given;
  for (const OptionField& field : noting(option_fields(options), given)) {
    if (field.name == "voxel") set_option(field, "0.05", "--voxel");
  }
  EXPECT_EQ(options.voxel, 0.05);
  EXPECT_EQ(given, std::set<std::string>{"voxel"});
}

TEST_F(RobotFile, AFileThatSaysNothingIsNoRobot) {
  for (const char* text : {"", "\n", "# a robot\n", "---\n"})
    EXPECT_THAT(error_of(text), HasSubstr("robot.yaml: says nothing; must say at least `kind: free-flyer`"));
}

TEST_F(RobotFile, ErrorsNameFileAndLine) {
  EXPECT_THAT(error_of("kind: drone\n"),
              EndsWith("robot.yaml, line 1: kind = 'drone': must be one of: free-flyer, gantry, turntable, arm"));
  EXPECT_THAT(error_of("kind: gantry\npan: [10]\n"), HasSubstr("robot.yaml, line 2: pan = '10': must be 2 numbers"));
  EXPECT_THAT(error_of("kind: gantry\n\npan: [10, -10]\n"), HasSubstr("robot.yaml, line 3: pan = "));
  EXPECT_THAT(error_of("kind: gantry\ntlt: [0, 10]\n"),
              HasSubstr("line 2: unknown option 'tlt'; did you mean 'tilt'?"));
  EXPECT_THAT(error_of("kind: gantry\nurdf: a.urdf\n"), HasSubstr("line 2: unknown option 'urdf'"));
  EXPECT_THAT(error_of("kind: arm\n"), HasSubstr("urdf: must name the arm's URDF"));
  write_file_atomically(folder_ / "two.urdf", two_joints);
  EXPECT_THAT(error_of("kind: arm\nurdf: two.urdf\nhome: [1, 2, 3]\n"),
              HasSubstr("robot.yaml, line 3: home: '1,2,3' has 3 numbers; must have 2"));
  EXPECT_THAT(error_of("kind: arm\nurdf: two.urdf\nhome: [0, 3]\n"),
              HasSubstr("line 3: home: joint b at 3 is beyond its limits 0 .. 2"));
  EXPECT_THAT(error_of("kind: arm\nurdf: two.urdf\nsensor-link: lens\n"), HasSubstr("there is no link 'lens'"));
  write_file_atomically(folder_ / "broken.urdf", "<robot");
  EXPECT_THAT(error_of("kind: arm\nurdf: broken.urdf\n"), HasSubstr("broken.urdf: not a robot description"));
}

TEST_F(RobotFile, TheSampleIsRead) {
  ReconstructOptions options;
  options.robot = std::string(VANTAGE_EXAMPLES) + "/arm.yaml";
  load_robot(options);
  options.validate();
  EXPECT_EQ(options.travel, "path");
  EXPECT_EQ(dynamic_cast<const Arm&>(*options.robot_model).kinematics().joints(), 6);
}

/// The arm with a mesh at its hand, which must be read for the collisions.
std::string urdf_with_mesh(const std::string& file) {
  std::string urdf = two_joints;
  const std::string link = "<link name=\"camera\"/>";
  urdf.replace(
      urdf.find(link), link.size(),
      "<link name=\"camera\"><collision><geometry><mesh filename=\"" + file + "\"/></geometry></collision></link>");
  return urdf;
}

TEST_F(RobotFile, FindsTheMeshesOfPackages) {
  const std::string off = "OFF\n4 4 0\n0 0 0\n0.1 0 0\n0 0.1 0\n0 0 0.1\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n";
  std::filesystem::create_directories(folder_ / "share" / "meshes");
  write_file_atomically(folder_ / "share" / "meshes" / "hand.off", off);
  const std::string arm = "kind: arm\nurdf: two.urdf\n";
  const auto with_mesh = [&](const std::string& file) {
    write_file_atomically(folder_ / "two.urdf", urdf_with_mesh(file));
  };
  with_mesh("package://hand_description/meshes/hand.off");
  EXPECT_THAT(error_of(arm),
              testing::AllOf(HasSubstr("link 'camera', collision 1"), HasSubstr("--package hand_description=FOLDER")));
  EXPECT_THAT(error_of(arm + "package: other=share\n"), HasSubstr("--package hand_description=FOLDER"));
  EXPECT_THAT(error_of(arm + "package: hand_description\n"), HasSubstr("must be NAME=FOLDER"));
  EXPECT_THAT(error_of(arm + "package: a=x; a=y\n"), HasSubstr("has a folder already"));
  const ReconstructOptions options = loaded(arm + "package: other=x; hand_description = share\n");
  const auto* found = dynamic_cast<const Arm*>(options.robot_model.get());
  ASSERT_NE(found, nullptr);
  EXPECT_LT((found->kinematics().arm().bodies.at(0).shapes.at(0).size - Vec3(0.1, 0.1, 0.1)).norm(), 1e-9);
  EXPECT_TRUE(std::filesystem::path(packages_from_text(*options.package).at("hand_description")).is_absolute());
  with_mesh("file://" + (folder_ / "share" / "meshes" / "hand.off").string());
  EXPECT_NO_THROW((void)loaded(arm));
  with_mesh("share/meshes/hand.off");
  EXPECT_NO_THROW((void)loaded(arm));
  with_mesh("share/meshes/hand.DAE");
  EXPECT_THAT(error_of(arm), HasSubstr("COLLADA is not read; convert it"));
  with_mesh("http://example.org/hand.off");
  EXPECT_THAT(error_of(arm), HasSubstr("is named by a URL"));
}

TEST_F(RobotFile, NamesLinksThatMayTouch) {
  write_file_atomically(folder_ / "two.urdf", two_joints);
  const std::string arm = "kind: arm\nurdf: two.urdf\n";
  EXPECT_THAT(error_of(arm + "may-touch: base\n"), HasSubstr("must be two links, LINK LINK"));
  EXPECT_THAT(error_of(arm + "may-touch: a b c\n"), HasSubstr("must be two links, LINK LINK"));
  EXPECT_THAT(error_of(arm + "may-touch: base camera\n"), HasSubstr("there is no link 'base' with a solid"));
}

}  // namespace
}  // namespace vantage
