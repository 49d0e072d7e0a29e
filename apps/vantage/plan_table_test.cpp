#include "plan_table.hpp"

#include <gmock/gmock.h>

namespace vantage::app {
namespace {

Evaluation infeasible(const std::string& reason) {
  Evaluation evaluation;
  evaluation.feasible = false;
  evaluation.reason = reason;
  return evaluation;
}

TEST(InfeasibleByReason, SumsUpAndKeepsNumbersOnlyWhereTheyAgree) {
  std::vector<Evaluation> views(1);
  views[0].feasible = true;
  views.push_back(infeasible("the body touches occupied voxel 3,4,5"));
  for (int i = 0; i < 3; ++i) views.push_back(infeasible("outside the workspace"));
  views.push_back(infeasible("the body touches occupied voxel 3,4,6"));
  views.push_back(infeasible("the body touches obstacle 2"));
  EXPECT_THAT(infeasible_by_reason(views),
              testing::ElementsAre("3 of 7: outside the workspace", "2 of 7: the body touches occupied voxel …",
                                   "1 of 7: the body touches obstacle 2"));
  EXPECT_TRUE(infeasible_by_reason({views[0]}).empty());
}

}  // namespace
}  // namespace vantage::app
