#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "vantage/core/geometry.hpp"

namespace vantage {

/// A cell of a boundless cubic lattice.
struct LatticeCell {
  std::int64_t x = 0, y = 0, z = 0;

  [[nodiscard]] LatticeCell moved(int dx, int dy, int dz) const { return {x + dx, y + dy, z + dz}; }
  bool operator==(const LatticeCell&) const = default;
};

struct LatticeCellHash {
  [[nodiscard]] std::size_t operator()(const LatticeCell& cell) const {
    auto hash = static_cast<std::uint64_t>(cell.x) * 0x9e3779b97f4a7c15ULL;
    hash = (hash ^ (hash >> 29)) + static_cast<std::uint64_t>(cell.y) * 0xbf58476d1ce4e5b9ULL;
    hash = (hash ^ (hash >> 31)) + static_cast<std::uint64_t>(cell.z) * 0x94d049bb133111ebULL;
    return static_cast<std::size_t>(hash ^ (hash >> 30));
  }
};

/// Cells of side `length` metres, one corner of cell (0, 0, 0) at the origin.
struct Lattice {
  double length = 1;

  [[nodiscard]] LatticeCell cell(const Vec3& point) const {
    const auto index = [this](double value) { return static_cast<std::int64_t>(std::floor(value / length)); };
    return {index(point.x()), index(point.y()), index(point.z())};
  }
  [[nodiscard]] Vec3 corner(const LatticeCell& cell) const {
    return length * Vec3(static_cast<double>(cell.x), static_cast<double>(cell.y), static_cast<double>(cell.z));
  }
};

}  // namespace vantage
