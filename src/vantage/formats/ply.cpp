#include "vantage/formats/ply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {
namespace {

// No PLY file has more elements, or properties in one; without a bound a made-up header could keep us busy for hours.
constexpr std::size_t most_parts = 256;

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Type> type_named(std::string_view name) {
  struct Name {
    std::string_view name;
    Type type;
  };
  constexpr std::array<Name, 16> names{{{"char", Type::int8},
                                        {"uchar", Type::uint8},
                                        {"short", Type::int16},
                                        {"ushort", Type::uint16},
                                        {"int", Type::int32},
                                        {"uint", Type::uint32},
                                        {"float", Type::float32},
                                        {"double", Type::float64},
                                        {"int8", Type::int8},
                                        {"uint8", Type::uint8},
                                        {"int16", Type::int16},
                                        {"uint16", Type::uint16},
                                        {"int32", Type::int32},
                                        {"uint32", Type::uint32},
                                        {"float32", Type::float32},
                                        {"float64", Type::float64}}};
  const auto* const found = std::find_if(names.begin(), names.end(), [&](const Name& n) { return n.name == name; });
  return found == names.end() ? std::nullopt : std::optional(found->type);
}

std::size_t size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::int32:
    case Type::uint32:
    case Type::float32:
      return 4;
    case Type::float64:
      break;
  }
  return 8;
}

enum class Encoding { ascii, little_endian, big_endian };

/// How the file stores the values of a column.
struct Layout {
  Type count_type = Type::uint8;  // lists only
  Type type = Type::float32;
};

struct PlyHeader {
  Encoding encoding = Encoding::ascii;
  Ply content;                               // columns still without values
  std::vector<std::vector<Layout>> layouts;  // as content.elements and their columns
};

Type read_type(TextReader& text) {
  const std::string_view name = text.word();
  const auto type = type_named(name);
  if (!type) text.fail(fmt::format("{} is no PLY type", in_quotes(name)));
  return *type;
}

void read_property(TextReader& text, PlyHeader& header) {
  if (header.content.elements.empty()) text.fail("a property must follow an element");
  PlyColumn column;
  Layout layout;
  std::string_view type = text.word();
  column.is_list = type == "list";
  if (column.is_list) {
    layout.count_type = read_type(text);
    if (layout.count_type == Type::float32 || layout.count_type == Type::float64) {
      text.fail("the length of a list must have an integer type");
    }
    layout.type = read_type(text);
  } else {
    const auto found = type_named(type);
    if (!found) text.fail(fmt::format("{} is no PLY type", in_quotes(type)));
    layout.type = *found;
  }
  column.name = text.word();
  PlyElement& element = header.content.elements.back();
  if (column.name.empty()) text.fail("the property has no name");
  if (element.columns.size() == most_parts) text.fail(fmt::format("more than {} properties", most_parts));
  if (element.find(column.name) != nullptr) text.fail(fmt::format("property {} stands twice", in_quotes(column.name)));
  element.columns.push_back(std::move(column));
  header.layouts.back().push_back(layout);
}

Encoding read_format(TextReader& text) {
  const std::string_view format = text.word();
  if (format == "ascii") return Encoding::ascii;
  if (format == "binary_little_endian") return Encoding::little_endian;
  if (format == "binary_big_endian") return Encoding::big_endian;
  text.fail(fmt::format("format {}: must be ascii, binary_little_endian or binary_big_endian", in_quotes(format)));
}

PlyHeader read_ply_header(TextReader& text) {
  PlyHeader header;
  bool has_format = false;
  if (!text.next_line() || trimmed(text.rest_of_line()) != "ply") {
    throw InputError(text.name() + ": is not a PLY file (its first line must be 'ply')");
  }
  while (text.next_line()) {
    const std::string_view keyword = text.word();
    if (keyword == "format") {
      header.encoding = read_format(text);
      has_format = true;
    } else if (keyword == "element") {
      PlyElement element;
      element.name = text.word();
      element.rows = text.count("the number of rows");
      if (header.content.find(element.name) != nullptr)
        text.fail(fmt::format("element {} stands twice", in_quotes(element.name)));
      if (header.content.elements.size() == most_parts) text.fail(fmt::format("more than {} elements", most_parts));
      header.content.elements.push_back(std::move(element));
      header.layouts.emplace_back();
    } else if (keyword == "property") {
      read_property(text, header);
    } else if (keyword == "obj_info") {
      header.content.info.emplace_back(trimmed(text.rest_of_line()));
    } else if (keyword == "end_header") {
      if (!has_format) text.fail("the header has no line 'format'");
      return header;
    } else if (keyword != "comment" && !keyword.empty()) {
      text.fail(fmt::format("{} is no keyword of a PLY header", in_quotes(keyword)));
    }
  }
  throw InputError(text.name() + ": the header ends without 'end_header'; the file is cut off or not a PLY file");
}

/// Values one after the other from ASCII lines, one line per row.
class AsciiSource {
 public:
  explicit AsciiSource(TextReader& text) : text_(text) {}

  [[nodiscard]] std::size_t bytes_left() const { return text_.rest().size(); }
  [[nodiscard]] std::size_t most_values_left() const { return text_.rest_of_line().size() / 2; }  // a blank and a digit
  // A value takes at least a digit and a separator; the last one of the file needs none.
  static std::size_t least_bytes(const Layout&) { return 1; }
  void begin_row(const PlyElement& element, std::size_t row) {
    if (text_.next_line_with_words()) return;
    throw InputError(fmt::format("{}: ends after {} of {} rows of '{}'; the file is cut off", text_.name(), row,
                                 element.rows, element.name));
  }
  void end_row() {
    if (!text_.at_end_of_line())
      text_.fail(fmt::format("{} is more than the header announces", in_quotes(text_.word())));
  }
  double value(Type type, const PlyColumn& column) {
    const double value = text_.number(column.name);
    check(type, value, column);
    return value;
  }
  void end() {
    if (text_.next_line_with_words()) text_.fail("more rows than the header announces");
  }
  [[noreturn]] void fail(const std::string& message) const { text_.fail(message); }

 private:
  void check(Type type, double value, const PlyColumn& column) const {
    if (type == Type::float32 || type == Type::float64 || value == std::floor(value)) return;
    text_.fail(fmt::format("{} = {}: must be a whole number", column.name, value));
  }

  TextReader& text_;
};

/// Values one after the other from bytes.
class BinarySource {
 public:
  BinarySource(std::string_view bytes, bool swapped, std::string name)
      : bytes_(bytes), swapped_(swapped), name_(std::move(name)) {}

  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size(); }
  [[nodiscard]] std::size_t most_values_left() const { return bytes_.size(); }
  static std::size_t least_bytes(const Layout& layout) { return size_of(layout.type); }
  void begin_row(const PlyElement& element, std::size_t row) {
    element_ = &element;
    row_ = row;
  }
  void end_row() {}
  double value(Type type, const PlyColumn&) {
    switch (type) {
      case Type::int8:
        return take<std::int8_t>();
      case Type::uint8:
        return take<std::uint8_t>();
      case Type::int16:
        return take<std::int16_t>();
      case Type::uint16:
        return take<std::uint16_t>();
      case Type::int32:
        return take<std::int32_t>();
      case Type::uint32:
        return take<std::uint32_t>();
      case Type::float32:
        return static_cast<double>(take<float>());
      case Type::float64:
        break;
    }
    return take<double>();
  }
  void end() const {
    // Some writers end the file with a line end.
    if (bytes_.find_first_not_of(std::string_view("\r\n\0 ", 4)) != std::string_view::npos)
      throw InputError(fmt::format("{}: {} bytes more than the header announces", name_, bytes_.size()));
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(fmt::format("{}, row {} of '{}': {}", name_, row_, element_->name, message));
  }

 private:
  template <class Value>
  Value take() {
    if (bytes_.size() < sizeof(Value)) {
      throw InputError(fmt::format("{}: ends in row {} of {} of '{}'; the file is cut off", name_, row_, element_->rows,
                                   element_->name));
    }
    std::array<char, sizeof(Value)> raw{};
    std::copy_n(bytes_.begin(), sizeof(Value), raw.begin());
    if (swapped_) std::reverse(raw.begin(), raw.end());
    bytes_.remove_prefix(sizeof(Value));
    return std::bit_cast<Value>(raw);
  }

  std::string_view bytes_;
  bool swapped_;
  std::string name_;
  const PlyElement* element_ = nullptr;
  std::size_t row_ = 0;
};

template <class Source>
void read_list(Source& source, const Layout& layout, PlyColumn& column) {
  const double count = source.value(layout.count_type, column);
  if (!(count >= 0)) source.fail(fmt::format("list '{}' has the length {}: must not be negative", column.name, count));
  if (count > static_cast<double>(source.most_values_left())) {
    source.fail(fmt::format("list '{}' has the length {}, more than the file holds", column.name, count));
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    column.values.push_back(source.value(layout.type, column));
  }
  column.ends.push_back(column.values.size());
}

template <class Source>
void read_element(Source& source, const std::vector<Layout>& layouts, PlyElement& element, const std::string& name) {
  if (element.rows == 0) return;
  if (element.columns.empty()) throw InputError(fmt::format("{}: element '{}' has no properties", name, element.name));
  // What the rows take at least; a header that promises more than there is must not reserve memory.
  std::size_t row_bytes = 0;
  for (std::size_t c = 0; c < layouts.size(); ++c) {
    row_bytes += element.columns[c].is_list ? std::size_t{1} : Source::least_bytes(layouts[c]);
  }
  if (element.rows > source.bytes_left() / row_bytes) {
    throw InputError(fmt::format("{}: {} rows of '{}' are announced, but only {} bytes follow; the file is cut off",
                                 name, element.rows, element.name, source.bytes_left()));
  }
  for (PlyColumn& column : element.columns)
    (column.is_list ? column.ends.reserve(element.rows) : column.values.reserve(element.rows));
  for (std::size_t row = 0; row < element.rows; ++row) {
    source.begin_row(element, row);
    for (std::size_t c = 0; c < layouts.size(); ++c) {
      PlyColumn& column = element.columns[c];
      if (column.is_list) {
        read_list(source, layouts[c], column);
      } else {
        column.values.push_back(source.value(layouts[c].type, column));
      }
    }
    source.end_row();
  }
}

template <class Source>
void read_elements(Source source, PlyHeader& header, const std::string& name) {
  for (std::size_t e = 0; e < header.content.elements.size(); ++e) {
    read_element(source, header.layouts[e], header.content.elements[e], name);
  }
  source.end();
}

template <class Value>
void append_little_endian(std::string& bytes, Value value) {
  auto raw = std::bit_cast<std::array<char, sizeof(Value)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace

const PlyColumn* PlyElement::find(std::string_view column) const {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const PlyColumn& c) { return c.name == column; });
  return found == columns.end() ? nullptr : &*found;
}

const PlyElement* Ply::find(std::string_view element) const {
  const auto found =
      std::find_if(elements.begin(), elements.end(), [&](const PlyElement& e) { return e.name == element; });
  return found == elements.end() ? nullptr : &*found;
}

Ply parse_ply(std::string_view bytes, const std::string& name, std::size_t most_values) {
  if (bytes.empty()) throw InputError(name + ": is empty");
  TextReader text(bytes, name);
  PlyHeader header = read_ply_header(text);
  for (const PlyElement& element : header.content.elements) {
    require(element.rows <= most_values / std::max(element.columns.size(), std::size_t{1}), name, ": has ",
            element.rows, " rows of ", element.columns.size(), " properties in '", element.name,
            "'; must have at most ", most_values, " values");
  }
  if (header.encoding == Encoding::ascii) {
    read_elements(AsciiSource(text), header, name);
  } else {
    const bool native = (header.encoding == Encoding::little_endian) == (std::endian::native == std::endian::little);
    read_elements(BinarySource(text.rest(), !native, name), header, name);
  }
  return std::move(header.content);
}

const PlyColumn& scalar_column(const PlyElement& element, std::string_view column, const std::string& name) {
  const PlyColumn* found = element.find(column);
  if (found == nullptr || found->is_list) {
    throw InputError(fmt::format("{}: element '{}' has no number '{}'", name, element.name, column));
  }
  return *found;
}

Coordinates coordinates_for(double largest, double resolution) {
  constexpr double rounding = 0x1p-24;  // of float32, relative
  return largest * rounding <= resolution ? Coordinates::float32 : Coordinates::float64;
}

Coordinates coordinates_for(const std::vector<Vec3>& points) {
  constexpr double resolution = 0x1p-18;
  Box3 box;
  for (const Vec3& point : points) box.extend(point);
  if (box.isEmpty()) return Coordinates::float32;
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  return coordinates_for(largest, resolution * box.sizes().maxCoeff());
}

std::string ply_header(std::size_t vertices, Coordinates coordinates, const std::vector<std::string>& properties) {
  std::string header = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", vertices);
  const char* const type = coordinates == Coordinates::float32 ? "float" : "double";
  for (const char axis : {'x', 'y', 'z'}) header += fmt::format("property {} {}\n", type, axis);
  for (const std::string& property : properties) header += fmt::format("property float {}\n", property);
  return header + "end_header\n";
}

std::string ply_mesh_header(const PlyMeshHeader& mesh) {
  std::string header = fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", mesh.vertices);
  const char* const type = mesh.coordinates == Coordinates::float32 ? "float" : "double";
  for (const char axis : {'x', 'y', 'z'}) header += fmt::format("property {} {}\n", type, axis);
  for (const std::string& property : mesh.vertex_properties) header += fmt::format("property {}\n", property);
  header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n", mesh.triangles);
  for (const std::string& property : mesh.face_properties) header += fmt::format("property {}\n", property);
  return header + "end_header\n";
}

void append_point(std::string& bytes, const Vec3& point, Coordinates coordinates) {
  for (const double coordinate : point) {
    if (coordinates == Coordinates::float32) {
      append_float32(bytes, coordinate);
    } else {
      append_little_endian(bytes, coordinate);
    }
  }
}

void append_float32(std::string& bytes, double value) { append_little_endian(bytes, static_cast<float>(value)); }
void append_int32(std::string& bytes, std::int32_t value) { append_little_endian(bytes, value); }

}  // namespace vantage
