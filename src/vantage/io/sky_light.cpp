#include "vantage/io/sky_light.hpp"

#include <cmath>
#include <numbers>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/io/rasterise.hpp"

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
  require(directions >= 8 && directions <= 4096, "sky light directions = ", directions, ": must be 8 to 4096");
  require(resolution >= 8 && resolution <= 4096, "sky light resolution = ", resolution, ": must be 8 to 4096 texels");
}

SkyLight::SkyLight(const PictureScene& scene, const Options& options) : resolution_(options.resolution) {
  options.validate();
  const Box3 box = scene.solid_box();
  if (!box.isEmpty()) {
    center_ = box.center().cast<float>();
    radius_ = static_cast<float>(box.diagonal().norm() / 2 + 1e-6);
    texels_per_metre_ = static_cast<float>(resolution_) / (2 * radius_);
  }
  maps_.resize(static_cast<std::size_t>(options.directions));
  const raster::Window window{0, 0, resolution_, resolution_};
  parallel_for(maps_.size(), [&](std::size_t k) {
    ShadowMap& map = maps_[k];
    const Vec3 direction = spread_direction(static_cast<int>(k), options.directions);
    map.towards_light = direction.cast<float>();
    map.u = direction.unitOrthogonal().cast<float>();
    map.v = map.towards_light.cross(map.u);
    if (radius_ == 0) return;
    map.height.assign(static_cast<std::size_t>(resolution_) * static_cast<std::size_t>(resolution_), nothing);
    const auto on_map = [&](const Vec3f& point) {
      const Vec3f offset = point - center_;
      return raster::Corner{(offset.dot(map.u) + radius_) * texels_per_metre_,
                            (offset.dot(map.v) + radius_) * texels_per_metre_, offset.dot(map.towards_light)};
    };
    const auto raise = [&](int column, int row, float height) {
      float& stored = map.height[static_cast<std::size_t>(row) * static_cast<std::size_t>(resolution_) +
                                 static_cast<std::size_t>(column)];
      stored = std::max(stored, height);
    };
    for (const PictureScene::Facet& facet : scene.facets)
      if (facet.finish != PictureScene::Finish::marker)
        raster::fill({on_map(facet.corner[0]), on_map(facet.corner[1]), on_map(facet.corner[2])}, window, raise);
    for (const PictureScene::Disc& disc : scene.discs) {
      const raster::Corner middle = on_map(disc.center);
      raise(std::clamp(static_cast<int>(middle.x), 0, resolution_ - 1),
            std::clamp(static_cast<int>(middle.y), 0, resolution_ - 1), middle.nearness);
    }
  });
}

SkyLight::Lamps SkyLight::lamps(const Pose& world_from_eye, const Vec3& up) const {
  const Mat3 axes = world_from_eye.linear();
  const Vec3 lamp = (-0.55 * axes.col(0) - 0.75 * axes.col(1) - 0.75 * axes.col(2)).normalized();
  const Vec3f warm(1.0F, 0.965F, 0.91F), cool(0.90F, 0.95F, 1.0F);
  Lamps lamps;
  double lamp_sum = 0, sky_sum = 0;
  std::vector<double> lamp_share, sky_share;
  for (const ShadowMap& map : maps_) {
    const Vec3 direction = map.towards_light.cast<double>();
    lamp_share.push_back(std::pow(std::max(0.0, direction.dot(lamp)), 6));
    sky_share.push_back(0.65 + 0.35 * direction.dot(up.normalized()));
    lamp_sum += lamp_share.back() * std::max(0.0, direction.dot(lamp));
    sky_sum += sky_share.back() * std::max(0.0, direction.dot(lamp));
  }
  for (std::size_t k = 0; k < maps_.size(); ++k)
    lamps.power.push_back(static_cast<float>(0.72 * lamp_share[k] / lamp_sum) * warm +
                          static_cast<float>(0.50 * sky_share[k] / sky_sum) * cool);
  return lamps;
}

float SkyLight::free_share(const ShadowMap& map, const Vec3f& point) const {
  const Vec3f offset = point - center_;
  const float x = (offset.dot(map.u) + radius_) * texels_per_metre_ - 0.5F;
  const float y = (offset.dot(map.v) + radius_) * texels_per_metre_ - 0.5F;
  const auto limit = static_cast<float>(resolution_ - 1);
  if (!(x >= 0 && y >= 0 && x < limit && y < limit)) return 1;
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float height = offset.dot(map.towards_light) + 0.75F / texels_per_metre_;
  const float* texel = map.height.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(resolution_) +
                       static_cast<std::size_t>(column);
  const auto free = [&](const float* at) { return *at > height ? 0.0F : 1.0F; };
  const float right = x - static_cast<float>(column), below = y - static_cast<float>(row);
  const float* next_row = texel + resolution_;
  return (1 - below) * ((1 - right) * free(texel) + right * free(texel + 1)) +
         below * ((1 - right) * free(next_row) + right * free(next_row + 1));
}

Vec3f SkyLight::arriving(const Vec3f& point, const Vec3f& normal, const Lamps& lamps) const {
  if (radius_ == 0) return unobstructed(normal, lamps);
  // Off the surface by more than a texel, or it would shade itself.
  const Vec3f raised = point + 1.25F / texels_per_metre_ * normal;
  Vec3f sum = Vec3f::Zero();
  for (std::size_t k = 0; k < maps_.size(); ++k) {
    const float cosine = normal.dot(maps_[k].towards_light);
    if (cosine > 0) sum += cosine * free_share(maps_[k], raised) * lamps.power[k];
  }
  return sum;
}

Vec3f SkyLight::unobstructed(const Vec3f& normal, const Lamps& lamps) const {
  Vec3f sum = Vec3f::Zero();
  for (std::size_t k = 0; k < maps_.size(); ++k)
    sum += std::max(0.0F, normal.dot(maps_[k].towards_light)) * lamps.power[k];
  return sum;
}

}  // namespace vantage
