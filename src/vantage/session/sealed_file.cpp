#include "vantage/session/sealed_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <fstream>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {
namespace {

constexpr std::string_view seal_start = "\ncrc32 ";

std::string seal_of(std::string_view content) { return fmt::format("{}{}\n", seal_start, checksum_of(content)); }

constexpr std::size_t seal_size = 16;

}  // namespace

std::string checksum_of(std::string_view content) {
  return fmt::format("{:08x}", crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size()));
}

std::string sealed(std::string_view content) { return std::string(content) + seal_of(content); }

std::string_view unsealed(std::string_view bytes, const std::string& name) {
  require(bytes.size() >= seal_size, name, ": is cut off; it has no checksum");
  const std::string_view content = bytes.substr(0, bytes.size() - seal_size);
  require(bytes.substr(content.size()) == seal_of(content), name, ": is damaged; its checksum does not fit");
  return content;
}

void write_sealed(const std::filesystem::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.write(seal_of(content));
  file.commit();
}

std::string seal_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string seal(seal_size, '\0');
  file.seekg(-static_cast<std::streamoff>(seal_size), std::ios::end);
  file.read(seal.data(), static_cast<std::streamsize>(seal_size));
  require(file.good() && seal.starts_with(seal_start), path.string(), ": has no checksum");
  return seal.substr(seal_start.size(), 8);
}

std::string read_sealed(const std::filesystem::path& path) {
  std::string bytes = read_file(path);
  bytes.resize(unsealed(bytes, path.string()).size());
  return bytes;
}

}  // namespace vantage
