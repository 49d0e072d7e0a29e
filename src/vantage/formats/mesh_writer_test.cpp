#include "vantage/formats/mesh_writer.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/mesh_file.hpp"

namespace vantage {
namespace {

/// A tetrahedron of which one face was not seen.
MeasuredMesh measured_tetrahedron() {
  MeasuredMesh measured;
  measured.mesh = {{{0, 0, 0}, {0.5, 0, 0}, {0, 0.25, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  measured.sigma = {0.001F, 0.002F, 0.003F, 0};
  measured.is_cap = {1, 0, 0, 0};
  measured.colors = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {188, 188, 188}};
  return measured;
}

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

class MeshWriterTest : public testing::Test {
 protected:
  MeshWriterTest() { std::filesystem::create_directories(folder_); }
  ~MeshWriterTest() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("mesh_writer_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(MeshWriterTest, PlyKeepsWhatWasMeasured) {
  const MeasuredMesh mesh = measured_tetrahedron();
  write_mesh(folder_ / "mesh.ply", mesh);
  const MeasuredMesh read = read_measured_mesh(folder_ / "mesh.ply");
  EXPECT_EQ(read.mesh.vertices, mesh.mesh.vertices);
  EXPECT_EQ(read.mesh.triangles, mesh.mesh.triangles);
  EXPECT_EQ(read.sigma, mesh.sigma);
  EXPECT_EQ(read.is_cap, mesh.is_cap);
  EXPECT_EQ(read.colors, mesh.colors);
}

TEST_F(MeshWriterTest, StlAndObjAreReadBackAsTheyWere) {
  const MeasuredMesh mesh = measured_tetrahedron();
  for (const char* name : {"mesh.stl", "mesh.OBJ"}) {
    write_mesh(folder_ / name, mesh);
    const TriangleMesh read = read_mesh(folder_ / name);
    ASSERT_EQ(read.triangles.size(), 4U) << name;
    double six_volumes = 0;
    for (std::size_t t = 0; t < 4; ++t)
      six_volumes += read.corner(t, 0).dot(read.corner(t, 1).cross(read.corner(t, 2)));
    EXPECT_NEAR(six_volumes, 0.5 * 0.25, 1e-12) << name;
  }
  const std::string obj = read_file(folder_ / "mesh.OBJ");
  EXPECT_NE(obj.find("v 0.5 0 0 0 1 0\n"), std::string::npos) << obj;
  EXPECT_NE(obj.find("g seen\n"), std::string::npos);
  EXPECT_NE(obj.find("g cap\nf 1 3 2\n"), std::string::npos);
}

TEST(MeshWriter, GlbIsOfTheLengthsThatItSays) {
  const std::string bytes = glb_bytes(measured_tetrahedron());
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 4), 2U);
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 8), bytes.size());
  const auto json_length = number_at<std::uint32_t>(bytes, 12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  const auto json = nlohmann::json::parse(bytes.substr(20, json_length));
  const std::size_t binary = 20 + json_length;
  EXPECT_EQ(number_at<std::uint32_t>(bytes, binary), bytes.size() - binary - 8);
  EXPECT_EQ(bytes.substr(binary + 4, 4), std::string("BIN\0", 4));
  EXPECT_EQ(json["buffers"][0]["byteLength"].get<std::size_t>(), bytes.size() - binary - 8);
  for (const auto& view : json["bufferViews"]) {
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(), bytes.size() - binary - 8);
  }
}

TEST(MeshWriter, GlbHoldsPositionsColoursAndCapsApart) {
  const std::string bytes = glb_bytes(measured_tetrahedron());
  const auto json = nlohmann::json::parse(bytes.substr(20, number_at<std::uint32_t>(bytes, 12)));
  const std::size_t data = 28 + number_at<std::uint32_t>(bytes, 12);
  const auto start_of = [&](const nlohmann::json& accessor) {
    return data + json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>();
  };
  const auto& primitives = json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2U);  // seen, cap
  const auto& position = json["accessors"][primitives[0]["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(position["count"], 4);
  EXPECT_EQ(position["max"], nlohmann::json({0.5, 0.25, 1.0}));
  EXPECT_FLOAT_EQ(number_at<float>(bytes, start_of(position) + 12), 0.5F);
  const auto& color = json["accessors"][primitives[0]["attributes"]["COLOR_0"].get<std::size_t>()];
  EXPECT_EQ(color["normalized"], true);
  EXPECT_EQ(number_at<std::uint16_t>(bytes, start_of(color)), 65535);
  // Colours are light in glTF: 188 of sRGB is half of it.
  EXPECT_NEAR(number_at<std::uint16_t>(bytes, start_of(color) + 24), 32768, 400);
  EXPECT_EQ(json["accessors"][primitives[0]["indices"].get<std::size_t>()]["count"], 9);
  EXPECT_EQ(json["accessors"][primitives[1]["indices"].get<std::size_t>()]["count"], 3);
  EXPECT_EQ(json["materials"][primitives[1]["material"].get<std::size_t>()]["name"], "cap");
}

TEST(MeshWriter, RefusesOtherEndings) {
  try {
    write_mesh("model.xyz", measured_tetrahedron());
    FAIL() << "wrote a .xyz";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "model.xyz: a mesh is written as .glb, .obj, .stl or .ply");
  }
}

}  // namespace
}  // namespace vantage
