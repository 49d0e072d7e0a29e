#include "vantage/experiments/sweep_object.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include "vantage/options/options.hpp"

namespace vantage {
namespace {

template <class Vector>
void append_bytes(std::string& bytes, const Vector& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()),
               sizeof(values[0]) * static_cast<std::size_t>(values.size()));
}

std::string mesh_digest(const TriangleMesh& mesh, double size) {
  std::string bytes = fmt::format("{} {} {} ", size, mesh.vertices.size(), mesh.triangles.size());
  for (const Vec3& vertex : mesh.vertices) append_bytes(bytes, vertex);
  for (const Index3& triangle : mesh.triangles) append_bytes(bytes, triangle);
  return digest_of(bytes);
}

/// The options that decide what can be seen of an object.
std::string truth_key(ReconstructOptions options) {
  std::string key;
  for (const OptionField& field :
       fields_named(option_fields(options),
                    {"voxel", "scene", "enclosure", "center", "camera", "depth-range", "max-incidence", "candidates"}))
    key += fmt::format("{} = {}\n", field.name, field.text());
  return key;
}

}  // namespace

std::string digest_of(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  return fmt::format("{:016x}", hash);
}

SweepObject::SweepObject(std::string name, TriangleMesh mesh, double size, std::string source)
    : name_(std::move(name)),
      mesh_(std::move(mesh)),
      size_(size),
      source_(std::move(source)),
      digest_(mesh_digest(mesh_, size_)) {}

std::shared_ptr<const RangeScanner> SweepObject::scanner(const ReconstructOptions& options) const {
  TriangleMesh placed = centred_and_scaled(mesh_, size_);
  for (Vec3& vertex : placed.vertices) vertex += options.center;
  return std::make_shared<const RangeScanner>(std::move(placed));
}

std::shared_ptr<const SimulatedObject> SweepObject::simulated(const ReconstructOptions& options) const {
  const std::string key = truth_key(options);
  const std::lock_guard lock(building_);
  std::shared_ptr<const SimulatedObject>& object = built_[key];
  // Isolated: while this thread waits for its own loops it must not take up another run, which could ask for this lock.
  if (!object) {
    tbb::this_task_arena::isolate([&] { object = std::make_shared<const SimulatedObject>(mesh_, size_, options); });
  }
  return object;
}

std::shared_ptr<const PointCoverage> SweepObject::nothing_scanned(const ReconstructOptions& options,
                                                                  const PointMetric& metric) const {
  const std::shared_ptr<const SimulatedObject> object = metric.reachable ? simulated(options) : nullptr;
  const std::shared_ptr<const RangeScanner> alone = object ? nullptr : scanner(options);
  const RangeScanner& scanner = object ? object->scanner() : *alone;
  const std::string key =
      fmt::format("{}{} {} {}", truth_key(options), metric.samples, metric.tolerance, metric.reachable);
  const std::lock_guard lock(building_);
  std::shared_ptr<const PointCoverage>& samples = samples_[key];
  if (samples) return samples;
  tbb::this_task_arena::isolate([&] {
    PointCoverage none(scanner.mesh(), metric);
    if (metric.reachable) {
      PointCoverage reachable = none;
      for (const View& view : options.candidate_views().views) {
        const RangeImage image = scanner.scan(options.range_camera(), view);
        const RayGrid rays = image.camera.rays();
        std::vector<Vec3> points;
        for (int row = 0; row < image.camera.resolution.rows; ++row) {
          for (int column = 0; column < image.camera.resolution.columns; ++column) {
            const float depth = image.at(column, row);
            if (!RangeImage::is_hit(depth)) continue;
            points.emplace_back(view.world_from_sensor *
                                point_in_sensor(rays, column, row, static_cast<double>(depth)));
          }
        }
        reachable.add(points);
      }
      none.count_only(reachable);
    }
    samples = std::make_shared<const PointCoverage>(std::move(none));
  });
  return samples;
}

}  // namespace vantage
