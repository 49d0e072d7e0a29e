#include "vantage/formats/mesh_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/ply.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

// The same tetrahedron with corners (0,0,0) (1,0,0) (0,2,0) (0,0,3) in every format; its volume is 1.
const std::string obj = R"(# a tetrahedron
mtllib none.mtl
v 0 0 0
v 1 0 0
v 0 2 0 1.0
v 0 0 3
vn 0 0 1
vt 0.5 0.5
f 1 3 2   # from 1
f 1/1 2/1 4/1
f 2//1 3//1 -1//1
f 1/1/1 \
  4/1/1 3/1/1
)";
const std::string off =
    "OFF # a tetrahedron\n4 4 6\n0 0 0\n1 0 0\n\n0 2 0\n0 0 3\n3 0 2 1 255 0 0\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
const std::string ascii_ply = R"(ply
format ascii 1.0
comment a tetrahedron
element vertex 4
property float x
property float y
property float z
property uchar red
element face 4
property list uchar int vertex_indices
end_header
0 0 0 255
1 0 0 255
0 2 0 0
0 0 3 0
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
)";

std::string ascii_stl() {
  std::string text = "solid tetrahedron\n";
  const std::array<const char*, 4> corners{"0 0 0", "1 0 0", "0 2 0", "0 0 3"};
  for (const auto& [a, b, c] : {std::array<std::size_t, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
    text += std::string(" facet normal 0 0 0\n  outer loop\n   vertex ") + corners[a] + "\n   vertex " + corners[b] +
            "\n   vertex " + corners[c] + "\n  endloop\n endfacet\n";
  }
  return text + "endsolid tetrahedron\n";
}

std::string binary_stl(const TriangleMesh& mesh) {
  std::string bytes = "solid in name only";  // as some programs write it
  bytes.resize(80);
  append_int32(bytes, static_cast<std::int32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    bytes.append(12, '\0');
    for (int k = 0; k < 3; ++k) {
      for (const double coordinate : mesh.corner(t, k)) append_float32(bytes, coordinate);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

double volume(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    sum += mesh.corner(t, 0).cross(mesh.corner(t, 1)).dot(mesh.corner(t, 2)) / 6;
  }
  return sum;
}

/// Every directed edge has its counterpart exactly once.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const Index3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    if (count != 1 || back == edges.end() || back->second != 1) return false;
  }
  return true;
}

void expect_tetrahedron(const TriangleMesh& mesh) {
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_DOUBLE_EQ(volume(mesh), 1) << "the triangles face outwards";
}

std::string error_in(std::string_view bytes, MeshFormat format) {
  return input_error_of([&] { (void)parse_mesh(bytes, format, "a.mesh"); });
}

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

TEST(MeshFile, EveryFormatGivesTheSameClosedMesh) {
  expect_tetrahedron(parse_mesh(obj, MeshFormat::obj, "a.obj"));
  expect_tetrahedron(parse_mesh(off, MeshFormat::off, "a.off"));
  expect_tetrahedron(parse_mesh(ascii_ply, MeshFormat::ply, "a.ply"));
  expect_tetrahedron(parse_mesh(ascii_stl(), MeshFormat::stl, "a.stl"));
  const TriangleMesh mesh = parse_mesh(obj, MeshFormat::obj, "a.obj");
  expect_tetrahedron(parse_mesh(binary_stl(mesh), MeshFormat::stl, "a.stl"));
}

TEST(MeshFile, LineEndsOfWindowsAndTheOffHeadersSeenInTheWildAreRead) {
  std::string windows;
  for (const char c : ascii_ply) windows += c == '\n' ? "\r\n" : std::string(1, c);
  expect_tetrahedron(parse_mesh(windows, MeshFormat::ply, "a.ply"));
  expect_tetrahedron(parse_mesh(replaced(off, "OFF # a tetrahedron\n", "OFF"), MeshFormat::off, "a.off"));
  expect_tetrahedron(parse_mesh(replaced(off, "OFF", "COFF"), MeshFormat::off, "a.off"));
}

TEST(MeshFile, WhatIsWrittenIsRead) {
  const TestFolder folder;
  const TriangleMesh mesh = parse_mesh(obj, MeshFormat::obj, "a.obj");
  write_mesh_ply(folder / "mesh.PLY", mesh);
  const TriangleMesh again = read_mesh(folder / "mesh.PLY");
  EXPECT_EQ(again.vertices, mesh.vertices);
  EXPECT_EQ(again.triangles, mesh.triangles);
}

TEST(MeshFile, BigEndianPlyWithOtherTypesIsRead) {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty double x\nproperty short y\nproperty uchar z\n"
      "element face 1\nproperty list uint ushort vertex_index\nend_header\n";
  const auto append = [&](auto value) {
    std::array<char, sizeof(value)> raw{};
    std::memcpy(raw.data(), &value, sizeof(value));
    bytes.append(raw.rbegin(), raw.rend());
  };
  for (const int k : {0, 1, 2}) {
    append(k == 1 ? 1.5 : 0.0);
    append(static_cast<std::int16_t>(k == 2 ? -2 : 0));
    append(static_cast<std::uint8_t>(200));
  }
  append(std::uint32_t{3});
  for (const std::uint16_t index : std::array<std::uint16_t, 3>{0, 1, 2}) append(index);
  const TriangleMesh mesh = parse_mesh(bytes, MeshFormat::ply, "a.ply");
  EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{{0, 0, 200}, {1.5, 0, 200}, {0, -2, 200}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Index3>{{0, 1, 2}}));
}

TEST(MeshFile, PolygonsBecomeTrianglesThatCoverThem) {
  // An L of area 3 whose first corner cannot be the middle of a fan.
  const std::string l = "OFF\n6 1 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 0\n2 0 0\n6 0 1 2 3 4 5\n";
  const TriangleMesh mesh = parse_mesh(l, MeshFormat::off, "l.off");
  ASSERT_EQ(mesh.triangles.size(), 4U);
  double area = 0;
  for (std::size_t t = 0; t < 4; ++t) {
    const Vec3 twice = (mesh.corner(t, 1) - mesh.corner(t, 0)).cross(mesh.corner(t, 2) - mesh.corner(t, 0));
    EXPECT_GT(twice.z(), 0) << "no triangle is folded over";
    area += twice.z() / 2;
  }
  EXPECT_DOUBLE_EQ(area, 3);
  const TriangleMesh square =
      parse_mesh("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n4 0 0 1 1\n", MeshFormat::off, "s.off");
  EXPECT_EQ(square.triangles, (std::vector<Index3>{{0, 1, 2}, {0, 2, 3}})) << "the second face has two corners only";
}

TEST(MeshFile, APolygonThatCrossesItselfAndAHugeConcaveOneDoNotHang) {
  const TriangleMesh bow =
      parse_mesh("OFF\n4 1 0\n0 0 0\n1 1 0\n1 0 0\n0 1 0.5\n4 0 1 2 3\n", MeshFormat::off, "bow.off");
  EXPECT_EQ(bow.triangles.size(), 2U);
  std::string star = "OFF\n1000 1 0\n", face = "1000";
  for (int i = 0; i < 1000; ++i) {
    const double radius = i % 2 == 0 ? 1 : 0.5;
    star +=
        std::to_string(radius * std::cos(i * 0.00628)) + " " + std::to_string(radius * std::sin(i * 0.00628)) + " 0\n";
    face.append(" ").append(std::to_string(i));
  }
  EXPECT_THAT(error_in(star + face, MeshFormat::off),
              HasSubstr("face 0 is not convex and has 1000 corners; must be at most 100"));
}

TEST(MeshFile, BadPlyIsRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& bytes) { return error_in(bytes, MeshFormat::ply); };
  EXPECT_EQ(error(""), "a.mesh: is empty");
  EXPECT_EQ(error("not a mesh"), "a.mesh: is not a PLY file (its first line must be 'ply')");
  EXPECT_THAT(error("ply\nformat ascii 1.0\n"), HasSubstr("ends without 'end_header'"));
  EXPECT_THAT(error(replaced(ascii_ply, "ascii", "text")), HasSubstr("line 2: format 'text': must be ascii, binary"));
  EXPECT_THAT(error(replaced(ascii_ply, "format ascii 1.0\n", "")), HasSubstr("the header has no line 'format'"));
  EXPECT_THAT(error(replaced(ascii_ply, "uchar red", "colour red")), HasSubstr("line 8: 'colour' is no PLY type"));
  EXPECT_THAT(error(replaced(ascii_ply, "property float y", "property float x")),
              HasSubstr("property 'x' stands twice"));
  EXPECT_THAT(error(replaced(ascii_ply, "element vertex 4", "element vertex 4e9")),
              HasSubstr("line 4: the number of rows = '4e9': must be a whole number, not negative"));
  EXPECT_THAT(error(replaced(ascii_ply, "element vertex 4", "element vertex 4000000000")),
              HasSubstr("4000000000 rows of 'vertex' are announced, but only"));
  EXPECT_THAT(error(replaced(ascii_ply, "property float z\n", "")),
              HasSubstr("line 11: '255' is more than the header announces"));
  EXPECT_THAT(error(replaced(ascii_ply, "float z", "float w")), HasSubstr("element 'vertex' has no number 'z'"));
  EXPECT_THAT(error(replaced(ascii_ply, "0 2 0 0", "0 nan 0 0")),
              HasSubstr("vertex 2 is at (0, nan, 0): must be finite"));
  EXPECT_THAT(error(replaced(ascii_ply, "0 2 0 0", "0 two 0 0")), HasSubstr("line 14: y = 'two': must be a number"));
  EXPECT_THAT(error(replaced(ascii_ply, "3 0 3 2", "3 0 4 2")),
              HasSubstr("face 3 has the vertex 4: vertices go from 0 to 3"));
  EXPECT_THAT(error(replaced(ascii_ply, "3 0 3 2", "3 0 -1 2")), HasSubstr("face 3 has the vertex -1"));
  EXPECT_THAT(error(replaced(ascii_ply, "3 0 3 2", "3 0 1.5 2")), HasSubstr("must be a whole number"));
  EXPECT_THAT(error(replaced(ascii_ply, "3 0 3 2", "-3 0 3 2")), HasSubstr("the length -3: must not be negative"));
  EXPECT_THAT(error(replaced(ascii_ply, "3 0 3 2", "999999999 0 3 2")), HasSubstr("more than the file holds"));
  EXPECT_THAT(error(replaced(ascii_ply, "3 0 3 2\n", "")),
              HasSubstr("ends after 3 of 4 rows of 'face'; the file is cut off"));
  EXPECT_THAT(error(ascii_ply + "3 0 1 2\n"), HasSubstr("more rows than the header announces"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
                    "z\nend_header\n1 2 3\n"),
              HasSubstr("has no faces; it is a point cloud"));
  EXPECT_THAT(error(replaced(ascii_ply.substr(0, ascii_ply.find("3 0 2 1")), "face 4", "face 0")),
              HasSubstr("has no triangles"));
}

TEST(MeshFile, BadBinaryPlyIsRefused) {
  const TestFolder folder;
  write_mesh_ply(folder / "mesh.ply", parse_mesh(obj, MeshFormat::obj, "a.obj"));
  const std::string bytes = read_file(folder / "mesh.ply");
  int refused = 0;
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THAT(error_in(bytes.substr(0, length), MeshFormat::ply), HasSubstr("a.mesh"));
    ++refused;
  }
  EXPECT_EQ(refused, static_cast<int>(bytes.size())) << "cut off anywhere, it is an error";
  EXPECT_THAT(error_in(bytes.substr(0, bytes.size() - 1), MeshFormat::ply), HasSubstr("ends in row 3 of 4 of 'face'"));
  EXPECT_THAT(error_in(bytes + "x", MeshFormat::ply), HasSubstr("1 bytes more than the header announces"));
}

TEST(MeshFile, BadObjIsRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& bytes) { return error_in(bytes, MeshFormat::obj); };
  EXPECT_THAT(error("hello\nworld\n"), HasSubstr("has no line 'v x y z'; it is not an OBJ mesh"));
  EXPECT_THAT(error("v 0 0\n"), HasSubstr("line 1: z is missing"));
  EXPECT_THAT(error("v 0 0 nan\n"), HasSubstr("line 1: z = nan: must be a finite number"));
  EXPECT_THAT(error("v 0 0 inf\n"), HasSubstr("line 1: z = inf: must be a finite number"));
  EXPECT_THAT(error(replaced(obj, "f 1 3 2", "f 1 3 5")),
              HasSubstr("line 9: corner 5 of a face: vertices go from 1 to 4"));
  EXPECT_THAT(error(replaced(obj, "f 1 3 2", "f 1 3 0")), HasSubstr("corner 0 of a face"));
  EXPECT_THAT(error(replaced(obj, "f 1 3 2", "f 1 3 -5")), HasSubstr("corner -5 of a face"));
  EXPECT_THAT(error(replaced(obj, "f 1 3 2", "f 1 3 x")), HasSubstr("corner 'x' of a face: must be like 3, 3/1"));
  EXPECT_THAT(error(replaced(obj, "f 1 3 2", "f 1 3")), HasSubstr("a face with 2 corners: must be at least 3"));
  EXPECT_THAT(error("v 0 0 0\nv 1 0 0\n"), HasSubstr("has no triangles"));
}

TEST(MeshFile, BadOffIsRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& bytes) { return error_in(bytes, MeshFormat::off); };
  EXPECT_THAT(error("solid\n"), HasSubstr("is not an OFF file (its first line must be 'OFF')"));
  EXPECT_THAT(error("OFF BINARY\n"), HasSubstr("binary OFF is not supported"));
  EXPECT_THAT(error("OFF\n4\n"), HasSubstr("line 2: the number of faces is missing"));
  EXPECT_THAT(error("OFF\n99999999999 1 0\n"), HasSubstr("99999999999 vertices: must be at most"));
  EXPECT_THAT(error("OFF\n4 1 0\n0 0 0\n"), HasSubstr("ends before vertex 1; the file is cut off"));
  EXPECT_THAT(error(replaced(off, "3 0 3 2", "")), HasSubstr("ends before face 3; the file is cut off"));
  EXPECT_THAT(error(replaced(off, "3 0 3 2", "3 0 4 2")),
              HasSubstr("line 11: the face has the vertex 4: vertices go from 0 to 3"));
  EXPECT_THAT(error(replaced(off, "3 0 3 2", "300000000 0 3 2")), HasSubstr("a corner of the face is missing"));
}

TEST(MeshFile, BadStlIsRefusedWithPlaceAndReason) {
  const auto error = [](const std::string& bytes) { return error_in(bytes, MeshFormat::stl); };
  const std::string ascii = ascii_stl();
  EXPECT_THAT(error("hello"), HasSubstr("is not an STL file"));
  EXPECT_THAT(error(std::string(200, 'x')),
              HasSubstr("2021161080 triangles are announced, which take 101058054084 bytes, but the file has 200"));
  EXPECT_THAT(error(ascii.substr(0, ascii.find("endsolid"))),
              HasSubstr("ends without 'endsolid'; the file is cut off"));
  EXPECT_THAT(error(replaced(ascii, "   vertex 0 2 0\n", "")), HasSubstr("a facet with 2 vertices: must be 3"));
  EXPECT_THAT(error(replaced(ascii, "  endloop", "   vertex 0 0 0\n  endloop")), HasSubstr("a fourth one in it"));
  EXPECT_THAT(error(replaced(ascii, " endfacet", "")), HasSubstr("a facet begins before the last one has ended"));
  EXPECT_THAT(error(replaced(ascii, "vertex 0 2 0", "vertex 0 inf 0")),
              HasSubstr("line 5: y = inf: must be a finite number"));
  EXPECT_THAT(error(replaced(ascii, "outer loop", "loop")), HasSubstr("'loop' is no keyword of an STL file"));
  std::string binary = binary_stl(parse_mesh(obj, MeshFormat::obj, "a.obj"));
  EXPECT_THAT(error(binary.substr(0, binary.size() - 1)),
              HasSubstr("4 triangles are announced, which take 284 bytes, but the file has 283"));
  binary.replace(84 + 12, 4, "\xff\xff\xff\x7f");
  EXPECT_THAT(error(binary), HasSubstr("triangle 0 has a corner at (nan"));
}

double volume_of(const std::string& bytes, MeshFormat format) {
  const TriangleMesh mesh = parse_mesh(bytes, format, "a");
  double six_volumes = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    six_volumes += mesh.corner(t, 0).dot(mesh.corner(t, 1).cross(mesh.corner(t, 2)));
  return is_closed(mesh) ? six_volumes / 6 : 0;
}

TEST(MeshFile, FilesAreReadAsOtherProgramsWriteThem) {
  const std::string mark = "\xef\xbb\xbf";
  EXPECT_DOUBLE_EQ(volume_of(obj, MeshFormat::obj), 1);
  EXPECT_DOUBLE_EQ(volume_of(mark + obj.substr(obj.find("v ")), MeshFormat::obj), 1) << "the first vertex is read";
  EXPECT_DOUBLE_EQ(volume_of(mark + ascii_ply, MeshFormat::ply), 1);
  EXPECT_DOUBLE_EQ(volume_of(mark + off, MeshFormat::off), 1);
  EXPECT_DOUBLE_EQ(volume_of(mark + ascii_stl(), MeshFormat::stl), 1);
  std::string capitals = ascii_stl();
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_DOUBLE_EQ(volume_of(capitals, MeshFormat::stl), 1);
  EXPECT_DOUBLE_EQ(volume_of("v 0 0 \\\n0\nv 1 0 0\nv 0 2 \\\r\n 0\nv 0 0 3\n"
                             "f 1 3\\\n 2\nf 1 2 4\nf 2 3 \\\n4\nf 1 4 3\n",
                             MeshFormat::obj),
                   1);
}

TEST(MeshFile, StripsOfTrianglesTurnEveryOtherTime) {
  const std::string strips = ascii_ply.substr(0, ascii_ply.find("element face")) +
                             "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                             "0 0 0 255\n1 0 0 255\n0 2 0 0\n0 0 3 0\n";
  // Strips of two triangles: 1 0 2, and 2 0 3 turned; then 1 3 0 and 3 1 2.
  EXPECT_DOUBLE_EQ(volume_of(strips + "10 1 0 2 3 -1 3 0 1 -1 3\n", MeshFormat::ply), 0) << "one is missing";
  EXPECT_DOUBLE_EQ(volume_of(strips + "11 1 0 2 3 -1 3 0 1 -1 3 1\n", MeshFormat::ply), 0);
  EXPECT_DOUBLE_EQ(volume_of(strips + "12 1 0 2 3 -1 3 0 1 -1 3 1 2\n", MeshFormat::ply), 1);
  EXPECT_THAT(error_in(strips + "3 0 1 4\n", MeshFormat::ply), HasSubstr("strip 0 has the vertex 4"));
  EXPECT_THAT(error_in(strips + "3 0 1 -2\n", MeshFormat::ply), HasSubstr("strip 0 has the vertex -2"));
}

TEST(MeshFile, ALineEndAfterABinaryFileIsNoData) {
  const TestFolder folder;
  write_mesh_ply(folder / "mesh.ply", parse_mesh(obj, MeshFormat::obj, "a.obj"));
  const std::string bytes = read_file(folder / "mesh.ply");
  EXPECT_DOUBLE_EQ(volume_of(bytes + "\n", MeshFormat::ply), 1);
  EXPECT_THAT(error_in(bytes + "\nx", MeshFormat::ply), HasSubstr("2 bytes more than the header announces"));
}

TEST(MeshFile, SurfacesWithoutExtentOrOfAbsurdSizeAreRefused) {
  const auto error = [](const std::string& vertices) { return error_in(vertices + "f 1 2 3\n", MeshFormat::obj); };
  EXPECT_THAT(error("v 1 1 1\nv 1 1 1\nv 1 1 1\n"), HasSubstr("has no extent"));
  EXPECT_THAT(error("v 0 0 0\nv 1 0 0\nv 2 0 0\n"), HasSubstr("no triangle has an area"));
  EXPECT_THAT(error("v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\n"), HasSubstr("its largest side is 1e+30"));
  EXPECT_THAT(error("v 0 0 0\nv 1e-30 0 0\nv 0 1e-30 0\n"), HasSubstr("must be within 1e-09 and"));
}

TEST(MeshFile, PathsAreChecked) {
  const TestFolder folder;
  EXPECT_THAT(input_error_of([&] { (void)read_mesh(folder / "none.ply"); }), HasSubstr("none.ply: cannot be read"));
  EXPECT_THAT(input_error_of([&] { (void)read_mesh(folder / "mesh.gltf"); }),
              HasSubstr("mesh.gltf: a mesh must be a .ply, .obj, .stl or .off file"));
}

TEST(MeshFile, DamagedFilesAreReadOrRefused) {
  const TestFolder folder;
  const TriangleMesh mesh = parse_mesh(obj, MeshFormat::obj, "a.obj");
  write_mesh_ply(folder / "mesh.ply", mesh);
  const auto damage = [](const std::string& bytes, MeshFormat format) {
    const FuzzCount count = read_damaged(bytes, 3000, [&](const std::string& damaged) {
      for (const Index3& triangle : parse_mesh(damaged, format, "a").triangles) ASSERT_GE(triangle.minCoeff(), 0);
    });
    EXPECT_EQ(count.accepted + count.refused, 3000);
    EXPECT_GT(count.refused, 500);
  };
  damage(obj, MeshFormat::obj);
  damage(off, MeshFormat::off);
  damage(ascii_ply, MeshFormat::ply);
  damage(read_file(folder / "mesh.ply"), MeshFormat::ply);
  damage(ascii_stl(), MeshFormat::stl);
  damage(binary_stl(mesh), MeshFormat::stl);
}

TEST(MeshFile, TheSharedObjectsAreRead) {
  const std::filesystem::path folder = std::filesystem::path(VANTAGE_SHARED_DATA) / "objects";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " does not exist";
  struct Object {
    const char* name;
    std::size_t triangles;
    bool closed;
  };
  for (const Object& object : {Object{"mug", 3450, true}, Object{"bunny", 59664, true}, Object{"sgi_logo", 21250, true},
                               Object{"source/inventor_banana", 512, false}}) {
    const TriangleMesh mesh = read_mesh(folder / (std::string(object.name) + ".ply"));
    EXPECT_EQ(mesh.triangles.size(), object.triangles) << object.name;
    EXPECT_EQ(is_closed(mesh), object.closed) << object.name;
    const TriangleMesh from_stl = parse_mesh(binary_stl(mesh), MeshFormat::stl, "a.stl");
    EXPECT_EQ(is_closed(from_stl), object.closed) << "welded: " << object.name;
  }
}

}  // namespace
}  // namespace vantage
