#include "vantage/report/sky_light.hpp"

#include <cmath>
#include <numbers>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"

namespace vantage {
namespace {

constexpr float nothing = -1e30F;

/// Directions spread evenly over the sphere (Fibonacci lattice).
Vec3 spread_direction(int index, int count) {
  const double z = 1 - (2.0 * index + 1) / count;
  const double angle = index * std::numbers::pi * (3 - std::sqrt(5.0));
  const double across = std::sqrt(1 - z * z);
  return {across * std::cos(angle), across * std::sin(angle), z};
}

}  // namespace

void SkyLight::Options::validate() const {
  require(directions >= 8 && directions <= most_directions, "sky light directions = ", directions, ": must be 8 to ",
          most_directions);
  require(resolution >= 8 && resolution <= 4096, "sky light resolution = ", resolution, ": must be 8 to 4096 texels");
}

SkyLight::SkyLight(const PictureScene& scene, const Options& options) : resolution_(options.resolution) {
  options.validate();
  const Box3 box = scene.solid_box();
  if (!box.isEmpty()) {
    center_ = box.center().cast<float>();
    radius_ = static_cast<float>(box.diagonal().norm() / 2 + 1e-6);
  }
  const int count = options.directions;
  for (Rows* rows : {&towards_light_, &column_, &row_})
    for (PerDirection* part : {&rows->x, &rows->y, &rows->z}) part->resize(count);
  const float texels_per_metre = radius_ > 0 ? static_cast<float>(resolution_) / (2 * radius_) : 0;
  const auto set = [](Rows& rows, Eigen::Index k, const Vec3f& value) {
    rows.x[k] = value.x();
    rows.y[k] = value.y();
    rows.z[k] = value.z();
  };
  for (Eigen::Index k = 0; k < count; ++k) {
    const Vec3 direction = spread_direction(static_cast<int>(k), count);
    const Vec3 across = direction.unitOrthogonal();
    set(towards_light_, k, direction.cast<float>());
    set(column_, k, texels_per_metre * across.cast<float>());
    set(row_, k, texels_per_metre * direction.cross(across).cast<float>());
  }
  if (radius_ == 0) return;

  std::vector<std::array<Vec3f, 3>> solids;  // relative to the center
  for (const PictureScene::Facet& facet : scene.facets)
    if (facet.finish != PictureScene::Finish::marker)
      solids.push_back({facet.corner[0] - center_, facet.corner[1] - center_, facet.corner[2] - center_});
  const raster::Window window{0, 0, resolution_, resolution_};
  const std::size_t texels = static_cast<std::size_t>(resolution_) * static_cast<std::size_t>(resolution_);
  height_.assign(texels * static_cast<std::size_t>(count), nothing);
  parallel_for(static_cast<std::size_t>(count), [&](std::size_t number) {
    const auto k = static_cast<Eigen::Index>(number);
    float* const map = height_.data() + texels * number;
    const auto raise = [&](int column, int row, float height) {
      float& stored =
          map[static_cast<std::size_t>(row) * static_cast<std::size_t>(resolution_) + static_cast<std::size_t>(column)];
      stored = std::max(stored, height);
    };
    for (const auto& corner : solids)
      raster::fill({on_map(k, corner[0]), on_map(k, corner[1]), on_map(k, corner[2])}, window, raise);
    for (const PictureScene::Disc& disc : scene.discs) {
      const raster::Corner middle = on_map(k, disc.center - center_);
      raise(std::clamp(static_cast<int>(middle.x), 0, resolution_ - 1),
            std::clamp(static_cast<int>(middle.y), 0, resolution_ - 1), middle.nearness);
    }
  });
}

raster::Corner SkyLight::on_map(Eigen::Index direction, const Vec3f& offset) const {
  const float middle = static_cast<float>(resolution_) / 2;
  return {column_.row(direction).dot(offset) + middle, row_.row(direction).dot(offset) + middle,
          towards_light_.row(direction).dot(offset)};
}

SkyLight::Lamps SkyLight::lamps(const Pose& world_from_eye, const Vec3& up) const {
  const Mat3 axes = world_from_eye.linear();
  const Vec3 lamp = (-0.55 * axes.col(0) - 0.75 * axes.col(1) - 0.75 * axes.col(2)).normalized();
  const Vec3f warm(1.0F, 0.965F, 0.91F), cool(0.90F, 0.95F, 1.0F);
  Lamps lamps;
  double lamp_sum = 0, sky_sum = 0;
  std::vector<double> lamp_share, sky_share;
  for (Eigen::Index k = 0; k < towards_light_.x.size(); ++k) {
    const Vec3 direction = towards_light_.row(k).cast<double>();
    lamp_share.push_back(std::pow(std::max(0.0, direction.dot(lamp)), 3));
    sky_share.push_back(0.65 + 0.35 * direction.dot(up.normalized()));
    lamp_sum += lamp_share.back() * std::max(0.0, direction.dot(lamp));
    sky_sum += sky_share.back() * std::max(0.0, direction.dot(lamp));
  }
  for (std::size_t k = 0; k < lamp_share.size(); ++k)
    lamps.power.push_back(static_cast<float>(0.72 * lamp_share[k] / lamp_sum) * warm +
                          static_cast<float>(0.50 * sky_share[k] / sky_sum) * cool);
  return lamps;
}

float SkyLight::free_share(Eigen::Index direction, const raster::Corner& place) const {
  const float x = place.x - 0.5F, y = place.y - 0.5F, limit = static_cast<float>(resolution_ - 1);
  if (!(x >= 0 && y >= 0 && x < limit && y < limit)) return 1;
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const auto side = static_cast<std::size_t>(resolution_);
  const float* texel = height_.data() +
                       side * (side * static_cast<std::size_t>(direction) + static_cast<std::size_t>(row)) +
                       static_cast<std::size_t>(column);
  const auto free = [&](const float* at) { return *at > place.nearness ? 0.0F : 1.0F; };
  const float right = x - static_cast<float>(column), below = y - static_cast<float>(row);
  const float* next_row = texel + resolution_;
  return (1 - below) * ((1 - right) * free(texel) + right * free(texel + 1)) +
         below * ((1 - right) * free(next_row) + right * free(next_row + 1));
}

Vec3f SkyLight::arriving(const Vec3f& point, const Vec3f& normal, const Lamps& lamps) const {
  if (radius_ == 0) return unobstructed(normal, lamps);
  // Off the surface, and towards the light, by about a texel, or the surface would shade itself.
  const float texel = 2 * radius_ / static_cast<float>(resolution_);
  const Vec3f offset = point + 1.25F * texel * normal - center_;
  const PerDirection cosine = towards_light_.times(normal);
  const PerDirection height = towards_light_.times(offset) + 0.75F * texel;
  const float middle = static_cast<float>(resolution_) / 2;
  const PerDirection x = column_.times(offset) + middle, y = row_.times(offset) + middle;
  Vec3f sum = Vec3f::Zero();
  for (Eigen::Index k = 0; k < cosine.size(); ++k)
    if (cosine[k] > 0)
      sum += cosine[k] * free_share(k, {x[k], y[k], height[k]}) * lamps.power[static_cast<std::size_t>(k)];
  return sum;
}

Vec3f SkyLight::unobstructed(const Vec3f& normal, const Lamps& lamps) const {
  const PerDirection cosine = towards_light_.times(normal);
  Vec3f sum = Vec3f::Zero();
  for (Eigen::Index k = 0; k < cosine.size(); ++k)
    sum += std::max(0.0F, cosine[k]) * lamps.power[static_cast<std::size_t>(k)];
  return sum;
}

}  // namespace vantage
