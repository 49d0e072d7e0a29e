#include "vantage/robot/free_flyer.hpp"

#include "vantage/core/error.hpp"
#include "vantage/robot/clear_paths.hpp"

namespace vantage {
namespace {

class FreeFlyerMobility : public Mobility {
 public:
  FreeFlyerMobility(const Surroundings& surroundings, const ReachOptions& reach)
      : map_(surroundings.map), reach_(reach), space_(surroundings, reach.body_radius, reach.workspace) {
    reach_.obstacles.assign(surroundings.obstacles.begin(), surroundings.obstacles.end());
  }

  [[nodiscard]] std::optional<std::string> why_unreachable(const View& view) const override {
    return why_infeasible(map_, view, reach_);
  }
  [[nodiscard]] double least_cost(const RobotState& from, const View& to) const override {
    return (to.position() - from.view.position()).norm();
  }
  [[nodiscard]] Move move(const RobotState& from, const View& to) const override {
    Move move;
    const auto path = space_.path(from.view.position(), to.position());
    if (!path) {
      move.why_not = "no way there through known free space";
      return move;
    }
    move.cost = length_of(*path);
    const Eigen::Quaterniond start(from.view.world_from_sensor.linear());
    const Eigen::Quaterniond end(to.world_from_sensor.linear());
    double flown = 0;
    for (std::size_t i = 0; i < path->size(); ++i) {
      if (i > 0) flown += ((*path)[i] - (*path)[i - 1]).norm();
      View view = i == 0 ? from.view : to;
      if (i > 0 && i + 1 < path->size()) {
        view.world_from_sensor.linear() = start.slerp(flown / move.cost, end).toRotationMatrix();
        view.world_from_sensor.translation() = (*path)[i];
      }
      move.path.push_back({view});
    }
    return move;
  }

 private:
  const VoxelMap& map_;
  ReachOptions reach_;
  ClearPaths space_;
};

}  // namespace

FreeFlyer::FreeFlyer(const ReachOptions& reach) : reach_(reach) { reach_.validate(); }

std::unique_ptr<Mobility> FreeFlyer::among(const Surroundings& surroundings) const {
  return std::make_unique<FreeFlyerMobility>(surroundings, reach_);
}

}  // namespace vantage
