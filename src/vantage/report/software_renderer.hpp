#pragma once

#include <optional>

#include "vantage/report/picture.hpp"
#include "vantage/report/picture_scene.hpp"
#include "vantage/report/sky_light.hpp"

namespace vantage {

/// From where a picture is taken: an upright pinhole camera.
struct PictureCamera {
  Vec3 eye{0, -3, 0};
  Vec3 target = Vec3::Zero();
  Vec3 up = Vec3::UnitZ();
  double aperture = radians(30);  // full, of the picture's height

  /// x right, y down, z forward. Where the camera looks along `up`, any direction serves as right.
  [[nodiscard]] Pose world_from_camera() const;
  /// Throws InputError naming the field.
  void validate() const;
};

/// The nearest camera that looks along -`direction` and has all points in a picture of the given shape (width over
/// height), with a margin. Throws InputError where there is no point or no direction.
[[nodiscard]] PictureCamera camera_around(std::span<const Vec3> points, const Vec3& direction, double shape,
                                          const Vec3& up = Vec3::UnitZ());
/// The same for everything in a scene.
[[nodiscard]] PictureCamera camera_around(const PictureScene& scene, const Vec3& direction, double shape,
                                          const Vec3& up = Vec3::UnitZ());

struct RenderOptions {
  int width = 960, height = 640;  // pixels
  int samples_per_side = 2;       // a pixel averages the square of this many samples
  Color background = color(0xFBFBFA);
  std::optional<double> floor = std::nullopt;  // height along `up` of a plane that catches shade; seen from above only

  void validate() const;
};

/// Draws the scene. One thread or many, the bytes are the same.
[[nodiscard]] Picture render(const PictureScene& scene, const PictureCamera& camera, const RenderOptions& options = {});
/// The same with the light of an earlier picture with the same solids.
[[nodiscard]] Picture render(const PictureScene& scene, const SkyLight& sky, const PictureCamera& camera,
                             const RenderOptions& options = {});

}  // namespace vantage
