#include "vantage/map/kept_scan.hpp"

namespace vantage {
namespace {

constexpr std::uint32_t shortest = 4;  // equal depths that are worth a stretch of their own

}  // namespace

KeptScan::KeptScan(const Scan& scan) {
  if (const auto* image = std::get_if<ImageScan>(&scan)) {
    scan_ = packed(image->image);
  } else {
    scan_ = std::get<PointScan>(scan);
  }
}

Scan KeptScan::scan() const {
  if (const auto* image = std::get_if<PackedImage>(&scan_)) return scan_of(unpacked(*image));
  return std::get<PointScan>(scan_);
}

std::size_t KeptScan::bytes() const {
  if (const auto* image = std::get_if<PackedImage>(&scan_))
    return image->depth.size() * sizeof(float) + image->stretches.size() * sizeof(Stretch);
  const auto& points = std::get<PointScan>(scan_);
  return (points.points.size() + points.origins.size()) * sizeof(Vec3) + points.normals.size() * sizeof(Vec3f);
}

KeptScan::PackedImage KeptScan::packed(const RangeImage& image) {
  PackedImage result{image.camera, {}, {}};
  const std::vector<float>& depth = image.depth;
  for (std::size_t at = 0; at < depth.size();) {
    std::size_t end = at + 1;
    while (end < depth.size() && depth[end] == depth[at]) ++end;
    const auto count = static_cast<std::uint32_t>(end - at);
    const bool is_equal = count >= shortest;
    if (is_equal || result.stretches.empty() || result.stretches.back().is_equal) {
      result.stretches.push_back({0, is_equal});
    }
    result.stretches.back().count += count;
    result.depth.insert(result.depth.end(), is_equal ? 1 : count, depth[at]);
    at = end;
  }
  result.stretches.shrink_to_fit();
  result.depth.shrink_to_fit();
  return result;
}

RangeImage KeptScan::unpacked(const PackedImage& image) {
  RangeImage result{image.camera, {}};
  result.depth.reserve(static_cast<std::size_t>(image.camera.resolution.rays()));
  auto next = image.depth.begin();
  for (const Stretch& stretch : image.stretches) {
    if (stretch.is_equal) {
      result.depth.insert(result.depth.end(), stretch.count, *next++);
    } else {
      result.depth.insert(result.depth.end(), next, next + stretch.count);
      next += stretch.count;
    }
  }
  return result;
}

}  // namespace vantage
