#include "vantage/options/options.hpp"

#include <gmock/gmock.h>

#include <array>

#include "support/test_folder.hpp"

namespace vantage {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

enum class Search { exhaustive, multi_resolution };
std::array<std::pair<Search, const char*>, 2> names_of(Search) {
  return {{{Search::exhaustive, "exhaustive"}, {Search::multi_resolution, "multi-resolution"}}};
}

struct ExampleOptions {
  bool navigation = true;
  int max_views = 40;
  std::uint64_t seed = 1;
  double voxel = 0.02;
  std::string candidates = "sphere:80:2";
  Vec3 center = Vec3::Zero();
  Index3 scene = Index3::Constant(205);
  Eigen::Vector2d depth_range{0, 4.5};
  std::optional<double> max_distance;
  std::optional<std::string> workspace;
  Search search = Search::exhaustive;
  Resolution rays{320, 320};
};

template <class Field>
void describe(ExampleOptions& o, Field&& field) {
  field("navigation", o.navigation, "", "use the navigation factor");
  field("max-views", o.max_views, "", "stop after this many scans");
  field("seed", o.seed, "", "seed of everything random");
  field("voxel", o.voxel, "m", "edge of a voxel");
  field("candidates", o.candidates, "", "sphere:N:R | cube:...");
  field("center", o.center, "m", "center of the scene");
  field("scene", o.scene, "voxels", "size of the scene");
  field("depth-range", o.depth_range, "m", "nearest and farthest depth");
  field("max-distance", o.max_distance, "m", "stop when this much has been travelled");
  field("workspace", o.workspace, "m", "box that the sensor stays in");
  field("search", o.search, "", "how views are searched");
  field("rays", o.rays, "", "rays per view");
}

ExampleOptions unusual() {
  ExampleOptions o;
  o.navigation = false;
  o.max_views = -3;
  o.seed = 18446744073709551615U;
  o.voxel = 0.1 + 0.2;
  o.candidates = "  quotes \" and \\ and # and: \n\t";
  o.center = {1e-300, -2.5, 1.0 / 3};
  o.scene = {1, 2, 3};
  o.depth_range = {0.25, 1.5};
  o.max_distance = 12.5;
  o.workspace = "-1,-1,0,1,1,2";
  o.search = Search::multi_resolution;
  o.rays = {79, 60};
  return o;
}

std::vector<std::string> texts(ExampleOptions o) {
  std::vector<std::string> result;
  for (const OptionField& field : option_fields(o)) result.push_back(field.text());
  return result;
}

std::string yaml_error(const std::string& yaml) {
  ExampleOptions o;
  return input_error_of([&] { set_options_from_yaml(option_fields(o), yaml, "config.yaml"); });
}

TEST(TextValue, EveryTypeIsPrintedAndParsed) {
  EXPECT_THAT(texts({}), ElementsAre("true", "40", "1", "0.02", "sphere:80:2", "0,0,0", "205,205,205", "0,4.5", "none",
                                     "none", "exhaustive", "320x320"));
  EXPECT_EQ(TextValue<Vec3>::parse(" 1, -2.5 ,3e-2"), Vec3(1, -2.5, 0.03));
  EXPECT_EQ(TextValue<bool>::parse("off"), false);
  for (const char* bad : {"", "1,2", "1,2,3,4", "1,,3", "1,2,x", "1 2 3", "1,2,nan"})
    EXPECT_FALSE(TextValue<Vec3>::parse(bad)) << bad;
  for (const char* bad : {"", "320", "x", "0x3", "-1x3", "3x", "3x4x5", "1.5x2"})
    EXPECT_FALSE(TextValue<Resolution>::parse(bad)) << bad;
  for (const char* bad : {"", "1.5", "2147483648", "ten"}) EXPECT_FALSE(TextValue<int>::parse(bad)) << bad;
  for (const char* bad : {"", "-1", "1e3"}) EXPECT_FALSE(TextValue<std::uint64_t>::parse(bad)) << bad;
  for (const char* bad : {"", "inf", "nan", "1,5"}) EXPECT_FALSE(TextValue<double>::parse(bad)) << bad;
  for (const char* bad : {"", "True", "1"}) EXPECT_FALSE(TextValue<bool>::parse(bad)) << bad;
  EXPECT_FALSE(TextValue<Search>::parse("fast"));
}

TEST(Options, YamlGivesBackWhatWasWrittenToTheLastBit) {
  ExampleOptions odd_texts;
  odd_texts.candidates = "null";
  odd_texts.workspace = "- a: [b";
  for (const ExampleOptions& written : {ExampleOptions{}, unusual(), odd_texts}) {
    ExampleOptions copy = written;
    const std::string yaml = options_as_yaml(option_fields(copy));
    ExampleOptions read = unusual();
    set_options_from_yaml(option_fields(read), yaml, "config.yaml");
    EXPECT_EQ(texts(read), texts(written)) << yaml;
    EXPECT_EQ(read.voxel, written.voxel);
    EXPECT_EQ(read.center, written.center);
  }
}

TEST(Options, YamlHasUnitsAndMeaningsAsComments) {
  ExampleOptions o;
  const std::string yaml = options_as_yaml(option_fields(o));
  EXPECT_THAT(yaml, HasSubstr("navigation: true         # use the navigation factor\n"));
  EXPECT_THAT(yaml, HasSubstr("voxel: 0.02              # edge of a voxel [m]\n"));
  EXPECT_THAT(yaml, HasSubstr("center: [0, 0, 0] "));
  EXPECT_THAT(yaml, HasSubstr("candidates: sphere:80:2 "));
  EXPECT_THAT(yaml, HasSubstr("max-distance: none "));
}

TEST(Options, OnlyWhatTheYamlNamesChanges) {
  ExampleOptions o = unusual();
  set_options_from_yaml(option_fields(o),
                        "center: 1,2,3\nmax-distance: ~\nworkspace:\nsearch: exhaustive\nmode: fast\n", "config.yaml",
                        {"mode"});
  ExampleOptions expected = unusual();
  expected.center = {1, 2, 3};
  expected.max_distance.reset();
  expected.workspace.reset();
  expected.search = Search::exhaustive;
  EXPECT_EQ(texts(o), texts(expected));
  set_options_from_yaml(option_fields(o), "", "config.yaml");
  EXPECT_EQ(texts(o), texts(expected));
}

TEST(Options, BadYamlIsRefusedWithPlaceValueAndReason) {
  EXPECT_EQ(yaml_error("voxel: 0.02\nmax-view: 3\n"),
            "config.yaml, line 2: unknown option 'max-view'; did you mean 'max-views'?");
  EXPECT_EQ(yaml_error("xovel: 3\n"), "config.yaml, line 1: unknown option 'xovel'; did you mean 'voxel'?");
  EXPECT_EQ(yaml_error("colour: red\n"),
            "config.yaml, line 1: unknown option 'colour'; `vantage config` prints all there are");
  EXPECT_EQ(yaml_error("\nmax-views: ten\n"),
            "config.yaml, line 2: max-views = 'ten': must be a whole number of at most 2147483647");
  EXPECT_EQ(yaml_error("max-views: none\n"),
            "config.yaml, line 1: max-views = 'none': must be a whole number of at most 2147483647");
  EXPECT_EQ(yaml_error("seed: -1\n"), "config.yaml, line 1: seed = '-1': must be a whole number, not negative");
  EXPECT_EQ(yaml_error("voxel: 2 cm\n"), "config.yaml, line 1: voxel = '2 cm': must be a finite number");
  EXPECT_EQ(yaml_error("center: [0, 0]\n"),
            "config.yaml, line 1: center = '0,0': must be 3 numbers separated by commas");
  EXPECT_EQ(yaml_error("scene: 1,2,2.5\n"),
            "config.yaml, line 1: scene = '1,2,2.5': must be 3 whole numbers separated by commas");
  EXPECT_EQ(yaml_error("navigation: maybe\n"), "config.yaml, line 1: navigation = 'maybe': must be true or false");
  EXPECT_EQ(yaml_error("search: fast\n"),
            "config.yaml, line 1: search = 'fast': must be one of exhaustive, multi-resolution");
  EXPECT_EQ(yaml_error("rays: 320\n"), "config.yaml, line 1: rays = '320': must be COLUMNSxROWS, both positive");
  EXPECT_EQ(yaml_error("max-distance: far\n"),
            "config.yaml, line 1: max-distance = 'far': must be a finite number, or none");
  EXPECT_EQ(yaml_error("voxel: 1\nvoxel: 2\n"), "config.yaml, line 2: option 'voxel' stands twice");
  EXPECT_EQ(yaml_error("voxel: {a: 1}\n"), "config.yaml, line 1: voxel: must be a value or a flat list");
  EXPECT_EQ(yaml_error("center: [[0], 0, 0]\n"), "config.yaml, line 1: center: must be a value or a flat list");
  EXPECT_EQ(yaml_error("- voxel\n"), "config.yaml: must be a list of lines 'option: value'");
  EXPECT_EQ(yaml_error("[a, b]: 1\n"), "config.yaml, line 1: the name of an option must be a word");
  EXPECT_THAT(yaml_error("voxel: [1\n"), HasSubstr("config.yaml, line 2: "));
  EXPECT_THAT(yaml_error("voxel: 1\n\tseed: 2\n"), HasSubstr("config.yaml, line "));
}

TEST(Options, FormerNamesWorkWithAHint) {
  ExampleOptions o;
  std::vector<OptionField> fields = option_fields(o);
  fields[3].former = {{"voxel-size", "0.2.0"}};
  ASSERT_EQ(fields[3].name, "voxel");
  EXPECT_THAT(
      set_options_from_yaml(fields, "max-views: 3\nvoxel-size: 0.5\n", "config.yaml"),
      ElementsAre("config.yaml, line 2: voxel-size is called voxel since version 0.2.0; the former name goes on "
                  "working for one version"));
  EXPECT_EQ(o.voxel, 0.5);
  EXPECT_THAT(set_options_from_yaml(fields, "voxel: 0.25\n", "config.yaml"), ElementsAre());
  EXPECT_EQ(o.voxel, 0.25);
  EXPECT_EQ(input_error_of([&] { (void)set_options_from_yaml(fields, "voxel: 1\nvoxel-size: 2\n", "config.yaml"); }),
            "config.yaml, line 2: option 'voxel' stands twice");
  EXPECT_EQ(input_error_of([&] { (void)set_options_from_yaml(fields, "voxel-size: x\n", "config.yaml"); }),
            "config.yaml, line 1: voxel-size = 'x': must be a finite number");
}

TEST(Options, ConfigurationsOfNewerProgramsAreRefusedWhole) {
  ExampleOptions o;
  const auto read = [&](const std::string& yaml) {
    (void)set_options_from_yaml(option_fields(o), yaml, "config.yaml");
  };
  read("# vantage reconstruct mug\n" + configuration_head() + "voxel: 0.5\n");
  EXPECT_EQ(o.voxel, 0.5);
  read("voxel: 0.25\n# configuration of vantage, format 2\n");  // a comment like any other
  EXPECT_EQ(o.voxel, 0.25);
  EXPECT_EQ(input_error_of([&] { read("# made by hand\n# configuration of vantage, format 2\nvoxel: 0.5\n"); }),
            "config.yaml: has format 2; this program knows 1, take the program that wrote it, or a newer one");
  EXPECT_EQ(o.voxel, 0.25);
  read("# only a comment");
}

TEST(Options, DamagedYamlIsReadOrRefused) {
  ExampleOptions o = unusual();
  const std::string valid = options_as_yaml(option_fields(o));
  const FuzzCount count = read_damaged(valid, 2000, [](const std::string& bytes) {
    ExampleOptions read;
    set_options_from_yaml(option_fields(read), bytes, "a");
    ASSERT_TRUE(std::isfinite(read.voxel));
  });
  EXPECT_EQ(count.accepted + count.refused, 2000);
  EXPECT_GT(count.refused, 300);
}

TEST(Options, MarkdownIsATableOfAll) {
  ExampleOptions o;
  const std::string table = options_as_markdown(option_fields(o));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2 + 12);
  EXPECT_THAT(table, HasSubstr("| option | default | unit | meaning |\n|---|---|---|---|\n"));
  EXPECT_THAT(table, HasSubstr("| `voxel` | `0.02` | m | edge of a voxel |\n"));
  EXPECT_THAT(table, HasSubstr("| `candidates` | `sphere:80:2` |  | sphere:N:R \\| cube:... |\n"));
}

TEST(NearestName, IsTheOneWithTheFewestEdits) {
  const std::vector<std::string> names{"voxel", "max-views", "max-time"};
  EXPECT_EQ(nearest_name("maxviews", names), "max-views");
  EXPECT_EQ(nearest_name("max_time", names), "max-time");
  EXPECT_EQ(nearest_name("vxoel", names), "voxel") << "two letters swapped";
  EXPECT_EQ(nearest_name("registration", names), "");
}

}  // namespace
}  // namespace vantage
