#include "vantage/simulation/range_scanner.hpp"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "vantage/core/error.hpp"
#include "vantage/core/parallel.hpp"
#include "vantage/sensor/sight_line.hpp"
#include "vantage/simulation/mesh_tools.hpp"
#include "vantage/simulation/triangle_geometry.hpp"

namespace vantage {
namespace {

constexpr unsigned packet_size = 8;
// Embree works in single precision: room for its rounding wherever a limit is handed to it.
constexpr double float_margin = 1e-5;

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

void check_embree(RTCDevice device, const char* doing) {
  const RTCError code = rtcGetDeviceError(device);
  if (code != RTC_ERROR_NONE)
    throw Error(concat("Embree failed while ", doing, " (error ", static_cast<int>(code), ")"));
}

Device new_device() {
  // Where a ray passes a silhouette within 1e-7 m, Embree's rounding decides whether it hits. With wider instructions
  // it rounds otherwise; without them all processors since about 2015 agree.
  Device device(rtcNewDevice("max_isa=avx2"));
  if (!device) check_embree(nullptr, "starting");
  return device;
}

Scene new_scene(RTCDevice device, const TriangleMesh& mesh) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
  auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), mesh.triangles.size()));
  check_embree(device, "allocating the mesh");
  for (const Vec3& vertex : mesh.vertices) {
    for (const double coordinate : vertex) *vertices++ = static_cast<float>(coordinate);
  }
  for (const Index3& triangle : mesh.triangles) {
    for (const int corner : triangle) *corners++ = static_cast<unsigned>(corner);
  }
  rtcCommitGeometry(geometry);
  Scene scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometry(scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.get());
  check_embree(device, "building the scene");
  return scene;
}

/// The triangles around every vertex, in ascending order.
class TrianglesOfVertex {
 public:
  explicit TrianglesOfVertex(const TriangleMesh& mesh) : first_(mesh.vertices.size() + 1) {
    for (const Index3& triangle : mesh.triangles) {
      for (const int corner : triangle) ++first_[static_cast<std::size_t>(corner) + 1];
    }
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    triangles_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      for (const int corner : mesh.triangles[i]) {
        triangles_[next[static_cast<std::size_t>(corner)]++] = static_cast<int>(i);
      }
    }
  }

  template <class Visit>
  void for_each(int vertex, const Visit& visit) const {
    const auto v = static_cast<std::size_t>(vertex);
    for (std::size_t i = first_[v]; i < first_[v + 1]; ++i) visit(triangles_[i]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<int> triangles_;
};

/// The pixels first .. end-1 per axis.
struct PixelWindow {
  int first_column = 0, end_column = 0;
  int first_row = 0, end_row = 0;
};

/// The pixels in which a box can appear, with a margin for rounding: outside of them nothing needs a ray.
PixelWindow window_of(const Box3& box, const RayGrid& rays, const View& view) {
  const auto [columns, rows] = rays.resolution;
  const Pose sensor_from_world = view.world_from_sensor.inverse();
  Eigen::AlignedBox2d pixels;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner = sensor_from_world * box.corner(static_cast<Box3::CornerType>(i));
    // Beside and behind the sensor, projecting corners says nothing.
    if (corner.z() < 1e-3 * box.diagonal().norm()) return {0, columns, 0, rows};
    const Eigen::Array2d tangents(corner.x() / corner.z() - rays.x_middle, corner.y() / corner.z() - rays.y_middle);
    const Eigen::Array2d share = 0.5 * (tangents / Eigen::Array2d(rays.x_half, rays.y_half) + 1);
    pixels.extend((share * Eigen::Array2d(columns, rows)).matrix());
  }
  const auto bound = [](double pixel, int count) { return static_cast<int>(std::clamp<double>(pixel, 0, count)); };
  return {bound(pixels.min().x() - 2, columns), bound(pixels.max().x() + 2, columns), bound(pixels.min().y() - 2, rows),
          bound(pixels.max().y() + 2, rows)};
}

/// A triangle and the place of the ray that meets it.
struct Found {
  double t = std::numeric_limits<double>::infinity();
  int triangle = -1;
};

}  // namespace

struct RangeScanner::Impl {
  explicit Impl(TriangleMesh kept)
      : mesh(std::move(kept)),
        box(mesh.box()),
        device(new_device()),
        scene(new_scene(device.get(), mesh)),
        triangles_of_vertex(mesh) {}

  [[nodiscard]] TriangleCorners corners(int triangle) const {
    const auto i = static_cast<std::size_t>(triangle);
    return {mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)};
  }

  /// The triangle that the ray meets in double precision, given what Embree found. Near an edge these may differ; then
  /// the nearest one around the corners counts, the lowest index where several are equally near. Where none of them
  /// claims the ray (it passes a vertex or the silhouette within rounding), Embree's word stands, so that nothing
  /// leaks.
  [[nodiscard]] Found decide(const Found& by_embree, const Vec3& origin, const Vec3& direction) const {
    const std::optional<TriangleHit> direct = meet(corners(by_embree.triangle), origin, direction);
    if (direct && direct->is_clear) return {direct->t, by_embree.triangle};
    Found nearest;
    for (const int vertex : mesh.triangles[static_cast<std::size_t>(by_embree.triangle)]) {
      triangles_of_vertex.for_each(vertex, [&](int candidate) {
        const std::optional<TriangleHit> hit = meet(corners(candidate), origin, direction);
        if (!hit || hit->t > nearest.t) return;
        if (hit->t < nearest.t || candidate < nearest.triangle) nearest = {hit->t, candidate};
      });
    }
    return nearest.triangle < 0 ? by_embree : nearest;
  }

  /// The first triangle along one ray.
  [[nodiscard]] std::optional<Found> trace(const Vec3& origin, const Vec3& direction) const {
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(origin.x());
    query.ray.org_y = static_cast<float>(origin.y());
    query.ray.org_z = static_cast<float>(origin.z());
    query.ray.dir_x = static_cast<float>(direction.x());
    query.ray.dir_y = static_cast<float>(direction.y());
    query.ray.dir_z = static_cast<float>(direction.z());
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0U;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return decide({query.ray.tfar, static_cast<int>(query.hit.primID)}, origin, direction);
  }

  [[nodiscard]] float depth_of(const Found& found, const RangeCamera& camera, const Vec3& axis) const {
    const auto depth = static_cast<float>(found.t);
    if (static_cast<double>(depth) > camera.max_depth) return RangeImage::no_return;
    if (static_cast<double>(depth) < camera.min_depth) return RangeImage::unknown;
    if (camera.max_incidence) {
      const Vec3 normal = area_vector(mesh, static_cast<std::size_t>(found.triangle)).normalized();
      // Either side of a surface can be seen; the incidence is that of the side in view.
      if (std::abs(axis.dot(normal)) < std::cos(*camera.max_incidence)) return RangeImage::unknown;
    }
    return depth;
  }

  /// Fills the depths of pixels columns.first .. columns.second-1 of a row.
  void scan_row(const RangeCamera& camera, const View& view, int row, std::pair<int, int> columns, float* depth) const;

  TriangleMesh mesh;
  Box3 box;
  Device device;
  Scene scene;
  TrianglesOfVertex triangles_of_vertex;
};

void RangeScanner::Impl::scan_row(const RangeCamera& camera, const View& view, int row, std::pair<int, int> columns,
                                  float* depth) const {
  const RayGrid rays = camera.rays();
  const Mat3 rotation = view.world_from_sensor.linear();
  const Vec3 origin = view.position();
  const auto end = static_cast<unsigned>(columns.second);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  for (auto first = static_cast<unsigned>(columns.first); first < end; first += packet_size) {
    const unsigned count = std::min(packet_size, end - first);
    RTCRayHit8 packet;
    alignas(32) std::array<int, packet_size> valid{};
    std::array<Vec3, packet_size> directions;
    for (unsigned k = 0; k < packet_size; ++k) {
      valid[k] = k < count ? -1 : 0;
      directions[k] = ray_direction(rotation, rays.x(static_cast<int>(first + k)), rays.y(row));
      packet.ray.org_x[k] = static_cast<float>(origin.x());
      packet.ray.org_y[k] = static_cast<float>(origin.y());
      packet.ray.org_z[k] = static_cast<float>(origin.z());
      packet.ray.dir_x[k] = static_cast<float>(directions[k].x());
      packet.ray.dir_y[k] = static_cast<float>(directions[k].y());
      packet.ray.dir_z[k] = static_cast<float>(directions[k].z());
      packet.ray.tnear[k] = 0;
      packet.ray.tfar[k] = static_cast<float>(camera.max_depth * (1 + float_margin));
      packet.ray.time[k] = 0;
      packet.ray.mask[k] = ~0U;
      packet.ray.flags[k] = 0;
      packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid.data(), scene.get(), &context, &packet);
    for (unsigned k = 0; k < count; ++k) {
      if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
      const Found by_embree{packet.ray.tfar[k], static_cast<int>(packet.hit.primID[k])};
      depth[first + k] = depth_of(decide(by_embree, origin, directions[k]), camera, view.axis());
    }
  }
}

RangeScanner::RangeScanner(TriangleMesh mesh) {
  check_mesh(mesh, "range scanner");
  impl_ = std::make_unique<Impl>(std::move(mesh));
}
RangeScanner::~RangeScanner() = default;
RangeScanner::RangeScanner(RangeScanner&&) noexcept = default;
RangeScanner& RangeScanner::operator=(RangeScanner&&) noexcept = default;

const TriangleMesh& RangeScanner::mesh() const { return impl_->mesh; }

RangeImage RangeScanner::scan(const RangeCamera& camera, const View& view) const {
  camera.validate();
  require(view.world_from_sensor.matrix().allFinite(),
          "scan: the view's pose has an entry that is not a finite number");
  const auto columns = static_cast<std::size_t>(camera.resolution.columns);
  const auto rows = static_cast<std::size_t>(camera.resolution.rows);
  RangeImage image{camera, std::vector<float>(columns * rows, RangeImage::no_return)};
  const PixelWindow window = window_of(impl_->box, camera.rays(), view);
  parallel_for(static_cast<std::size_t>(std::max(0, window.end_row - window.first_row)), [&](std::size_t i) {
    const int row = window.first_row + static_cast<int>(i);
    impl_->scan_row(camera, view, row, {window.first_column, window.end_column},
                    image.depth.data() + static_cast<std::size_t>(row) * columns);
  });
  return image;
}

std::optional<SurfaceHit> RangeScanner::cast(const Vec3& origin, const Vec3& direction) const {
  require(origin.allFinite() && direction.allFinite() && direction.norm() > 0, "cast: origin (", origin.transpose(),
          "), direction (", direction.transpose(), "): must be finite and the direction not zero");
  const auto found = impl_->trace(origin, direction);
  if (!found) return std::nullopt;
  const Vec3 normal = area_vector(impl_->mesh, static_cast<std::size_t>(found->triangle)).normalized();
  return SurfaceHit{found->t, origin + found->t * direction, normal, found->triangle};
}

double RangeScanner::distance(const Vec3& point) const {
  require(point.allFinite(), "distance: the point (", point.transpose(), ") must be finite");
  struct Nearest {
    const Impl* impl;
    Vec3 point;
    double squared = std::numeric_limits<double>::infinity();
  } nearest{impl_.get(), point};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z()), 0,
                      std::numeric_limits<float>::infinity()};
  // Embree only narrows the search, with a margin; the least distance in double precision counts.
  const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
    auto& best = *static_cast<Nearest*>(arguments->userPtr);
    const TriangleCorners corners = best.impl->corners(static_cast<int>(arguments->primID));
    const double squared = (closest_point(corners, best.point) - best.point).squaredNorm();
    if (!(squared < best.squared)) return false;
    best.squared = squared;
    const auto radius = static_cast<float>(std::sqrt(squared) + float_margin * (1 + best.point.norm()));
    if (!(radius < arguments->query->radius)) return false;
    arguments->query->radius = radius;
    return true;
  };
  rtcPointQuery(impl_->scene.get(), &query, &context, visit, &nearest);
  return std::sqrt(nearest.squared);
}

}  // namespace vantage
