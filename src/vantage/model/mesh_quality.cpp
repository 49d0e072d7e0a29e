#include "vantage/model/mesh_quality.hpp"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace vantage {
namespace {

struct Piece {
  double sigma, area;
};

double quantile(const std::vector<Piece>& sorted, double total_area, double share) {
  double area = 0;
  for (const Piece& piece : sorted) {
    area += piece.area;
    if (area >= share * total_area) return piece.sigma;
  }
  return sorted.empty() ? 0 : sorted.back().sigma;
}

/// Every edge has a triangle on both sides.
bool is_closed(const TriangleMesh& mesh) {
  std::unordered_map<std::uint64_t, int> balance;  // of the edge's two directions
  balance.reserve(2 * mesh.triangles.size());
  for (const Index3& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto from = static_cast<std::uint64_t>(triangle[k]), to = static_cast<std::uint64_t>(triangle[(k + 1) % 3]);
      balance[std::min(from, to) << 32U | std::max(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second == 0; });
}

double enclosed_volume(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    six_volumes += mesh.corner(t, 0).dot(mesh.corner(t, 1).cross(mesh.corner(t, 2)));
  return six_volumes / 6;
}

}  // namespace

MeshQuality quality_of(const MeasuredMesh& measured, const std::optional<double>& wanted_sigma) {
  const TriangleMesh& mesh = measured.mesh;
  MeshQuality quality;
  quality.triangles = mesh.triangles.size();
  std::vector<Piece> seen;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = mesh.corner(t, 0);
    const double area = (mesh.corner(t, 1) - a).cross(mesh.corner(t, 2) - a).norm() / 2;
    if (!measured.is_cap.empty() && measured.is_cap[t] != 0) {
      quality.cap_area += area;
      continue;
    }
    quality.seen_area += area;
    if (measured.sigma.empty()) continue;
    double sigma = 0;
    for (const int vertex : mesh.triangles[t])
      sigma += static_cast<double>(measured.sigma[static_cast<std::size_t>(vertex)]) / 3;
    seen.push_back({sigma, area});
  }
  std::sort(seen.begin(), seen.end(),
            [](const Piece& a, const Piece& b) { return std::pair(a.sigma, a.area) < std::pair(b.sigma, b.area); });
  quality.median_sigma = quantile(seen, quality.seen_area, 0.5);
  quality.percentile_95_sigma = quantile(seen, quality.seen_area, 0.95);
  if (wanted_sigma) {
    quality.wanted_sigma = wanted_sigma;
    quality.accurate_area = 0;
    for (const Piece& piece : seen) *quality.accurate_area += piece.sigma <= *wanted_sigma ? piece.area : 0;
  }
  if (!mesh.triangles.empty() && is_closed(mesh)) quality.volume = enclosed_volume(mesh);
  return quality;
}

}  // namespace vantage
