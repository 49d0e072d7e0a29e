#pragma once

#include <vector>

#include "vantage/report/picture_scene.hpp"
#include "vantage/report/rasterise.hpp"

namespace vantage {

/// How much of the light from all around reaches a point among the solids of a scene: one orthographic shadow map per
/// direction, filled once and used by every picture of the same solids. Gives soft shade in hollows and under things.
class SkyLight {
 public:
  struct Options {
    int directions = 48;   // evenly over the sphere
    int resolution = 208;  // texels per side of a shadow map

    void validate() const;
  };

  /// The solids of `scene` are copied into the maps: the scene may change or go afterwards.
  explicit SkyLight(const PictureScene& scene, const Options& options);
  explicit SkyLight(const PictureScene& scene) : SkyLight(scene, Options{}) {}

  /// Colour of the light from each direction, in linear red, green, blue.
  struct Lamps {
    std::vector<Vec3f> power;  // one per direction
  };
  /// A bright lamp over the left shoulder of somebody who looks from `eye_from_world` and a dim sky that is brighter
  /// above. A white surface that faces the lamp freely has about the value 1.
  [[nodiscard]] Lamps lamps(const Pose& world_from_eye, const Vec3& up) const;
  /// Light that arrives at a point of the surface with this unit normal.
  [[nodiscard]] Vec3f arriving(const Vec3f& point, const Vec3f& normal, const Lamps& lamps) const;
  /// The same without any solid in the way.
  [[nodiscard]] Vec3f unobstructed(const Vec3f& normal, const Lamps& lamps) const;

  [[nodiscard]] const Vec3f& center() const { return center_; }
  /// Of the ball around all solids; 0 where there are none.
  [[nodiscard]] float radius() const { return radius_; }

 private:
  static constexpr int most_directions = 256;
  /// One number per direction, on the stack.
  using PerDirection = Eigen::Array<float, Eigen::Dynamic, 1, 0, most_directions, 1>;
  /// The product of each direction's row with a vector.
  struct Rows {
    PerDirection x, y, z;

    [[nodiscard]] Vec3f row(Eigen::Index k) const { return {x[k], y[k], z[k]}; }
    [[nodiscard]] PerDirection times(const Vec3f& v) const { return x * v.x() + y * v.y() + z * v.z(); }
  };
  [[nodiscard]] raster::Corner on_map(Eigen::Index direction, const Vec3f& offset) const;
  [[nodiscard]] float free_share(Eigen::Index direction, const raster::Corner& place) const;

  Vec3f center_ = Vec3f::Zero();
  float radius_ = 0;
  int resolution_ = 0;
  Rows towards_light_;         // unit vectors
  Rows column_, row_;          // across the light, in texels per metre
  std::vector<float> height_;  // per direction and texel: along the light, of the solid nearest to it
};

}  // namespace vantage
