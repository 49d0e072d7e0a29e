#pragma once

#include <memory>
#include <optional>

#include "vantage/core/triangle_mesh.hpp"
#include "vantage/sensor/range_image.hpp"
#include "vantage/sensor/view.hpp"

namespace vantage {

/// Where a ray meets a surface: at origin + t*direction.
struct SurfaceHit {
  double t = 0;
  Vec3 point;
  Vec3 normal;  // unit, of the triangle: outwards for a closed mesh
  int triangle = -1;
};

/// A noise-free range camera in front of a triangle mesh. Embree finds the triangle; which triangle exactly and how far
/// away is then decided in double precision, so that depths do not depend on the processor's instructions (it needs
/// AVX2 for the very same silhouettes). Rays do not leak through shared edges. Safe to use from several threads.
class RangeScanner {
 public:
  /// Keeps the mesh. Throws InputError as check_mesh does.
  explicit RangeScanner(TriangleMesh mesh);
  ~RangeScanner();
  RangeScanner(RangeScanner&&) noexcept;
  RangeScanner& operator=(RangeScanner&&) noexcept;

  [[nodiscard]] const TriangleMesh& mesh() const;

  /// The range image that the camera takes from the view. no_return: nothing within max_depth. unknown: the surface is
  /// nearer than min_depth, or turned from the sensor's axis by more than max_incidence: it hides what is behind it, so
  /// these pixels must not empty space. Throws InputError as RangeCamera::validate does.
  [[nodiscard]] RangeImage scan(const RangeCamera& camera, const View& view) const;

  /// The first surface along a ray. Throws InputError where the direction is zero or not finite.
  [[nodiscard]] std::optional<SurfaceHit> cast(const Vec3& origin, const Vec3& direction) const;

  /// Distance to the nearest point of the surface in metres.
  [[nodiscard]] double distance(const Vec3& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vantage
