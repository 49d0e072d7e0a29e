#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vantage {

/// The CRC-32 of the content, eight hexadecimal digits.
[[nodiscard]] std::string checksum_of(std::string_view content);
/// The content with a last line `crc32 XXXXXXXX`, by which unsealed() tells whether it is whole.
[[nodiscard]] std::string sealed(std::string_view content);
/// The content of what sealed() made. Throws InputError starting with `name` where it is cut off or changed.
[[nodiscard]] std::string_view unsealed(std::string_view bytes, const std::string& name);

/// Writes the sealed content aside, syncs it to the disk and renames it: once this returns the file is safe. Throws as
/// AtomicFile::commit does.
void write_sealed(const std::filesystem::path& path, std::string_view content);
/// The checksum at the end of a sealed file, which is not checked. Throws InputError where there is none.
[[nodiscard]] std::string seal_of_file(const std::filesystem::path& path);
/// Throws InputError where the file cannot be read or is not whole.
[[nodiscard]] std::string read_sealed(const std::filesystem::path& path);

}  // namespace vantage
