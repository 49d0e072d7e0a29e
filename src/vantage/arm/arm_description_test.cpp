#include "vantage/arm/arm_description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/sample_arm.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

Box3 no_mesh(const std::string&) { return {}; }

std::string error_of(const std::string& urdf, const std::string& sensor = "tool") {
  try {
    (void)arm_from_urdf(urdf, "a.urdf", sensor, no_mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// A root, a joint as given, and a tool.
std::string urdf_with(const std::string& joint, const std::string& tool = "") {
  return "<robot name='r'><link name='root'/><link name='tool'>" + tool + "</link><joint name='j' type='" + joint +
         "<parent link='root'/><child link='tool'/></joint></robot>";
}

TEST(ArmDescription, ReadsTheSample) {
  const ArmDescription arm = test::sample_arm();
  ASSERT_EQ(arm.joints.size(), 6U);
  EXPECT_EQ(arm.joints[2].name, "elbow");
  EXPECT_EQ(arm.joints[2].axis, Vec3::UnitY());
  EXPECT_EQ(arm.joints[2].upper, 2.9);
  EXPECT_TRUE(arm.joints[1].previous_from_joint.translation().isApprox(Vec3(0, 0.14, 0)));
  ASSERT_EQ(arm.bodies.size(), 8U) << "the optical frame has no solid";
  EXPECT_EQ(arm.bodies[2].link, "upper_arm");
  EXPECT_EQ(arm.bodies[2].shapes.size(), 3U);
  EXPECT_EQ(arm.bodies.back().joint, 5);
  EXPECT_EQ(arm.joined.size(), 7U);
  // The lens looks along the flange's y axis.
  EXPECT_TRUE(arm.last_from_sensor.linear().col(2).isApprox(Vec3::UnitY()));
  EXPECT_TRUE(arm.last_from_sensor.translation().isApprox(Vec3(0, 0.11, 0)));
}

TEST(ArmDescription, TakesTheBoxAroundAMesh) {
  const std::string tool =
      "<collision><origin xyz='1 0 0'/><geometry><mesh filename='m.stl' scale='0.001 0.001 "
      "0.001'/></geometry></collision>";
  const ArmDescription arm =
      arm_from_urdf(urdf_with("continuous'><axis xyz='0 0 2'/>", tool), "a.urdf", "tool", [](const std::string& file) {
        EXPECT_EQ(file, "m.stl");
        return Box3(Vec3(0, 0, 0), Vec3(100, 200, 300));
      });
  ASSERT_EQ(arm.bodies.size(), 1U);
  EXPECT_TRUE(arm.bodies[0].shapes[0].size.isApprox(Vec3(0.1, 0.2, 0.3)));
  EXPECT_TRUE(arm.bodies[0].shapes[0].joint_from_shape.translation().isApprox(Vec3(1.05, 0.1, 0.15)));
  EXPECT_EQ(arm.joints[0].axis, Vec3::UnitZ());
}

TEST(ArmDescription, SaysWhatIsWrong) {
  const std::string good =
      urdf_with("revolute'><axis xyz='0 0 1'/><limit lower='-1' upper='1' effort='1' velocity='1'/>");
  EXPECT_EQ(error_of(good), "no error");
  EXPECT_THAT(error_of(""), HasSubstr("a.urdf: not a robot description"));
  EXPECT_THAT(error_of("<robot"), HasSubstr("a.urdf: not a robot description"));
  EXPECT_THAT(error_of("{}"), HasSubstr("a.urdf: not a robot description"));
  EXPECT_EQ(error_of(good, "hand"), "a.urdf: there is no link 'hand' to carry the sensor; the links are root, tool");
  EXPECT_EQ(error_of(urdf_with("fixed'>")), "a.urdf: no joint between the root link 'root' and 'tool' can move");
  EXPECT_EQ(error_of(urdf_with("floating'>")),
            "a.urdf: joint 'j': is neither fixed nor revolute, continuous or prismatic");
  EXPECT_THAT(error_of(urdf_with("revolute'><axis xyz='0 0 1'/><limit lower='1' upper='-1' effort='1' velocity='1'/>")),
              HasSubstr("joint 'j': its limits 1 .. -1 are not in ascending order"));
  EXPECT_THAT(error_of(urdf_with("continuous'><axis xyz='0 0 0'/>")),
              HasSubstr("joint 'j': its axis has no direction"));
  EXPECT_THAT(error_of(urdf_with("continuous'><axis xyz='0 0 1'/>",
                                 "<collision><geometry><sphere radius='-1'/></geometry></collision>")),
              HasSubstr("link 'tool'"));
}

/// An arm whose tool has these elements.
std::string error_with(const std::string& tool) { return error_of(urdf_with("continuous'><axis xyz='0 0 1'/>", tool)); }

std::string collision_of(const std::string& geometry) { return "<collision>" + geometry + "</collision>"; }

TEST(ArmDescription, ReadsEverySolidOrRefusesIt) {
  const std::string box = "<geometry><box size='1 2 3'/></geometry>";
  for (const std::string& good :
       {collision_of(box), collision_of("<origin xyz='1 0 0' rpy='0 0 1'/>" + box) + collision_of(box),
        "<visual><geometry><capsule radius='1' length='1'/></geometry></visual>" + collision_of(box),
        "<visual><geometry><box sise='1'/></geometry></visual><visual/>" + collision_of(box),
        "<inertial><mass value='1'/></inertial><contact><lateral_friction value='1'/></contact>" + collision_of(box),
        collision_of("<geometry><sphere radius='+1e-1'/></geometry>"), std::string()})
    EXPECT_EQ(error_with(good), "no error") << good;
  int cases = 0;
  for (const auto& [solid, text] :
       {std::pair<std::string, const char*>{collision_of("<geometry><capsule radius='1' length='1'/></geometry>"),
                                            "<capsule> is no shape that can be avoided"},
        {collision_of("<geometry><box sise='1 2 3'/></geometry>"), "<box> has the unknown attribute 'sise'"},
        {collision_of("<geometry><box/></geometry>"), "<box> has no attribute 'size'"},
        {collision_of("<geometry><box size='1 2'/></geometry>"), "size = '1 2': must be 3 numbers"},
        {collision_of("<geometry><box size='1 2 3 4'/></geometry>"), "must be 3 numbers"},
        {collision_of("<geometry><box size='1 2 x'/></geometry>"), "must be 3 numbers"},
        {collision_of("<geometry><box size='1 2 nan'/></geometry>"), "must be 3 numbers"},
        {collision_of("<geometry><box size='1,2,3'/></geometry>"), "must be 3 numbers"},
        {collision_of("<geometry><sphere radius='1' length='1'/></geometry>"), "unknown attribute 'length'"},
        {collision_of("<geometry><cylinder radius='1'/></geometry>"), "<cylinder> has no attribute 'length'"},
        {collision_of("<geometry><mesh file='a.stl'/></geometry>"), "unknown attribute 'file'"},
        {collision_of("<geometry><Box size='1 2 3'/></geometry>"), "<Box> is no shape"},
        {collision_of("<geometry></geometry>"), "<geometry> is empty"},
        {collision_of("<geometry><box size='1 2 3'/><sphere radius='1'/></geometry>"), "more than one shape"},
        {collision_of(""), "has no <geometry>"},
        {collision_of("<box size='1 2 3'/>"), "unknown part <box>"},
        {collision_of("<geometri><box size='1 2 3'/></geometri>"), "unknown part <geometri>"},
        {collision_of("<origin xzy='1 0 0'/>" + box), "<origin> has the unknown attribute 'xzy'"},
        {collision_of("<origin xyz='1 0'/>" + box), "xyz = '1 0': must be 3 numbers"},
        {collision_of("<origin xyz='1 0 0'/><origin xyz='2 0 0'/>" + box), "more than one <origin>"},
        {collision_of(box + box), "more than one <geometry>"},
        {"<colision>" + box + "</colision>", "has a solid in the unknown element <colision>"},
        {"<collision_checking><capsule radius='1' length='1'/></collision_checking>", "<collision_checking>"}}) {
    const std::string error = error_with(solid);
    EXPECT_THAT(error, testing::StartsWith("a.urdf: link 'tool'")) << solid;
    EXPECT_THAT(error, HasSubstr(text)) << solid;
    ++cases;
  }
  EXPECT_EQ(cases, 23);
  EXPECT_THAT(error_with(collision_of(box) + collision_of("")), HasSubstr("link 'tool', collision 2: "));
  EXPECT_THAT(error_of("<robot name='r'><link name='root'/><collision>" + box + "</collision></robot>"),
              HasSubstr("outside of any link"));
}

TEST(ArmDescription, ThePlaceOfAMeshThatCannotBeRead) {
  try {
    (void)arm_from_urdf(
        urdf_with("continuous'><axis xyz='0 0 1'/>", collision_of("<geometry><mesh filename='m.stl'/></geometry>")),
        "a.urdf", "tool", [](const std::string&) -> Box3 { throw InputError("m.stl: is cut off"); });
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "a.urdf: link 'tool', collision 1: m.stl: is cut off");
  }
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(ArmDescription, RefusesJointsInACircle) {
  const auto joint = [](const std::string& name, const std::string& parent, const std::string& child) {
    return concat("<joint name='", name, "' type='continuous'><axis xyz='0 0 1'/><parent link='", parent,
                  "'/><child link='", child, "'/></joint>");
  };
  EXPECT_EQ(error_of("<robot name='r'><link name='root'/><link name='a'/><link name='b'/><link name='tool'/>" +
                     joint("1", "b", "a") + joint("2", "a", "b") + joint("3", "b", "tool") + "</robot>"),
            "a.urdf: the joints above link 'a' go round in a circle");
  EXPECT_EQ(error_of("<robot name='r'><link name='root'/><link name='a'/><link name='tool'/>" +
                     joint("1", "root", "a") + joint("2", "a", "tool") + joint("3", "tool", "a") + "</robot>"),
            "a.urdf: two joints have the child link 'a'");
}

// The parser of URDF hands bad values to printf() as a format.
TEST(ArmDescription, RefusesFormatsInValues) {
  EXPECT_THAT(error_of(urdf_with("continuous'><origin xyz='0 0 %n%n%s'/><axis xyz='0 0 1'/>")),
              HasSubstr("an element has the sign %"));
  EXPECT_EQ(error_of("<!-- 100 % --> " + urdf_with("continuous'><axis xyz='0 0 1'/>")), "no error");
}

// The XML parser compares each attribute with all others.
TEST(ArmDescription, RefusesWhatTakesLongToRead) {
  std::string attributes;
  for (int i = 0; i < 60000; ++i) attributes += concat(" a", i, "='1'");
  EXPECT_THAT(error_of("<robot name='r'" + attributes + "/>"), HasSubstr("an element with more than 100 attributes"));
  EXPECT_THAT(error_of("<robot>" + std::string(std::size_t{5} << 20U, ' ') + "</robot>"), HasSubstr("at most 4194304"));
}

// The XML parser calls itself once per level, and would run out of stack.
TEST(ArmDescription, RefusesWhatIsNestedTooDeeply) {
  for (const int levels : {250, 1'000'000}) {
    EXPECT_THAT(error_of("<robot name='r'>" + repeated("<a b='/>'>", levels)), HasSubstr("nested deeper than 200"));
    EXPECT_THAT(error_of(repeated("<!-- </a> --><a><![CDATA[</a>]]>", levels)), HasSubstr("nested deeper than 200"));
  }
  EXPECT_THAT(error_of("<robot name='r'>" + repeated("<a/><b></b><!-- <a> -->", 1000) + "</robot>"), HasSubstr("link"))
      << "many elements side by side are fine; these are no links";
  EXPECT_THAT(error_of(std::string("<robot name='r'>\0</robot>", 26)), HasSubstr("has a byte 0"));
  std::string chain = "<robot name='r'><link name='l0'/>";
  for (int i = 1; i <= 1000; ++i) {
    chain +=
        concat("<link name='l", i, "'/><joint name='j", i, "' type='continuous'><axis xyz='0 0 1'/><parent link='l",
               i - 1, "'/><child link='l", i, "'/></joint>");
  }
  EXPECT_EQ(error_of(chain + "</robot>", "l1000"), "a.urdf: has more than 999 joints");
}

}  // namespace
}  // namespace vantage
