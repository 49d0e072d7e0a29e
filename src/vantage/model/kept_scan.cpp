#include "vantage/model/kept_scan.hpp"

#include <numeric>

namespace vantage {
namespace {

constexpr std::uint32_t shortest = 4;  // equal depths that are worth a stretch of their own

template <class T>
ScratchFile::Piece put(ScratchFile& file, const std::vector<T>& values) {
  return file.put(std::as_bytes(std::span(values)));
}

template <class T>
std::vector<T> got(const ScratchFile& file, const ScratchFile::Piece& piece) {
  std::vector<T> values(piece.size / sizeof(T));
  file.get(piece, std::as_writable_bytes(std::span(values)));
  return values;
}

}  // namespace

KeptScan::KeptScan(const Scan& scan, std::shared_ptr<ScratchFile> file) : file_(std::move(file)) {
  if (const auto* image = std::get_if<ImageScan>(&scan)) {
    const PackedImage small = packed(image->image);
    camera_ = small.camera;
    pieces_ = {put(*file_, small.stretches), put(*file_, small.depth)};
  } else {
    const auto& points = std::get<PointScan>(scan);
    pieces_ = {put(*file_, points.points), put(*file_, points.normals), put(*file_, points.origins)};
  }
}

Scan KeptScan::scan() const {
  if (camera_) {
    return scan_of(unpacked({*camera_, got<Stretch>(*file_, pieces_[0]), got<float>(*file_, pieces_[1])}));
  }
  PointScan points;
  points.points = got<Vec3>(*file_, pieces_[0]);
  points.normals = got<Vec3f>(*file_, pieces_[1]);
  points.origins = got<Vec3>(*file_, pieces_[2]);
  return points;
}

std::size_t KeptScan::bytes() const {
  return std::accumulate(pieces_.begin(), pieces_.end(), std::size_t{0},
                         [](std::size_t sum, const ScratchFile::Piece& piece) { return sum + piece.size; });
}

KeptScan::PackedImage KeptScan::packed(const RangeImage& image) {
  PackedImage result{image.camera, {}, {}};
  const std::vector<float>& depth = image.depth;
  for (std::size_t at = 0; at < depth.size();) {
    std::size_t end = at + 1;
    while (end < depth.size() && depth[end] == depth[at]) ++end;
    const auto count = static_cast<std::uint32_t>(end - at);
    const std::uint32_t is_equal = count >= shortest ? 1 : 0;
    if (is_equal != 0 || result.stretches.empty() || result.stretches.back().is_equal != 0) {
      result.stretches.push_back({0, is_equal});
    }
    result.stretches.back().count += count;
    result.depth.insert(result.depth.end(), is_equal != 0 ? 1 : count, depth[at]);
    at = end;
  }
  return result;
}

RangeImage KeptScan::unpacked(const PackedImage& image) {
  RangeImage result{image.camera, {}};
  result.depth.reserve(static_cast<std::size_t>(image.camera.resolution.rays()));
  auto next = image.depth.begin();
  for (const Stretch& stretch : image.stretches) {
    if (stretch.is_equal != 0) {
      result.depth.insert(result.depth.end(), stretch.count, *next++);
    } else {
      result.depth.insert(result.depth.end(), next, next + stretch.count);
      next += stretch.count;
    }
  }
  return result;
}

}  // namespace vantage
