#pragma once

#include "vantage/report/rasterise.hpp"
#include "vantage/report/software_renderer.hpp"

namespace vantage {

/// The projection of a picture. Places on the screen are in samples, x right and y down from the top left corner;
/// nearness is one over the depth along the viewing axis.
class Screen {
 public:
  Screen(const PictureCamera& camera, int width, int height)
      : pose_(camera.world_from_camera()),
        camera_from_world_(pose_.inverse()),
        focal_(height / 2.0 / std::tan(camera.aperture / 2)),
        middle_(width / 2.0, height / 2.0),
        right_((pose_.linear().col(0) / focal_).cast<float>()),
        down_((pose_.linear().col(1) / focal_).cast<float>()),
        corner_((pose_.linear() * Vec3(-middle_.x() / focal_, -middle_.y() / focal_, 1)).cast<float>()) {}

  [[nodiscard]] const Pose& world_from_camera() const { return pose_; }
  [[nodiscard]] Vec3f eye() const { return pose_.translation().cast<float>(); }
  [[nodiscard]] double focal() const { return focal_; }
  [[nodiscard]] Vec3 in_camera(const Vec3& point) const { return camera_from_world_ * point; }
  [[nodiscard]] Vec3 in_camera(const Vec3f& point) const { return camera_from_world_ * point.cast<double>(); }
  /// The depth of `in_camera` must be positive.
  [[nodiscard]] raster::Corner project(const Vec3& in_camera) const {
    return {static_cast<float>(middle_.x() + focal_ * in_camera.x() / in_camera.z()),
            static_cast<float>(middle_.y() + focal_ * in_camera.y() / in_camera.z()),
            static_cast<float>(1 / in_camera.z())};
  }
  /// From the eye through a place on the screen, of depth 1, in world axes.
  [[nodiscard]] Vec3f ray(float x, float y) const { return corner_ + x * right_ + y * down_; }

 private:
  Pose pose_, camera_from_world_;
  double focal_;  // samples
  Eigen::Vector2d middle_;
  Vec3f right_, down_, corner_;
};

}  // namespace vantage
