#include "manual.hpp"

#include <gmock/gmock.h>

namespace vantage::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A program with a command, a command with a step, and a hidden command.
class ManualTest : public ::testing::Test {
 protected:
  ManualTest() : program_("Plans views.") {
    program_.name("vantage");
    CLI::App* plan = program_.add_subcommand("plan", "Take scans: say where to look");
    plan->add_option("scans", scans_, "folder of scans")->required();
    plan->add_option("--voxel", voxel_, "edge of a voxel [m]")->capture_default_str();
    plan->add_flag("--json", json_, "as JSON, don't print a table");
    CLI::App* session = program_.add_subcommand("session", "Scan over hours");
    session->add_subcommand("new", "Start a session")->add_option("--box", scans_, ".hidden by no dot");
    program_.add_subcommand("secret", "nobody sees this")->group("");
  }

  std::string scans_;
  double voxel_ = 0.5;
  bool json_ = false;
  CLI::App program_;
};

TEST_F(ManualTest, ManPagesNameEveryCommandAndOption) {
  const std::string main = man_page(program_, "1.2");
  EXPECT_THAT(main, HasSubstr(".TH VANTAGE 1 \"\" \"vantage 1.2\""));
  EXPECT_THAT(main, HasSubstr("\\fBvantage plan\\fR\nTake scans: say where to look"));
  EXPECT_THAT(main, Not(HasSubstr("secret")));
  const std::string plan = man_page(*program_.get_subcommand("plan"), "1.2");
  EXPECT_THAT(plan, HasSubstr("vantage\\-plan \\- Take scans"));
  EXPECT_THAT(plan, HasSubstr("\\fB\\-\\-voxel\\fR \\fIFLOAT\\fR\nedge of a voxel [m] (default: 0.5)"));
  EXPECT_THAT(plan, HasSubstr("\\fB\\-\\-json\\fR\nas JSON"));
  const std::string session = man_page(*program_.get_subcommand("session"), "1.2");
  EXPECT_THAT(session, HasSubstr(".SS vantage session new\nStart a session"));
  EXPECT_THAT(session, HasSubstr("\n\\&.hidden by no dot")) << "a line that begins with a dot would be a request";
}

TEST_F(ManualTest, CompletionsKnowCommandsStepsAndOptions) {
  const std::string bash = bash_completion(program_);
  EXPECT_THAT(bash, HasSubstr("'vantage plan') words='--help --voxel --json'"));
  EXPECT_THAT(bash, HasSubstr("'vantage session') words='new --help'"));
  EXPECT_THAT(bash, Not(HasSubstr("secret")));
  const std::string zsh = zsh_completion(program_);
  EXPECT_THAT(zsh, HasSubstr("'plan:Take scans\\: say where to look'"));
  EXPECT_THAT(zsh, HasSubstr("'--json[as JSON, don'\\''t print a table]'"));
  EXPECT_THAT(zsh, HasSubstr("new) _vantage_session_new ;;"));
}

}  // namespace
}  // namespace vantage::app
