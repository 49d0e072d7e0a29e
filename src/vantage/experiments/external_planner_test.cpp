#include "vantage/experiments/external_planner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "support/test_folder.hpp"
#include "vantage/core/error.hpp"

namespace vantage {
namespace {

using ::testing::HasSubstr;

struct ExternalPlanner : public ::testing::Test {
  VoxelMap map{[] {
    SceneOptions scene;
    scene.scene_size = Index3::Constant(9);
    scene.enclosure_size = Index3::Constant(5);
    return scene;
  }()};
  VisibilityEvaluator visibility{map};
  RangeCamera camera;
  std::vector<ViewToJudge> views = [] {
    std::vector<ViewToJudge> three(3);
    for (int i = 0; i < 3; ++i) three[static_cast<std::size_t>(i)].candidate = 10 + i;
    return three;
  }();

  [[nodiscard]] std::vector<double> scores(const std::string& command, double timeout = 20) const {
    return judge(external_planner({command, timeout}), {map, visibility, camera, {}, {}, 1, views});
  }
  [[nodiscard]] std::string error(const std::string& command, double timeout = 20) const {
    try {
      (void)scores(command, timeout);
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  }
};

TEST_F(ExternalPlanner, ChoosesByTheIndexThatItAnswers) {
  EXPECT_EQ(scores("while read line; do echo '{\"index\": 11}'; done"), (std::vector<double>{0, 1, 0}));
}

TEST_F(ExternalPlanner, IsAskedAgainAndAgainAndFindsTheMapFile) {
  const Utility utility =
      external_planner({"python3 -c \"\nimport json,sys,os\nfor line in sys.stdin:\n  c = json.loads(line)\n"
                        "  ok = os.path.exists(c['map'])\n"
                        "  print(json.dumps({'index': c['candidates'][-1]['index'] if ok else -1}), flush=True)\n\"",
                        30});
  const Choice choice{map, visibility, camera, {}, {}, 1, views};
  EXPECT_EQ(judge(utility, choice), (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(judge(utility, choice), (std::vector<double>{0, 0, 1}));
}

TEST_F(ExternalPlanner, TellsWhatIsWrongWithAnAnswer) {
  EXPECT_THAT(error("echo '{\"index\": 3}'"), HasSubstr("index 3, which is none of the candidates"));
  EXPECT_THAT(error("echo view 11"), HasSubstr("answered 'view 11'; must be one line such as {\"index\": 3}"));
  EXPECT_THAT(error("echo '{\"index\": \"11\"}'"), HasSubstr("must be one line such as"));
}

TEST_F(ExternalPlanner, TakesNoIndexForAnotherOne) {
  // 2^32 + 11, 2^64 - 2^32 + 11 and -2^32 + 11 are 11 where 32 bits are all that is looked at.
  for (const char* index : {"4294967307", "18446744069414584331", "-4294967285", "11.0", "1e400"})
    EXPECT_THAT(error(concat("echo '{\"index\": ", index, "}'")), HasSubstr("must be one line such as")) << index;
}

TEST_F(ExternalPlanner, ItsAnswerCanAlwaysBePrinted) {
  EXPECT_THAT(error("printf 'v\\377\\033[2J\\n'"), HasSubstr("answered 'v??[2J'"));
}

TEST_F(ExternalPlanner, LeavesNothingRunningBehind) {
  const TestFolder folder;
  const std::string file = (folder / "beats").string();
  // The shell ends at once when its input does; what it started would go on for ever.
  (void)scores("(while true; do echo x >> " + file + "; sleep 0.05; done) > /dev/null 2>&1 & " +
               "read line; echo '{\"index\": 11}'; while read line; do true; done");
  const auto beats = [&file] { return std::filesystem::file_size(file); };
  const auto after = beats();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(beats(), after);
}

TEST_F(ExternalPlanner, TellsWhereTheProgramEnds) {
  EXPECT_THAT(error("exit 3"), HasSubstr("external planner 'exit 3': ended without"));
  EXPECT_THAT(error("/no/such/program"), HasSubstr("ended without"));
}

TEST_F(ExternalPlanner, DoesNotWaitForEver) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THAT(error("sleep 100", 0.3), HasSubstr("no answer within 0.3 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

TEST_F(ExternalPlanner, NeedsACommandAndAPositiveTimeout) {
  EXPECT_THROW((void)external_planner({"", 1}), InputError);
  EXPECT_THROW((void)external_planner({"true", 0}), InputError);
}

}  // namespace
}  // namespace vantage
