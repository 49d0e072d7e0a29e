// The same views by Embree: packets of eight rays against the faces between empty and non-empty voxels. Only the
// casting is timed, not the building of the tree. Its rays are in single precision, so that its voxels are not
// compared.
#include <embree3/rtcore.h>

#include <array>
#include <limits>
#include <unordered_set>

#include "fixtures.hpp"
#include "vantage/candidates/candidates.hpp"
#include "vantage/sensor/sight_line.hpp"

namespace vantage::bench {
namespace {

/// The exposed faces of a map as quadrangles, four corners each.
std::vector<float> face_corners(const VoxelMap& map) {
  std::vector<float> corners;
  const IndexBox& box = map.enclosure();
  for (int z = box.min.z(); z <= box.max.z(); ++z) {
    for (int y = box.min.y(); y <= box.max.y(); ++y) {
      for (int x = box.min.x(); x <= box.max.x(); ++x) {
        const Index3 voxel(x, y, z);
        if (map.label(voxel) == Label::empty) continue;
        for (int face = 0; face < 6; ++face) {
          const int axis = face / 2;
          const int side = face % 2;
          if (map.label(voxel + (2 * side - 1) * Index3::Unit(axis)) != Label::empty) continue;
          const Index3 u = Index3::Unit((axis + 1) % 3);
          const Index3 v = Index3::Unit((axis + 2) % 3);
          const Index3 first = voxel + side * Index3::Unit(axis);
          for (const Index3& corner : {Index3(first), Index3(first + u), Index3(first + u + v), Index3(first + v)}) {
            const Vec3 point = map.grid().corner(corner);
            for (int a = 0; a < 3; ++a) corners.push_back(static_cast<float>(point[a]));
          }
        }
      }
    }
  }
  return corners;
}

/// Embree's scene of those faces.
class Faces {
 public:
  explicit Faces(const VoxelMap& map) {
    const std::vector<float> corners = face_corners(map);
    const std::size_t vertices = corners.size() / 3;
    RTCGeometry quads = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
    void* points =
        rtcSetNewGeometryBuffer(quads, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices);
    std::copy(corners.begin(), corners.end(), static_cast<float*>(points));
    auto* indices = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(quads, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), vertices / 4));
    for (std::size_t i = 0; i < vertices; ++i) indices[i] = static_cast<unsigned>(i);
    rtcCommitGeometry(quads);
    rtcAttachGeometry(scene_, quads);
    rtcReleaseGeometry(quads);
    rtcCommitScene(scene_);
  }
  ~Faces() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Faces(const Faces&) = delete;
  Faces& operator=(const Faces&) = delete;

  [[nodiscard]] RTCScene scene() const { return scene_; }

 private:
  RTCDevice device_ = rtcNewDevice("threads=1");
  RTCScene scene_ = rtcNewScene(device_);
};

/// Faces that a view sees.
std::size_t faces_seen(RTCScene scene, const RangeCamera& camera, const View& view) {
  constexpr int lanes = 8;
  const RayGrid rays = camera.rays();
  alignas(32) std::array<int, lanes> valid{};
  std::unordered_set<unsigned> seen;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  const Vec3 origin = view.position();
  for (int row = 0; row < camera.resolution.rows; ++row) {
    for (int column = 0; column < camera.resolution.columns; column += lanes) {
      RTCRayHit8 packet;
      for (int i = 0; i < lanes; ++i) {
        valid[static_cast<std::size_t>(i)] = column + i < camera.resolution.columns ? -1 : 0;
        const Vec3 d = ray_direction(view.world_from_sensor.linear(), rays.x(column + i), rays.y(row));
        packet.ray.org_x[i] = static_cast<float>(origin.x());
        packet.ray.org_y[i] = static_cast<float>(origin.y());
        packet.ray.org_z[i] = static_cast<float>(origin.z());
        packet.ray.dir_x[i] = static_cast<float>(d.x());
        packet.ray.dir_y[i] = static_cast<float>(d.y());
        packet.ray.dir_z[i] = static_cast<float>(d.z());
        packet.ray.tnear[i] = 0;
        packet.ray.tfar[i] = static_cast<float>(camera.max_depth);
        packet.ray.time[i] = 0;
        packet.ray.mask[i] = std::numeric_limits<unsigned>::max();
        packet.ray.flags[i] = 0;
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect8(valid.data(), scene, &context, &packet);
      for (int i = 0; i < lanes; ++i) {
        if (packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) seen.insert(packet.hit.primID[i]);
      }
    }
  }
  return seen.size();
}

void evaluation_embree(benchmark::State& state) {
  const Faces faces(map_after_scans(static_cast<int>(state.range(0))));
  const auto side = static_cast<int>(state.range(1));
  const RangeCamera camera = paper_camera({side, side});
  const std::vector<View> views = view_sphere(80, 2, Vec3::Zero()).views;
  for (auto _ : state) {
    for (const View& view : views) benchmark::DoNotOptimize(faces_seen(faces.scene(), camera, view));
  }
}

BENCHMARK(evaluation_embree)->ArgNames({"scans", "side"})->Args({4, 320})->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace
}  // namespace vantage::bench
