#include <cmath>
#include <nlohmann/json.hpp>

#include "vantage/formats/mesh_writer.hpp"
#include "vantage/formats/ply.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the format (glTF 2.0, sections 3.6 and 5).
constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr int unsigned_short = 5123, unsigned_int = 5125, floating = 5126;
constexpr std::uint32_t glb_magic = 0x46546C67, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

void append_uint32(std::string& bytes, std::uint32_t value) { append_int32(bytes, static_cast<std::int32_t>(value)); }

/// A value of an sRGB image as 16 bits of light: what glTF means by vertex colours.
std::uint16_t light(std::uint8_t value) {
  const double v = value / 255.0;
  const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  return static_cast<std::uint16_t>(std::lround(65535 * linear));
}

/// Grows the document and its one buffer together.
class GlbWriter {
 public:
  /// Everything appended to `bytes` since the accessor before becomes a new one; returns its number.
  int add_accessor(int component, const char* type, std::size_t count, int target) {
    const std::size_t begin = end_of_last_;
    document_["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size() - begin}, {"target", target}});
    document_["accessors"].push_back({{"bufferView", document_["bufferViews"].size() - 1},
                                      {"componentType", component},
                                      {"count", count},
                                      {"type", type}});
    end_of_last_ = bytes.size();
    return static_cast<int>(document_["accessors"].size()) - 1;
  }
  [[nodiscard]] Json& accessor(int number) { return document_["accessors"][static_cast<std::size_t>(number)]; }
  [[nodiscard]] Json& document() { return document_; }

  [[nodiscard]] std::string file() {
    document_["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
    std::string json = document_.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    std::string file;
    append_uint32(file, glb_magic);
    append_uint32(file, 2);
    append_uint32(file, static_cast<std::uint32_t>(28 + json.size() + bytes.size()));
    append_uint32(file, static_cast<std::uint32_t>(json.size()));
    append_uint32(file, json_chunk);
    file += json;
    append_uint32(file, static_cast<std::uint32_t>(bytes.size()));
    append_uint32(file, binary_chunk);
    return file + bytes;
  }

  std::string bytes;

 private:
  Json document_{{"asset", {{"version", "2.0"}, {"generator", "vantage"}}}};
  std::size_t end_of_last_ = 0;
};

int add_vectors(GlbWriter& writer, const std::vector<Vec3>& vectors) {
  for (const Vec3& vector : vectors) {
    for (const double part : vector) append_float32(writer.bytes, part);
  }
  return writer.add_accessor(floating, "VEC3", vectors.size(), array_buffer);
}

Json attributes(GlbWriter& writer, const MeasuredMesh& measured) {
  const std::vector<Vec3>& vertices = measured.mesh.vertices;
  Json result;
  const int positions = add_vectors(writer, vertices);
  const auto rounded = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  const Box3 box = measured.mesh.box();
  for (const auto& [name, corner] : {std::pair{"min", box.min()}, std::pair{"max", box.max()}}) {
    writer.accessor(positions)[name] = {rounded(corner.x()), rounded(corner.y()), rounded(corner.z())};
  }
  result["POSITION"] = positions;
  result["NORMAL"] = add_vectors(writer, vertex_normals(measured.mesh));
  if (!measured.colors.empty()) {
    for (const auto& color : measured.colors) {  // four shorts, as rows have to be a multiple of four bytes
      for (std::size_t i = 0; i < 4; ++i) {
        const std::uint16_t value = i < 3 ? light(color[i]) : std::uint16_t{65535};
        writer.bytes.push_back(static_cast<char>(value & 255U));
        writer.bytes.push_back(static_cast<char>(value >> 8U));
      }
    }
    result["COLOR_0"] = writer.add_accessor(unsigned_short, "VEC4", vertices.size(), array_buffer);
    writer.accessor(result["COLOR_0"].get<int>())["normalized"] = true;
  }
  if (!measured.sigma.empty()) {
    for (const float sigma : measured.sigma) append_float32(writer.bytes, static_cast<double>(sigma));
    result["_SIGMA"] = writer.add_accessor(floating, "SCALAR", vertices.size(), array_buffer);
  }
  return result;
}

Json material(const char* name, const std::array<double, 4>& color) {
  return {{"name", name},
          {"pbrMetallicRoughness", {{"baseColorFactor", color}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}},
          {"doubleSided", true}};
}

}  // namespace

std::string glb_bytes(const MeasuredMesh& measured) {
  GlbWriter writer;
  Json& document = writer.document();
  document["scene"] = 0;
  document["scenes"] = Json::array({{{"nodes", {0}}}});
  // z is up in the world, y in glTF: a quarter turn about x.
  const double half_root = std::sqrt(0.5);
  document["nodes"] = Json::array({{{"mesh", 0}, {"name", "model"}, {"rotation", {-half_root, 0, 0, half_root}}}});
  const Json shared = attributes(writer, measured);
  Json primitives = Json::array();
  for (const int cap : {0, 1}) {
    std::size_t count = 0;
    for (std::size_t t = 0; t < measured.mesh.triangles.size(); ++t) {
      if ((measured.is_cap.empty() ? 0 : measured.is_cap[t]) != cap) continue;
      for (const int index : measured.mesh.triangles[t]) append_int32(writer.bytes, index);
      count += 3;
    }
    if (count == 0) continue;
    const int indices = writer.add_accessor(unsigned_int, "SCALAR", count, element_array_buffer);
    primitives.push_back({{"attributes", shared}, {"indices", indices}, {"material", cap}});
  }
  document["meshes"] = Json::array({{{"name", "model"}, {"primitives", primitives}}});
  const std::array<double, 4> white{1, 1, 1, 1}, grey{0.6, 0.6, 0.6, 1}, orange{0.9, 0.35, 0.1, 1};
  document["materials"] =
      Json::array({material("seen", measured.colors.empty() ? grey : white), material("cap", orange)});
  return writer.file();
}

}  // namespace vantage
