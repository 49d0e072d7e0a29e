#pragma once

#include <vector>

#include "vantage/io/picture_scene.hpp"

namespace vantage {

/// How much of the light from all around reaches a point among the solids of a scene: one orthographic shadow map per
/// direction, filled once and used by every picture of the same solids. Gives soft shade in hollows and under things.
class SkyLight {
 public:
  struct Options {
    int directions = 64;   // evenly over the sphere
    int resolution = 224;  // texels per side of a shadow map

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
  struct ShadowMap {
    Vec3f towards_light, u, v;
    std::vector<float> height;  // along towards_light, of the solid nearest to the light
  };
  [[nodiscard]] float free_share(const ShadowMap& map, const Vec3f& point) const;

  Vec3f center_ = Vec3f::Zero();
  float radius_ = 0;
  float texels_per_metre_ = 0;
  int resolution_ = 0;
  std::vector<ShadowMap> maps_;
};

}  // namespace vantage
