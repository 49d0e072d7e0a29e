#include "vantage/session/sealed_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include "vantage/core/error.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage {
namespace {

std::string seal_of(std::string_view content) {
  const auto sum = crc32_z(0, reinterpret_cast<const Bytef*>(content.data()), content.size());
  return fmt::format("\ncrc32 {:08x}\n", sum);
}

constexpr std::size_t seal_size = 16;

}  // namespace

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

std::string read_sealed(const std::filesystem::path& path) {
  std::string bytes = read_file(path);
  bytes.resize(unsealed(bytes, path.string()).size());
  return bytes;
}

}  // namespace vantage
