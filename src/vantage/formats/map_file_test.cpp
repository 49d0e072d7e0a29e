#include "vantage/formats/map_file.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "support/test_folder.hpp"
#include "vantage/files/atomic_file.hpp"
#include "vantage/formats/nrrd.hpp"

namespace vantage {
namespace {

using testing::HasSubstr;

/// A map of unequal sides with all labels in random places and random surfaces.
VoxelMap random_map(std::uint64_t seed) {
  Random random(seed);
  const Grid grid{{-0.31, 0.7, -2.05}, 0.02, {9, 8, 7}};
  VoxelMap map(grid, {{2, 1, 0}, {7, 5, 6}});
  for (int z = 0; z <= 6; ++z) {
    for (int y = 1; y <= 5; ++y) {
      for (int x = 2; x <= 7; ++x) {
        const auto label = all_labels[static_cast<std::size_t>(random.index(5))];
        map.set_label({x, y, z}, label);
        if (label == Label::occupied && random.index(4) > 0)
          map.add_point({x, y, z}, random.unit_vector(), random.uniform());
      }
    }
  }
  return map;
}

void expect_same(const VoxelMap& a, const VoxelMap& b) {
  EXPECT_EQ(a.grid().min, b.grid().min) << "to the last bit";
  EXPECT_EQ(a.grid().length, b.grid().length);
  EXPECT_EQ(a.grid().size, b.grid().size);
  EXPECT_EQ(a.enclosure().min, b.enclosure().min);
  EXPECT_EQ(a.enclosure().max, b.enclosure().max);
  int surfaces = 0;
  for (int z = 0; z < a.grid().size.z(); ++z) {
    for (int y = 0; y < a.grid().size.y(); ++y) {
      for (int x = 0; x < a.grid().size.x(); ++x) {
        ASSERT_EQ(a.label({x, y, z}), b.label({x, y, z}));
        if (const SurfaceVoxel* surface = a.surface({x, y, z})) {
          EXPECT_TRUE(surface->normal().isApprox(b.surface({x, y, z})->normal(), 1e-6));
          EXPECT_FLOAT_EQ(static_cast<float>(surface->quality), static_cast<float>(b.surface({x, y, z})->quality));
          ++surfaces;
        }
      }
    }
  }
  EXPECT_EQ(surfaces, a.count(Label::occupied));
}

struct Files {
  std::string labels, surface;
};

Files files_of(const VoxelMap& map) {
  const TestFolder folder;
  write_map(map, folder / "a.nrrd");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.nrrd", "a.ply"}));
  return {read_file(folder / "a.nrrd"), read_file(folder / "a.ply")};
}

VoxelMap parse(const Files& files) { return parse_map({"a.nrrd", files.labels}, NamedBytes{"a.ply", files.surface}); }

std::string replaced(std::string text, std::string_view what, std::string_view with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

TEST(MapFile, WhatIsWrittenIsRead) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const VoxelMap map = random_map(seed);
    ASSERT_GT(map.count(Label::occupied), 20);
    const TestFolder folder;
    write_map(map, folder / "a.nrrd");
    expect_same(map, read_map(folder / "a.nrrd"));
  }
}

TEST(MapFile, AnEmptySceneTakesNoRoom) {
  const TestFolder folder;
  const Grid grid{{-0.31, 0.7, -2.05}, 0.02, {16384, 16384, 1000}};
  VoxelMap map(grid, {{9000, 8000, 300}, {9003, 8004, 305}});
  Random random(3);
  int occupied = 0;
  for (int z = 300; z <= 305; ++z) {
    for (int y = 8000; y <= 8004; ++y) {
      for (int x = 9000; x <= 9003; ++x)
        map.set_label({x, y, z}, all_labels[static_cast<std::size_t>(random.index(5))]);
    }
  }
  write_map(map, folder / "a.nrrd");
  EXPECT_LT(std::filesystem::file_size(folder / "a.nrrd"), 1000U);
  std::string labels = read_file(folder / "a.nrrd");
  EXPECT_THAT(labels, HasSubstr("\nsizes: 4 5 6\n"));
  EXPECT_THAT(labels, HasSubstr("\nenclosure:=0 0 0 3 4 5\n"));
  const std::string surface = read_file(folder / "a.ply");
  const VoxelMap read = parse_map({"a.nrrd", labels}, NamedBytes{"a.ply", surface});
  EXPECT_EQ(read.grid().min, grid.min) << "to the last bit";
  EXPECT_EQ(read.grid().size, grid.size);
  EXPECT_EQ(read.enclosure().min, map.enclosure().min);
  EXPECT_EQ(read.enclosure().max, map.enclosure().max);
  for (int z = 300; z <= 305; ++z) {
    for (int y = 8000; y <= 8004; ++y) {
      for (int x = 9000; x <= 9003; ++x) {
        ASSERT_EQ(read.label({x, y, z}), map.label({x, y, z}));
        occupied += map.label({x, y, z}) == Label::occupied ? 1 : 0;
      }
    }
  }
  EXPECT_GT(occupied, 5);
  const std::string scene = "scene:=16384 16384 1000 9000 8000 300";
  labels.replace(labels.find(scene), scene.size(), "scene:=16384 16384 305 9000 8000 300 ");
  EXPECT_THAT(input_error_of([&] {
                (void)parse_map({"a.nrrd", labels}, std::nullopt);
              }),
              HasSubstr("the key 'scene' says that there are"));
}

TEST(MapFile, GridsSurviveToTheLastBit) {
  Random random(7);
  int exact = 0;
  for (int i = 0; i < 1000; ++i) {
    const Grid grid{{random.uniform(-3, -0.1), random.uniform(-3, -0.1), random.uniform(-3, -0.1)},
                    random.uniform(0.001, 0.05),
                    {1, 1, 1}};
    const std::string bytes = nrrd_header(grid, grid.all()) + std::string(1, '\0');
    const Nrrd nrrd = parse_nrrd(bytes, "a.nrrd");
    EXPECT_EQ(nrrd.grid.length, grid.length);
    for (int axis = 0; axis < 3; ++axis) {
      // Where half a voxel falls exactly between two doubles, no origin may lead back.
      const auto leads_back = [&](double origin) { return origin - 0.5 * grid.length == grid.min[axis]; };
      double origin = grid.min[axis] + 0.5 * grid.length - 1e-15;
      bool possible = false;
      for (; origin < grid.min[axis] + 0.5 * grid.length + 1e-15; origin = std::nextafter(origin, 1)) {
        possible = possible || leads_back(origin);
      }
      EXPECT_EQ(nrrd.grid.min[axis] == grid.min[axis], possible);
      EXPECT_NEAR(nrrd.grid.min[axis], grid.min[axis], 1e-15);
      exact += possible ? 1 : 0;
    }
  }
  EXPECT_GT(exact, 2900);
  for (const int side : {85, 138, 205, 405}) {  // the paper's scenes
    const Grid grid = SceneOptions{.voxel_length = 4.1 / side, .scene_size = Index3::Constant(side)}.grid();
    const std::string header = nrrd_header(grid, grid.all());
    const std::string bytes = header + std::string(static_cast<std::size_t>(side * side * side), '\0');
    EXPECT_EQ(parse_nrrd(bytes, "a.nrrd").grid.min, grid.min) << side;
  }
}

TEST(MapFile, HasTheLayoutOfTheSpecification) {
  VoxelMap map({{-2.05, -2.05, -2.05}, 0.02, {4, 3, 2}}, {{1, 0, 0}, {2, 2, 1}});
  map.set_label({1, 0, 0}, Label::occluded);
  map.add_point({2, 0, 0}, {0, 0, 1}, 0.75);
  map.set_label({1, 1, 0}, Label::empty);
  map.set_label({2, 2, 1}, Label::occplane);
  const Files files = files_of(map);
  const std::size_t end = files.labels.find("\n\n");
  ASSERT_NE(end, std::string::npos);
  const std::string header = files.labels.substr(0, end + 1);
  EXPECT_EQ(header.substr(0, 9), "NRRD0005\n");
  for (const char* line : {"\ntype: uint8\n", "\ndimension: 3\n", "\nspace dimension: 3\n", "\nsizes: 4 3 2\n",
                           "\nencoding: raw\n", "\nspace directions: (0.02,0,0) (0,0.02,0) (0,0,0.02)\n",
                           "\nspace origin: (-2.04,-2.04,-2.04)\n", "\nenclosure:=1 0 0 2 2 1\n"}) {
    EXPECT_THAT(header, HasSubstr(line));
  }
  EXPECT_EQ(files.labels.substr(end + 2), std::string("\2\3\1\2"
                                                      "\2\2\0\2"
                                                      "\2\0\0\2"
                                                      "\2\0\0\2"
                                                      "\2\0\0\2"
                                                      "\2\0\4\2",
                                                      24));
  EXPECT_THAT(
      files.surface,
      HasSubstr("element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                "property float nx\nproperty float ny\nproperty float nz\nproperty float quality\nend_header\n"));
  std::array<float, 7> row{};
  std::memcpy(row.data(), files.surface.data() + files.surface.size() - 28, 28);
  EXPECT_THAT(row, testing::ElementsAre(-2.0F, -2.04F, -2.04F, 0, 0, 1, 0.75F));
}

TEST(MapFile, WithoutTheKeyTheWholeSceneIsTheEnclosure) {
  Files files = files_of(random_map(1));
  files.labels = replaced(files.labels, "enclosure:=2 1 0 7 5 6\n", "");
  const VoxelMap map = parse(files);
  EXPECT_EQ(map.enclosure().min, Index3(0, 0, 0));
  EXPECT_EQ(map.enclosure().max, Index3(8, 7, 6));
  const VoxelMap original = random_map(1);
  for (const Label label : all_labels) EXPECT_EQ(map.count(label), original.count(label)) << name(label);
}

TEST(MapFile, HeadersOfOtherProgramsAreRead) {
  const std::string labels =
      "NRRD0004\n# written elsewhere\ncontent: labels\ntype: unsigned char\ndimension: 3\nspace dimension: 3\nsizes: 1 "
      "1 2\n"
      "space directions: (0.5, 0, 0) (0, 0.5, 0) (0, 0, 0.5)\nkinds: space space space\nencoding: raw\n"
      "space origin: (1, 2, 3)\nauthor:=nobody\n\n" +
      std::string("\0\2", 2);
  const VoxelMap map = parse_map({"a.nrrd", labels}, std::nullopt);
  EXPECT_EQ(map.grid().min, Vec3(0.75, 1.75, 2.75));
  EXPECT_EQ(map.label({0, 0, 0}), Label::unmarked);
  EXPECT_EQ(map.label({0, 0, 1}), Label::empty);
}

TEST(MapFile, MapsOfEarlierVersionsAreReadAndNewerOnesRefused) {
  Files files = files_of(random_map(1));
  const std::string format = "vantage-format:=1\n";
  const std::string of_0_1 = replaced(files.labels, format, "");
  EXPECT_EQ(parse({of_0_1, files.surface}).count(Label::occupied), random_map(1).count(Label::occupied));
  files.labels = replaced(files.labels, format, "vantage-format:=2\n");
  try {
    (void)parse(files);
    FAIL() << "a newer format was read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has format 2; this program knows 1, take the program that wrote it"));
  }
}

TEST(MapFile, BadLabelFilesAreRefusedWithPlaceAndReason) {
  const Files good = files_of(random_map(2));
  const auto error = [&](const std::string& labels) {
    return input_error_of([&] { (void)parse({labels, good.surface}); });
  };
  const auto with = [&](std::string_view what, std::string_view instead) {
    return error(replaced(good.labels, what, instead));
  };
  EXPECT_EQ(error(""), "a.nrrd: is not a NRRD file (its first line must be 'NRRD0005')");
  EXPECT_THAT(error(good.labels.substr(0, 100)),
              HasSubstr("the header ends without an empty line; the file is cut off"));
  EXPECT_THAT(error(good.labels.substr(0, good.labels.size() - 1)),
              HasSubstr("a.nrrd: sizes 9 8 7 need 504 bytes, but 503 follow"));
  EXPECT_THAT(error(good.labels + "x"), HasSubstr("sizes 9 8 7 need 504 bytes, but 505 follow"));
  EXPECT_THAT(with("sizes: 9", "sizes: 8"), HasSubstr("sizes 8 8 7 need 448 bytes"));
  EXPECT_THAT(with("sizes: 9", "sizes: 0"), HasSubstr("sizes: 0 must be a whole number within 1 and 16384"));
  EXPECT_THAT(with("sizes: 9 8 7", "sizes: 16384 16384 16384"), HasSubstr("need 4398046511104 bytes"));
  EXPECT_THAT(with("sizes: 9 8 7", "sizes: 72 7"), HasSubstr("sizes: has 2 numbers, must be 3"));
  EXPECT_THAT(with("sizes: 9 8 7\n", ""), HasSubstr("the header has no field 'sizes'"));
  EXPECT_THAT(with("type: uint8\n", ""), HasSubstr("the header has no field 'type'"));
  EXPECT_THAT(with("type: uint8", "type: float"), HasSubstr("a.nrrd, line 3: type: 'float' must be uint8"));
  EXPECT_THAT(with("encoding: raw", "encoding: gzip"), HasSubstr("encoding: 'gzip' must be raw"));
  EXPECT_THAT(with("encoding: raw", "data file: b.raw"), HasSubstr("the voxels must follow the header"));
  EXPECT_THAT(with("dimension: 3", "dimension: 4"), HasSubstr("dimension: '4' must be 3"));
  EXPECT_THAT(with("(0.02,0,0)", "(0.03,0,0)"), HasSubstr("must be the voxel length on the diagonal"));
  EXPECT_THAT(with("(0.02,0,0)", "(0.02,0.01,0)"), HasSubstr("must be the voxel length on the diagonal"));
  EXPECT_THAT(with("(0.02,0,0) (0,0.02,0) (0,0,0.02)", "(-1,0,0) (0,-1,0) (0,0,-1)"),
              HasSubstr("must be the voxel length on the diagonal"));
  EXPECT_THAT(with("(0.02,0,0)", "(nan,0,0)"), HasSubstr("'nan' must be a finite number"));
  EXPECT_THAT(with("\"m\" \"m\" \"m\"", "\"mm\" \"mm\" \"mm\""), HasSubstr("space units"));
  EXPECT_THAT(with("enclosure:=2 1 0 7 5 6", "enclosure:=2 1 0 7 5"), HasSubstr("enclosure: has 5 numbers, must be 6"));
  EXPECT_THAT(with("enclosure:=2 1 0 7 5 6", "enclosure:=2 1 0 7 5 7"),
              HasSubstr("a.nrrd: enclosure 2 1 0 .. 7 5 7 must lie in the scene"));
  EXPECT_THAT(with("enclosure:=2 1 0 7 5 6", "enclosure:=2 1 0 7 5 -1"),
              HasSubstr("enclosure: -1 must be a whole number within 0 and"));
  EXPECT_THAT(with("enclosure:=2 1 0 7 5 6", "enclosure:=2 1 0 7 5 5"),
              HasSubstr("outside of the enclosure, where all must be empty"));
  std::string wrong_label = good.labels;
  wrong_label.back() = '\5';
  EXPECT_EQ(error(wrong_label), "a.nrrd: voxel (8, 7, 6) has the label 5: labels go from 0 to 4");
  wrong_label.back() = '\1';
  EXPECT_EQ(error(wrong_label),
            "a.nrrd: voxel (8, 7, 6) is occupied, but lies outside of the enclosure, where all must be empty");
}

TEST(MapFile, BadSurfaceFilesAreRefusedWithPlaceAndReason) {
  VoxelMap map({{0, 0, 0}, 1, {4, 1, 1}}, {{0, 0, 0}, {3, 0, 0}});
  map.add_point({0, 0, 0}, Vec3::UnitX(), 0.5);
  map.add_point({2, 0, 0}, Vec3::UnitX(), 0.5);
  const Files good = files_of(map);
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "nx\n"
      "property float ny\nproperty float nz\nproperty float quality\nend_header\n";
  const std::string first = "0.5 0.5 0.5 1 0 0 0.5\n";
  ASSERT_EQ(parse({good.labels, head + first + "2.5 0.5 0.5 0 0 0 0\n"}).surface({2, 0, 0})->quality, 0)
      << "no normal is fine";
  const auto error = [&](const std::string& second) {
    return input_error_of([&] { (void)parse({good.labels, head + first + second}); });
  };
  EXPECT_THAT(error("9.5 0.5 0.5 1 0 0 1\n"),
              HasSubstr("a.ply: vertex 1 at (9.5, 0.5, 0.5) lies outside of the scene"));
  EXPECT_THAT(error("nan 0.5 0.5 1 0 0 1\n"), HasSubstr("vertex 1 at (nan, 0.5, 0.5) lies outside of the scene"));
  EXPECT_THAT(error("4 1 1 1 0 0 1\n"), HasSubstr("is not the centre of a voxel"));
  EXPECT_THAT(error("2.3 0.5 0.5 1 0 0 1\n"),
              HasSubstr("vertex 1 at (2.3, 0.5, 0.5) is not the centre of a voxel (off by 0.2 voxels)"));
  EXPECT_THAT(error("1.5 0.5 0.5 1 0 0 1\n"),
              HasSubstr("vertex 1 is in voxel (1, 0, 0), which the labels say is unmarked, must be occupied"));
  EXPECT_THAT(error(first), HasSubstr("voxel (0, 0, 0) has two vertices"));
  EXPECT_THAT(error("2.5 0.5 0.5 1 1 0 1\n"),
              HasSubstr("vertex 1 has the normal (1, 1, 0): its length must be 1, or 0 for none"));
  EXPECT_THAT(error("2.5 0.5 0.5 nan 0 0 1\n"), HasSubstr("its length must be 1"));
  EXPECT_THAT(error("2.5 0.5 0.5 1 0 0 1.5\n"), HasSubstr("vertex 1 has the quality 1.5: must be within 0 and 1"));
  EXPECT_THAT(error(""), HasSubstr("the file is cut off"));
  EXPECT_THAT(input_error_of([&] {
                (void)parse({good.labels, replaced(head, "vertex 2", "vertex 1") + first});
              }),
              HasSubstr("a.ply: has 1 vertices for 2 occupied voxels; must be one each"));
  EXPECT_THAT(input_error_of([&] {
                (void)parse({good.labels, replaced(head, "quality", "cosine") + first});
              }),
              HasSubstr("a.ply"));
  EXPECT_THAT(input_error_of([&] {
                (void)parse_map({"a.nrrd", good.labels}, std::nullopt);
              }),
              HasSubstr("a.nrrd: 2 voxels are occupied, but the file with their normals and qualities is missing"));
}

TEST(MapFile, PathsAreChecked) {
  const TestFolder folder;
  EXPECT_THAT(input_error_of([&] { (void)read_map(folder / "a.map"); }),
              HasSubstr("a.map: the name of a map must end in .nrrd"));
  EXPECT_THAT(input_error_of([&] { (void)read_map(folder / "a.nrrd"); }), HasSubstr("a.nrrd: cannot be read"));
  EXPECT_THAT(error_of([&] { write_map(random_map(1), folder / "none" / "a.nrrd"); }),
              HasSubstr("none/a.ply: cannot be written"));
}

TEST(MapFile, DamagedFilesAreReadOrRefused) {
  const Files good = files_of(random_map(3));
  const auto check = [&](const Files& files) {
    const VoxelMap map = parse(files);
    ASSERT_GE(map.mean_quality(), 0);
    ASSERT_LE(map.mean_quality(), 1);
  };
  const FuzzCount labels = read_damaged(good.labels, 3000, [&](const std::string& bytes) {
    check({bytes, good.surface});
  });
  EXPECT_EQ(labels.accepted + labels.refused, 3000);
  EXPECT_GT(labels.refused, 1000);
  const FuzzCount surface = read_damaged(good.surface, 3000, [&](const std::string& bytes) {
    check({good.labels, bytes});
  });
  EXPECT_EQ(surface.accepted + surface.refused, 3000);
  EXPECT_GT(surface.refused, 1000);
}

}  // namespace
}  // namespace vantage
