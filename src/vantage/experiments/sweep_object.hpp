#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "vantage/core/triangle_mesh.hpp"
#include "vantage/simulation/point_coverage.hpp"
#include "vantage/simulation/simulate.hpp"

namespace vantage {

/// An object that runs of a sweep scan. The simulator of it is built when the first run asks for it, so that a sweep
/// that resumes, or a rank that gets no run of it, does not pay for it.
class SweepObject {
 public:
  /// `size`: metres, largest side. `source`: where the mesh is from, for people.
  SweepObject(std::string name, TriangleMesh mesh, double size, std::string source = "");

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& source() const { return source_; }
  /// 16 hexadecimal digits that change with any vertex, triangle or size.
  [[nodiscard]] const std::string& digest() const { return digest_; }
  [[nodiscard]] double size() const { return size_; }
  /// As it was given, not scaled.
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }

  /// The object in front of the scanner only, without what can be seen of it.
  [[nodiscard]] std::shared_ptr<const RangeScanner> scanner(const ReconstructOptions& options) const;
  /// The object in the simulator with what the candidates and camera of these options can see of it; shared by all runs
  /// that agree in those. Any thread may ask.
  [[nodiscard]] std::shared_ptr<const SimulatedObject> simulated(const ReconstructOptions& options) const;
  /// The samples of `metric` on the object in its place, those that count among them; shared like `simulated`.
  [[nodiscard]] std::shared_ptr<const PointCoverage> nothing_scanned(const ReconstructOptions& options,
                                                                     const PointMetric& metric) const;

 private:
  std::string name_;
  TriangleMesh mesh_;
  double size_;
  std::string source_, digest_;
  mutable std::mutex building_;
  mutable std::map<std::string, std::shared_ptr<const SimulatedObject>> built_;
  mutable std::map<std::string, std::shared_ptr<const PointCoverage>> samples_;
};

/// 64 bits of the bytes (FNV-1a) as 16 hexadecimal digits: tells files apart, no protection against malice.
[[nodiscard]] std::string digest_of(std::string_view bytes);

}  // namespace vantage
