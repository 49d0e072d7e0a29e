#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/visibility/visibility.hpp"

namespace vantage {

Visibility VisibilityEvaluator::see(const RangeCamera& camera, const View& view, Resolution resolution) const {
  return see_exactly(*map_, camera, view, resolution);
}

std::vector<Visibility> VisibilityEvaluator::see(const RangeCamera& camera, std::span<const View> views,
                                                 std::span<const Resolution> resolutions) const {
  require(resolutions.size() == 1 || resolutions.size() == views.size(), "see: ", resolutions.size(),
          " resolutions for ", views.size(), " views; must be one, or one per view");
  std::vector<Visibility> seen(views.size());
  parallel_for(views.size(),
               [&](std::size_t i) { seen[i] = see(camera, views[i], resolutions[resolutions.size() == 1 ? 0 : i]); });
  return seen;
}

}  // namespace vantage
