#include "cli_options.hpp"

#include <gmock/gmock.h>

#include "support/test_folder.hpp"

namespace vantage::app {
namespace {

using testing::HasSubstr;

struct ExampleOptions {
  bool navigation = true;
  bool fast = false;
  int max_views = 40;
  Vec3 center = Vec3::Zero();
  std::optional<double> max_distance;
};

template <class Field>
void describe(ExampleOptions& o, Field&& field) {
  field("navigation", o.navigation, "", "use the navigation factor");
  field("fast", o.fast, "", "be quick");
  field("max-views", o.max_views, "", "stop after this many scans");
  field("center", o.center, "m", "center of the scene");
  field("max-distance", o.max_distance, "m", "stop when this much has been travelled");
}

ExampleOptions parsed(const std::string& arguments) {
  ExampleOptions options;
  CLI::App app;
  add_options(app, options);
  app.parse(arguments);
  return options;
}

TEST(CliOptions, SetTheMembers) {
  const ExampleOptions options = parsed("--no-navigation --fast --max-views 3 --center -1,2.5,0 --max-distance=7");
  EXPECT_FALSE(options.navigation);
  EXPECT_TRUE(options.fast);
  EXPECT_EQ(options.max_views, 3);
  EXPECT_EQ(options.center, Vec3(-1, 2.5, 0));
  EXPECT_EQ(options.max_distance, 7);
  const ExampleOptions untouched = parsed("");
  EXPECT_TRUE(untouched.navigation);
  EXPECT_FALSE(untouched.max_distance.has_value());
}

TEST(CliOptions, BadValuesNameTheOption) {
  EXPECT_EQ(input_error_of([] { (void)parsed("--max-views ten"); }),
            "--max-views = 'ten': must be a whole number of at most 2147483647");
  EXPECT_EQ(input_error_of([] { (void)parsed("--center 1,2"); }),
            "--center = '1,2': must be 3 numbers separated by commas");
}

TEST(CliOptions, TheHelpHasDefaultsUnitsAndMeanings) {
  ExampleOptions options;
  CLI::App app;
  add_options(app, options);
  const std::string help = app.help();
  EXPECT_THAT(help, HasSubstr("--max-views"));
  EXPECT_THAT(help, HasSubstr("40"));
  EXPECT_THAT(help, HasSubstr("center of the scene [m]"));
  EXPECT_THAT(help, HasSubstr("--no-navigation"));
}

TEST(CliOptions, FormerNamesWorkWithAHint) {
  ExampleOptions options;
  CLI::App app;
  std::vector<OptionField> fields = option_fields(options);
  fields[0].former = {{"navigate", "0.2.0"}};
  fields[2].former = {{"most-views", "0.2.0"}};
  add_options(app, fields, {});
  testing::internal::CaptureStderr();
  app.parse("--most-views 3 --no-navigate --center 1,2,3");
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "vantage: --navigate is called --navigation since version 0.2.0; the former name goes on working for one "
            "version\nvantage: --most-views is called --max-views since version 0.2.0; the former name goes on working "
            "for one version\n");
  EXPECT_EQ(options.max_views, 3);
  EXPECT_FALSE(options.navigation);
  EXPECT_EQ(options.center, Vec3(1, 2, 3));
  for (const char* former : {"navigate", "most-views"}) EXPECT_EQ(app.help().find(former), std::string::npos);
}

TEST(CliOptions, TheCommandLineWinsOverTheFileWhateverTheOrder) {
  const TestFolder folder;
  write_file_atomically(folder / "a.yaml", "max-views: 5\nnavigation: false\n");
  const std::string config = "--config " + (folder / "a.yaml").string();
  for (const std::string& arguments : {config + " --max-views 3", "--max-views 3 " + config}) {
    const ExampleOptions options = parsed(arguments);
    EXPECT_EQ(options.max_views, 3);
    EXPECT_FALSE(options.navigation);
  }
  write_file_atomically(folder / "a.yaml", "max-view: 5\n");
  EXPECT_THAT(input_error_of([&] { (void)parsed(config); }),
              HasSubstr("a.yaml, line 1: unknown option 'max-view'; did you mean 'max-views'?"));
}

}  // namespace
}  // namespace vantage::app
