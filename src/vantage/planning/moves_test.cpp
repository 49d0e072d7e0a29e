#include "vantage/planning/moves.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "vantage/core/error.hpp"
#include "vantage/sensor/range_camera.hpp"

namespace vantage {
namespace {

/// Reaches what lies above z = 0; its paths are `detour` times as long as the straight line to views of odd height
/// (millimetres), and there is none to the candidates given.
class Climber : public RobotModel {
 public:
  double detour = 1;
  std::vector<View> walled_in;

  [[nodiscard]] std::unique_ptr<Mobility> among(const Surroundings&) const override {
    return std::make_unique<Paths>(*this);
  }

  [[nodiscard]] double length(const Vec3& from, const Vec3& to) const {
    const bool is_odd = static_cast<int>(std::lround(1000 * to.z())) % 2 != 0;
    return (to - from).norm() * (is_odd ? detour : 1);
  }

 private:
  class Paths : public Mobility {
   public:
    explicit Paths(const Climber& climber) : climber_(climber) {}
    [[nodiscard]] std::optional<std::string> why_unreachable(const View& view) const override {
      return view.position().z() > 0 ? std::nullopt : std::optional<std::string>("too low");
    }
    [[nodiscard]] double least_cost(const RobotState& from, const View& to) const override {
      return (to.position() - from.view.position()).norm();
    }
    [[nodiscard]] Move move(const RobotState& from, const View& to) const override {
      for (const View& walled_in : climber_.walled_in) {
        if (walled_in.position() == to.position()) return {{}, 0, "walled in"};
      }
      return {{from, {to}}, climber_.length(from.view.position(), to.position()), ""};
    }

   private:
    const Climber& climber_;
  };
};

/// A ball of hidden voxels in a shell of occupied ones, open towards +x and +z.
VoxelMap open_shell() {
  SceneOptions scene;
  scene.voxel_length = 0.05;
  scene.scene_size = Index3::Constant(81);
  scene.enclosure_size = Index3::Constant(21);
  VoxelMap map(scene);
  const IndexBox box = map.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        const Vec3 offset = map.grid().center({x, y, z});
        const bool is_open = offset.x() > 0.1 || offset.z() > 0.2;
        map.set_label({x, y, z}, offset.norm() > 0.4                ? Label::empty
                                 : offset.norm() > 0.33 && !is_open ? Label::occupied
                                                                    : Label::occluded);
      }
    }
  }
  map.update_occplane();
  return map;
}

struct MovesOfThePlanner : public ::testing::Test {
  VoxelMap map = open_shell();
  RangeCamera camera = camera_from_apertures(radians(45), radians(45), {64, 64});
  Candidates candidates = view_sphere(80, 1.6, Vec3::Zero());
  std::shared_ptr<Climber> robot = std::make_shared<Climber>();
  View current = view_towards(Vec3(0, 1, 1.2), Vec3::Zero());

  [[nodiscard]] PlannerOptions options() const {
    PlannerOptions result;
    result.robot = robot;
    result.travel = TravelKind::path;
    return result;
  }
};

TEST_F(MovesOfThePlanner, ViewsOutOfReachFallOutWithTheReason) {
  Planner planner(candidates, camera, options());
  const auto plan = planner.next_best_view(map, current);
  ASSERT_TRUE(plan);
  int low = 0;
  for (const View& view : candidates.views) low += view.position().z() > 0 ? 0 : 1;
  EXPECT_EQ(plan->infeasible.size(), static_cast<std::size_t>(low));
  for (const Evaluation& each : plan->infeasible) EXPECT_EQ(each.reason, "too low");
  EXPECT_EQ(plan->move.path.back().view.position(), plan->best.view.position());
  EXPECT_EQ(planner.distance_of(*plan, current.position()), (plan->best.view.position() - current.position()).norm());
}

TEST_F(MovesOfThePlanner, TheBestViewIsTheOneThatPlanningEveryWayWouldGive) {
  for (const double detour : {1.0, 1.3, 3.0, 20.0}) {
    robot->detour = detour;
    Planner planner(candidates, camera, options());
    const auto plan = planner.next_best_view(map, current);
    ASSERT_TRUE(plan);
    // By definition: eq. 10 with the cost of every way over the largest direct one.
    double largest = 0;
    for (const Evaluation& each : plan->ranking) {
      largest = std::max(largest, (each.view.position() - current.position()).norm());
    }
    std::vector<Evaluation> by_definition = plan->ranking;
    for (Evaluation& each : by_definition) {
      const double cost = robot->length(current.position(), each.view.position());
      each.factors = factors(each.seen, std::min(1.0, cost / largest), {});
      each.score = combined_utility(each.factors);
    }
    rank(by_definition);
    EXPECT_EQ(plan->best.candidate, by_definition.front().candidate) << detour;
    EXPECT_EQ(plan->best.score, by_definition.front().score) << detour;
  }
}

TEST_F(MovesOfThePlanner, WhereThereIsNoWayTheNextInRankIsTaken) {
  Planner planner(candidates, camera, options());
  const auto first = planner.next_best_view(map, current);
  ASSERT_TRUE(first);
  robot->walled_in = {first->best.view};
  const auto second = planner.next_best_view(map, current);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->best.candidate, first->ranking[1].candidate);
  EXPECT_EQ(second->infeasible.back().candidate, first->best.candidate);
  EXPECT_EQ(second->infeasible.back().reason, "walled in");
}

TEST_F(MovesOfThePlanner, TheNextInRankIsWhatPlanningWithoutTheDiscardedViewGives) {
  Planner planner(candidates, camera, options());
  auto plan = planner.next_best_view(map, current);
  int views = 0;
  for (; plan && views < 10; ++views) {
    const int gone = plan->best.candidate;
    plan = planner.next_in_rank(map, current, *std::move(plan), "jammed");
    const auto again = planner.next_best_view(map, current);
    ASSERT_TRUE(plan);
    ASSERT_TRUE(again);
    EXPECT_EQ(plan->best.candidate, again->best.candidate);
    EXPECT_EQ(plan->infeasible.back().candidate, gone);
    EXPECT_EQ(plan->infeasible.back().reason, "jammed");
  }
  EXPECT_EQ(views, 10);
}

TEST_F(MovesOfThePlanner, RefusingTheFarthestViewChangesNothingAboutTheOthers) {
  // Its cost is what the others' costs are counted by. Shifted candidates make it far off without making it likely.
  candidates.views.push_back(view_towards(Vec3(0, -3, 4), Vec3::Zero()));
  const int farthest = static_cast<int>(candidates.views.size()) - 1;
  robot->detour = 1.3;
  Planner planner(candidates, camera, options());
  auto plan = planner.next_best_view(map, current);
  ASSERT_TRUE(plan);
  const double largest = (candidates.views.back().position() - current.position()).norm();
  EXPECT_DOUBLE_EQ(plan->largest_cost, largest);
  const std::vector<Evaluation> before = plan->ranking;
  plan->best = *std::find_if(before.begin(), before.end(), [&](const auto& e) { return e.candidate == farthest; });
  const auto next = planner.next_in_rank(map, current, *std::move(plan), "jammed");
  ASSERT_TRUE(next);
  EXPECT_EQ(next->best.candidate, before.front().candidate);
  EXPECT_EQ(next->best.score, before.front().score);
  // The detour of views that come to the front is counted by the same length.
  auto later = planner.next_in_rank(map, current, *next, "jammed");
  ASSERT_TRUE(later);
  const double cost = robot->length(current.position(), later->best.view.position());
  EXPECT_DOUBLE_EQ(later->best.factors.f_navigation, factors(later->best.seen, cost / largest, {}).f_navigation);
}

TEST_F(MovesOfThePlanner, StraightAndOrthodromicTravelNeedNoRobot) {
  PlannerOptions straight;
  straight.travel = TravelKind::straight;
  Planner planner(candidates, camera, straight);
  const auto plan = planner.next_best_view(map, current);
  ASSERT_TRUE(plan);
  EXPECT_FALSE(plan->move.possible());
  EXPECT_EQ(planner.distance_of(*plan, current.position()), (plan->best.view.position() - current.position()).norm());
  straight.travel = TravelKind::orthodromic;
  EXPECT_THROW(Planner(view_cube(3, Vec3::Constant(3), 0.5, 2, Vec3::Zero()), camera, straight), InputError);
}

TEST_F(MovesOfThePlanner, PathWithoutARobotIsThatOfAFreeFlyer) {
  PlannerOptions options;
  options.travel = TravelKind::path;
  options.reach.body_radius = 0.1;
  Planner planner(candidates, camera, options);
  const auto plan = planner.next_best_view(map, current);
  ASSERT_TRUE(plan);
  EXPECT_TRUE(plan->move.possible());
  EXPECT_GE(plan->move.cost, (plan->best.view.position() - current.position()).norm());
}

TEST_F(MovesOfThePlanner, AreTheSameForAnyNumberOfThreads) {
  PlannerOptions options;
  options.travel = TravelKind::path;
  options.reach.body_radius = 0.3;
  std::optional<Plan> plans[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, i + 1);
    plans[i] = Planner(candidates, camera, options).next_best_view(map, current);
    ASSERT_TRUE(plans[i]);
  }
  ASSERT_EQ(plans[0]->ranking.size(), plans[1]->ranking.size());
  for (std::size_t i = 0; i < plans[0]->ranking.size(); ++i) {
    EXPECT_EQ(plans[0]->ranking[i].candidate, plans[1]->ranking[i].candidate);
    EXPECT_EQ(plans[0]->ranking[i].score, plans[1]->ranking[i].score);
  }
  EXPECT_EQ(plans[0]->move.cost, plans[1]->move.cost);
}

}  // namespace
}  // namespace vantage
