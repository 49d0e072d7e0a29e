#include "vantage/report/run_picture.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/map_file.hpp"
#include "vantage/formats/mesh_file.hpp"
#include "vantage/formats/point_cloud_file.hpp"
#include "vantage/report/run_scene.hpp"
#include "vantage/runs/run_files.hpp"

namespace vantage {
namespace {

using ::testing::HasSubstr;

const SceneOptions small_scene{.scene_size = Index3::Constant(21), .enclosure_size = Index3::Constant(7)};

/// A folder as a run leaves it: four occupied voxels, two scans, the second of which could not be registered.
class StoredRunTest : public ::testing::Test {
 protected:
  StoredRunTest() : model_(small_scene, 0.005) {
    for (const int x : {9, 10})
      for (const int y : {9, 10}) model_.map.add_point({x, y, 10}, Vec3(0, 0, 1), 0.5);
    const std::vector<View> views = view_sphere(20, 0.4, Vec3::Zero()).views;
    for (int k = 0; k < 2; ++k) {
      ScanRecord scan;
      scan.scan = k;
      scan.candidate = 5 * k;
      scan.commanded = scan.believed = scan.registered = views[static_cast<std::size_t>(5 * k)];
      scan.merged = k == 0;
      scan.verdict = k == 0 ? "first" : std::string(name(Verdict::not_converged));
      model_.scans.push_back(scan);
    }
  }
  void write_all() const {
    write_map(model_.map, folder_ / "map.nrrd");
    PointCloud cloud;
    cloud.add(Vec3(0, 0, 0.01), Vec3::UnitZ());
    write_cloud_ply(folder_ / "model.ply", cloud);
    write_mesh_ply(folder_ / "mesh.ply", {{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}});
    RunSummary summary;
    summary.object = "plate";
    write_file_atomically(folder_ / "summary.json", summary_json(model_, summary).dump());
    write_file_atomically(folder_ / "config.yaml", "camera: 60x40:32x24\ncandidates: sphere:20:0.4\n");
  }

  TestFolder folder_;
  ObjectModel model_;
};

TEST_F(StoredRunTest, ComesBackFromItsFolder) {
  write_all();
  const StoredRun run = read_stored_run(folder_.path());
  EXPECT_EQ(run.object, "plate");
  EXPECT_EQ(run.map->count(Label::occupied), 4);
  EXPECT_EQ(run.cloud.size(), 1U);
  EXPECT_EQ(run.mesh.triangles.size(), 1U);
  EXPECT_NEAR(degrees(run.camera.horizontal_aperture()), 60, 1e-9);
  EXPECT_EQ(run.candidates.views.size(), 20U);
  ASSERT_EQ(run.scans.size(), 2U);
  EXPECT_EQ(run.scans[1].candidate, 5);
  EXPECT_TRUE(run.scans[1].registered.world_from_sensor.isApprox(model_.scans[1].registered.world_from_sensor, 1e-12));
  EXPECT_TRUE(run.scans[0].merged);
  EXPECT_FALSE(run.scans[1].merged);
}

TEST_F(StoredRunTest, DrawsWhatIsAskedFor) {
  write_all();
  const StoredRun run = read_stored_run(folder_.path());
  std::vector<std::string> pictures;
  for (const std::string& subject : run_picture_subjects()) {
    const Picture picture = draw(run, {.show = subject, .width = 90, .height = 60});
    EXPECT_EQ(picture.width, 90);
    int drawn = 0;  // pixels unlike the corner, which is background
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) drawn += picture.at(x, y) == picture.at(0, 0) ? 0 : 1;
    EXPECT_GT(drawn, 20) << subject;
    pictures.push_back(png_bytes(picture));
  }
  std::sort(pictures.begin(), pictures.end());
  EXPECT_EQ(std::unique(pictures.begin(), pictures.end()), pictures.end()) << "two subjects look the same";
}

TEST_F(StoredRunTest, MakesDoWithTheFilesThatThereAre) {
  write_map(model_.map, folder_ / "map.nrrd");
  const StoredRun run = read_stored_run(folder_.path());
  EXPECT_EQ(run.object, folder_.path().filename().string());
  EXPECT_TRUE(run.scans.empty());
  EXPECT_EQ(draw(run, {.show = "views", .width = 30, .height = 20}).height, 20);
}

TEST_F(StoredRunTest, SaysWhatIsWrong) {
  const auto reading = [&] { return input_error_of([&] { static_cast<void>(read_stored_run(folder_.path())); }); };
  EXPECT_THAT(reading(), HasSubstr("has neither map.nrrd nor model.ply nor mesh.ply"));
  EXPECT_THAT(input_error_of([&] { static_cast<void>(read_stored_run(folder_ / "none")); }),
              HasSubstr("none: is no folder"));
  write_all();
  write_file_atomically(folder_ / "summary.json", R"({"scans": [{"commanded": [1, 2, 3]}]})");
  EXPECT_THAT(reading(), HasSubstr("summary.json, scans[0].commanded: must be 7 numbers"));
  write_file_atomically(folder_ / "summary.json", R"({"scans": [{"commanded": [0, 0, 0, 2, 0, 0, 0]}]})");
  EXPECT_THAT(reading(), HasSubstr("the quaternion has length 2, must be 1"));
  write_file_atomically(folder_ / "summary.json", R"({"scans": 3})");
  EXPECT_THAT(reading(), HasSubstr("scans: must be a list, is number"));
  write_file_atomically(folder_ / "summary.json", R"({"object": 3})");
  EXPECT_THAT(reading(), HasSubstr("object: must be text, is number"));
  write_file_atomically(folder_ / "summary.json", "{}");
  write_file_atomically(folder_ / "config.yaml", "camera: [1, 2");
  EXPECT_THAT(reading(), HasSubstr("config.yaml"));
}

TEST_F(StoredRunTest, RefusesPicturesOfWhatThereIsNot) {
  write_mesh_ply(folder_ / "mesh.ply", {{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}});
  const StoredRun run = read_stored_run(folder_.path());
  const auto drawing = [&](const RunPicture& picture) {
    return input_error_of([&] { static_cast<void>(draw(run, picture)); });
  };
  EXPECT_THAT(drawing({.show = "quality"}), HasSubstr("the run has no map.nrrd"));
  EXPECT_THAT(drawing({.show = "sound"}),
              HasSubstr("show = 'sound': must be one of views, model, quality, normals, labels"));
  EXPECT_THAT(drawing({.show = "model", .width = 0}), HasSubstr("picture size = 0x800"));
  EXPECT_THAT(drawing({.show = "model", .rise = 91}), HasSubstr("rise = 91 degrees: must be -90 to 90"));
}

TEST(SideOf, TurnsAroundUpFromTheFront) {
  EXPECT_TRUE(side_of(Vec3::UnitZ(), 0, 0).isApprox(-Vec3::UnitY()));
  EXPECT_TRUE(side_of(Vec3::UnitZ(), 90, 0).isApprox(Vec3::UnitX()));
  EXPECT_TRUE(side_of(Vec3(0, 0, 3), 17, 90).isApprox(Vec3::UnitZ()));
  EXPECT_TRUE(side_of(Vec3::UnitY(), 0, 0).isApprox(Vec3::UnitZ()));
  EXPECT_NEAR(side_of(Vec3(0, 1, 1), 33, 20).dot(Vec3(0, 1, 1).normalized()), std::sin(radians(20)), 1e-12);
}

}  // namespace
}  // namespace vantage
