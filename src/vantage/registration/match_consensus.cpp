#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/registration/feature_matches.hpp"

namespace vantage {
namespace {

/// Two places this near to each other fit everywhere.
constexpr double nearest_in_cells = 3;
/// A match supports a pose that puts its places at most so far apart.
constexpr double support_in_cells = 2;
constexpr double least_cosine = 0.8;  // of the normals then
constexpr double twins_in_cells = 3;

using Members = std::vector<std::size_t>;  // numbers of matches

/// Which matches are consistent with each other, a row of bits each.
class ConsistencyGraph {
 public:
  template <class Consistent>
  ConsistencyGraph(std::size_t size, const Consistent& consistent)
      : size_(size), words_((size + 63) / 64), bits_(size * words_, 0) {
    parallel_for(size, [&](std::size_t i) {
      for (std::size_t j = 0; j < size_; ++j) {
        if (j != i && consistent(i, j)) bits_[i * words_ + j / 64] |= std::uint64_t{1} << (j % 64);
      }
    });
  }

  [[nodiscard]] bool at(std::size_t i, std::size_t j) const {
    return ((bits_[i * words_ + j / 64] >> (j % 64)) & 1U) != 0;
  }
  /// Number of matches that are consistent with both.
  [[nodiscard]] int shared(std::size_t i, std::size_t j) const {
    int sum = 0;
    for (std::size_t w = 0; w < words_; ++w) sum += std::popcount(bits_[i * words_ + w] & bits_[j * words_ + w]);
    return sum;
  }
  /// The match that is consistent with `i` and shares most others with it; `i` where there is none.
  [[nodiscard]] std::size_t best_partner(std::size_t i) const {
    std::size_t best = i;
    int most = 0;
    for (std::size_t j = 0; j < size_; ++j) {
      if (!at(i, j)) continue;
      const int count = shared(i, j);
      if (count > most) {
        most = count;
        best = j;
      }
    }
    return best;
  }
  [[nodiscard]] Members agreed(std::size_t i, std::size_t j) const {
    Members members{i, j};
    for (std::size_t k = 0; k < size_; ++k) {
      if (at(i, k) && at(j, k)) members.push_back(k);
    }
    return members;
  }

 private:
  std::size_t size_, words_;
  std::vector<std::uint64_t> bits_;
};

class Consensus {
 public:
  Consensus(const SurfaceFeatures& fixed, const SurfaceFeatures& moving, const std::vector<FeatureMatch>& matches)
      : fixed_(fixed), moving_(moving), matches_(matches) {}

  /// The pose of least squares that lays the places of the members on each other, and their normals.
  [[nodiscard]] Pose fitted(const Members& members) const {
    const double arm = nearest_in_cells * fixed_.cell;  // at which a wrong normal is worth as much as a wrong place
    Vec3 fixed_mean = Vec3::Zero(), moving_mean = Vec3::Zero();
    for (const std::size_t m : members) {
      fixed_mean += fixed_at(m).point;
      moving_mean += moving_at(m).point;
    }
    fixed_mean /= static_cast<double>(members.size());
    moving_mean /= static_cast<double>(members.size());
    Mat3 products = Mat3::Zero();
    for (const std::size_t m : members) {
      products += (fixed_at(m).point - fixed_mean) * (moving_at(m).point - moving_mean).transpose();
      products += arm * arm * fixed_at(m).normal * moving_at(m).normal.transpose();
    }
    const Eigen::JacobiSVD<Mat3> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3 signs = Vec3::Ones();
    if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
    Pose pose = Pose::Identity();
    pose.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    pose.translation() = fixed_mean - pose.linear() * moving_mean;
    return pose;
  }

  [[nodiscard]] Members supporters(const Pose& fixed_from_moving) const {
    Members members;
    const double reach = support_in_cells * fixed_.cell;
    for (std::size_t m = 0; m < matches_.size(); ++m) {
      if ((fixed_at(m).point - fixed_from_moving * moving_at(m).point).squaredNorm() > reach * reach) continue;
      if (fixed_at(m).normal.dot(fixed_from_moving.linear() * moving_at(m).normal) < least_cosine) continue;
      members.push_back(m);
    }
    return members;
  }

  [[nodiscard]] int places(const Members& members) const {
    std::vector<std::size_t> moving;
    for (const std::size_t m : members) moving.push_back(matches_[m].moving);
    std::sort(moving.begin(), moving.end());
    return static_cast<int>(std::unique(moving.begin(), moving.end()) - moving.begin());
  }

  /// The pose that the members agree on, after those that it explains have had their say.
  [[nodiscard]] PoseHypothesis hypothesis(Members members) const {
    PoseHypothesis found;
    constexpr int rounds = 3;
    for (int round = 0; round < rounds && members.size() >= 3; ++round) {
      found.fixed_from_moving = fitted(members);
      members = supporters(found.fixed_from_moving);
      found.support = places(members);
    }
    return found;
  }

  /// RMS distance of the moving places between two poses, metres.
  [[nodiscard]] double distance(const Pose& a, const Pose& b) const {
    return distance_between(moving_.places, a, b, 200);
  }

 private:
  [[nodiscard]] const SurfaceSample& fixed_at(std::size_t m) const { return fixed_.places[matches_[m].fixed]; }
  [[nodiscard]] const SurfaceSample& moving_at(std::size_t m) const { return moving_.places[matches_[m].moving]; }

  const SurfaceFeatures& fixed_;
  const SurfaceFeatures& moving_;
  const std::vector<FeatureMatch>& matches_;
};

}  // namespace

void MatchConsensusOptions::validate() const {
  require(tolerance_in_cells > 0, "match consensus: tolerance_in_cells = ", tolerance_in_cells, ": must be positive");
  require(tolerance_of_cosines > 0, "match consensus: tolerance_of_cosines = ", tolerance_of_cosines,
          ": must be positive");
  require(most >= 1, "match consensus: most = ", most, ": must be at least 1");
}

bool are_consistent(const SurfaceFeatures& fixed, const SurfaceFeatures& moving, const FeatureMatch& a,
                    const FeatureMatch& b, const MatchConsensusOptions& options) {
  if (a.fixed == b.fixed || a.moving == b.moving) return false;
  const SurfaceSample &fixed_a = fixed.places[a.fixed], &fixed_b = fixed.places[b.fixed];
  const SurfaceSample &moving_a = moving.places[a.moving], &moving_b = moving.places[b.moving];
  const Vec3 in_fixed = fixed_b.point - fixed_a.point, in_moving = moving_b.point - moving_a.point;
  const double long_fixed = in_fixed.norm(), long_moving = in_moving.norm();
  if (std::min(long_fixed, long_moving) < nearest_in_cells * fixed.cell) return false;
  if (std::abs(long_fixed - long_moving) > options.tolerance_in_cells * fixed.cell) return false;
  const auto alike = [&](double cosine, double other) {
    return std::abs(cosine - other) <= options.tolerance_of_cosines;
  };
  return alike(fixed_a.normal.dot(fixed_b.normal), moving_a.normal.dot(moving_b.normal)) &&
         alike(fixed_a.normal.dot(in_fixed) / long_fixed, moving_a.normal.dot(in_moving) / long_moving) &&
         alike(fixed_b.normal.dot(in_fixed) / long_fixed, moving_b.normal.dot(in_moving) / long_moving);
}

std::vector<PoseHypothesis> pose_hypotheses(const SurfaceFeatures& fixed, const SurfaceFeatures& moving,
                                            const std::vector<FeatureMatch>& matches,
                                            const MatchConsensusOptions& options) {
  options.validate();
  const ConsistencyGraph graph(matches.size(), [&](std::size_t i, std::size_t j) {
    return are_consistent(fixed, moving, matches[i], matches[j], options);
  });
  const Consensus consensus(fixed, moving, matches);
  std::vector<PoseHypothesis> all(matches.size());
  parallel_for(matches.size(), [&](std::size_t i) {
    const std::size_t partner = graph.best_partner(i);
    if (partner != i) all[i] = consensus.hypothesis(graph.agreed(i, partner));
  });
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.support > b.support; });
  std::vector<PoseHypothesis> kept;
  for (const PoseHypothesis& hypothesis : all) {
    if (hypothesis.support < 3 || kept.size() == options.most) break;
    const auto is_twin = [&](const PoseHypothesis& other) {
      return consensus.distance(other.fixed_from_moving, hypothesis.fixed_from_moving) < twins_in_cells * fixed.cell;
    };
    if (std::none_of(kept.begin(), kept.end(), is_twin)) kept.push_back(hypothesis);
  }
  return kept;
}

}  // namespace vantage
