#include "vantage/doctor/doctor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_folder.hpp"
#include "vantage/doctor/doctor_test_util.hpp"
#include "vantage/simulation/mesh_tools.hpp"
#include "vantage/simulation/objects.hpp"
#include "vantage/simulation/range_scanner.hpp"

namespace vantage {
namespace {

using test::SetOnDisk;

void add_object(TriangleMesh& scene, const std::string& name, double size, const Vec3& place) {
  const TriangleMesh object = centred_and_scaled(make_object(name), size);
  const auto first = static_cast<int>(scene.vertices.size());
  for (const Vec3& vertex : object.vertices) scene.vertices.push_back(vertex + place);
  for (const Index3& triangle : object.triangles) scene.triangles.push_back(triangle + Index3::Constant(first));
}

/// Frames of things on no table, so that most pixels meet nothing, from a ring of views.
SetOnDisk simulated_set(const std::filesystem::path& folder) {
  TriangleMesh scene;
  add_object(scene, "sgi_logo", 0.5, {0.25, 0, 0.1});
  add_object(scene, "mug", 0.35, {-0.3, 0.1, 0});
  add_object(scene, "banana", 0.4, {0, -0.35, -0.1});
  const RangeScanner scanner(scene);
  const RangeCamera camera = camera_from_intrinsics(260, 260, 159.5, 119.5, {320, 240});
  SetOnDisk set;
  set.images = folder;
  set.intrinsics << 260, 0, 159.5, 0, 260, 119.5, 0, 0, 1;
  for (int i = 0; i < 18; ++i) {
    const double azimuth = radians(20.0 * i), height = 0.5 + 0.25 * std::sin(radians(50.0 * i));
    const Vec3 position(1.3 * std::cos(azimuth), 1.3 * std::sin(azimuth), height);
    const View view = view_towards(position, {0.02 * i, 0, 0});
    const std::string name = concat("frame-", 100 + i);
    write_depth_png(folder / (name + ".depth.png"), scanner.scan(camera, view));
    set.frames.push_back({name, view.world_from_sensor.matrix()});
  }
  return set;
}

Diagnosis diagnose(const SetOnDisk& set, const DoctorOptions& options) {
  const TestFolder folder;
  set.write(folder / "set");
  return examine(folder / "set", options, [](const std::string&) {});
}

TEST(Doctor, PassesAGoodSetAndFindsEveryMistakeMadeInIt) {
  const TestFolder images;
  const SetOnDisk good = simulated_set(images.path());
  DoctorOptions options;
  options.folder.no_return = 65535;
  const Diagnosis healthy = diagnose(good, options);
  for (const Finding& finding : healthy.findings) ADD_FAILURE() << finding.check << ": " << finding.wrong;
  EXPECT_EQ(healthy.frames, 18U);
  int found = 0;
  for (const test::Mistake& mistake : test::all_mistakes(good, options)) {
    SCOPED_TRACE(mistake.check + " " + mistake.fix);
    const Diagnosis diagnosis = diagnose(mistake.set, mistake.options);
    EXPECT_THAT(diagnosis.findings,
                testing::Contains(testing::AllOf(testing::Field(&Finding::check, mistake.check),
                                                 testing::Field(&Finding::fix, testing::HasSubstr(mistake.fix)))));
    ++found;
  }
  EXPECT_EQ(found, 15);
}

TEST(Doctor, FindsASensorThatNeverReportsNoReturn) {
  const TestFolder images;
  SetOnDisk set = simulated_set(images.path());
  set.pixels = [](Gray16 image) {
    for (std::uint16_t& value : image.values) value = value == 65535 ? 0 : value;
    return image;
  };
  const Diagnosis diagnosis = diagnose(set, {});
  ASSERT_EQ(diagnosis.findings.size(), 1U);
  EXPECT_EQ(diagnosis.findings[0].check, "no-return");
  EXPECT_TRUE(diagnosis.healthy()) << "good to know, but nothing is wrong";
}

TEST(Doctor, TellsHowABoxWasMeant) {
  const TestFolder images;
  const SetOnDisk set = simulated_set(images.path());
  DoctorOptions millimetres;
  millimetres.folder.no_return = 65535;
  millimetres.box.emplace();
  *millimetres.box << 100, 0, 2000, 900, 900, 3900;
  DoctorOptions corners = millimetres;
  corners.box.emplace();
  *corners.box << -0.6, -0.6, -3, 0.6, 0.6, 0.4;  // taken for center and size it lies below everything
  const Diagnosis first = diagnose(set, millimetres), second = diagnose(set, corners);
  ASSERT_EQ(first.findings.size(), 1U);
  EXPECT_EQ(first.findings[0].fix, "the numbers look like millimetres; give metres: --box=0.1,0,2,0.9,0.9,3.9");
  ASSERT_EQ(second.findings.size(), 1U);
  EXPECT_EQ(second.findings[0].fix,
            "the numbers look like two corners; give center and sizes: --box=0,0,-1.3,1.2,1.2,3.4");
}

TEST(Doctor, RefusesWhatItCannotReadAtAll) {
  const TestFolder folder;
  EXPECT_THROW((void)examine(folder / "none", {}, [](const std::string&) {}), InputError);
  DoctorOptions options;
  options.pose_error = -1;
  EXPECT_THROW((void)examine(folder.path(), options, [](const std::string&) {}), InputError);
}

}  // namespace
}  // namespace vantage
