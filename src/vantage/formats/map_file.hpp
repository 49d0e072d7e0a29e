#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "vantage/map/voxel_map.hpp"

namespace vantage {

/// Writes `NAME.nrrd` (labels of the whole scene, or of the enclosure where the scene has more than 2^27 voxels:
/// outside of it all are empty, and a file must not be as large as a scene may be) and `NAME.ply` beside it (centre,
/// normal and quality of each occupied voxel, float32) as the spec's section 10 says; `path` must end in .nrrd. Each
/// file is replaced atomically. Throws Error where a path is not writable or the disk is full.
void write_map(const VoxelMap& map, const std::filesystem::path& path);

/// Reads what write_map() writes, and NRRD files of other programs with raw uint8 labels. Without the key `enclosure`
/// the whole scene is the enclosure. The surface file may be missing only where no voxel is occupied. Throws InputError
/// naming the file, the place and what would be right: wrong sizes, labels or lengths, labels other than empty outside
/// the enclosure, an occupied voxel without its vertex or the other way round, a normal not of length 1 or 0, a quality
/// not in [0, 1].
[[nodiscard]] VoxelMap read_map(const std::filesystem::path& path);

/// One of the two files in memory and what errors call it.
struct NamedBytes {
  std::string name;
  std::string_view bytes;
};
[[nodiscard]] VoxelMap parse_map(const NamedBytes& labels, const std::optional<NamedBytes>& surface);

}  // namespace vantage
