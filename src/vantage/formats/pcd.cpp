#include "vantage/formats/pcd.hpp"

#include <fmt/format.h>
#include <lzf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "vantage/core/error.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/pose_file.hpp"

namespace vantage {
namespace {

constexpr std::size_t most_fields = 256;
constexpr std::uint64_t most_points = std::uint64_t{1} << 31U;
constexpr std::uint64_t most_values_per_field = 1024;

struct FieldLayout {
  std::string name;
  std::size_t bytes = 4;  // of one value
  char type = 'F';        // F float, I signed, U unsigned
  std::size_t count = 1;  // values per point

  [[nodiscard]] std::size_t size() const { return bytes * count; }
};

enum class Data { ascii, binary, compressed };

struct PcdHeader {
  std::vector<FieldLayout> fields;
  std::uint64_t width = 0, height = 0;
  std::optional<std::uint64_t> points;
  Pose viewpoint = Pose::Identity();
  Data data = Data::ascii;

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(width * height); }
  [[nodiscard]] std::size_t record_bytes() const {
    std::size_t sum = 0;
    for (const FieldLayout& field : fields) sum += field.size();
    return sum;
  }
};

void read_fields(TextReader& text, PcdHeader& header) {
  for (std::string_view word = text.word(); !word.empty(); word = text.word()) {
    if (header.fields.size() == most_fields) text.fail(fmt::format("more than {} fields", most_fields));
    header.fields.push_back({.name = std::string(word)});
  }
}

Pose read_viewpoint(TextReader& text) {
  std::array<double, 7> numbers{};
  for (double& number : numbers) number = text.finite_number("VIEWPOINT");
  const auto [x, y, z, qw, qx, qy, qz] = numbers;
  return pose_from_quaternion({x, y, z}, Eigen::Quaterniond(qw, qx, qy, qz), text.name() + ": VIEWPOINT");
}

Data read_data(TextReader& text) {
  const std::string_view data = text.word();
  if (data == "ascii") return Data::ascii;
  if (data == "binary") return Data::binary;
  if (data == "binary_compressed") return Data::compressed;
  text.fail(fmt::format("DATA {}: must be ascii, binary or binary_compressed", in_quotes(data)));
}

void read_type(TextReader& text, FieldLayout& field) {
  const std::string_view type = text.word();
  if (type != "F" && type != "I" && type != "U") text.fail(fmt::format("TYPE {}: must be F, I or U", in_quotes(type)));
  field.type = type[0];
}

void read_size(TextReader& text, FieldLayout& field) {
  field.bytes = text.count("SIZE");
  if (field.bytes != 1 && field.bytes != 2 && field.bytes != 4 && field.bytes != 8) {
    text.fail(fmt::format("SIZE {}: must be 1, 2, 4 or 8", field.bytes));
  }
}

void read_count(TextReader& text, FieldLayout& field) {
  field.count = text.count("COUNT");
  if (field.count == 0 || field.count > most_values_per_field) {
    text.fail(fmt::format("COUNT {}: must be within 1 and {}", field.count, most_values_per_field));
  }
}

std::uint64_t read_side(TextReader& text, std::string_view what) {
  const std::uint64_t side = text.count(what);
  if (side > most_points) text.fail(fmt::format("{} {}: must be at most {}", what, side, most_points));
  return side;
}

void check(const TextReader& text, const PcdHeader& header) {
  if (header.fields.empty()) text.fail("the header has no FIELDS");
  if (header.width == 0 || header.height == 0) text.fail("WIDTH and HEIGHT must be given and positive");
  if (header.width * header.height > most_points) text.fail("WIDTH times HEIGHT is too large");
  if (header.points && *header.points != header.width * header.height) {
    text.fail(fmt::format("POINTS {}: must be WIDTH times HEIGHT, {}", *header.points, header.width * header.height));
  }
  for (const FieldLayout& field : header.fields) {
    if (field.type == 'F' && field.bytes < 4)
      text.fail(fmt::format("field {}: F needs SIZE 4 or 8", in_quotes(field.name)));
  }
}

PcdHeader read_pcd_header(TextReader& text) {
  PcdHeader header;
  while (text.next_line_with_words()) {
    const std::string_view keyword = text.word();
    if (keyword == "FIELDS") {
      read_fields(text, header);
    } else if (keyword == "SIZE") {
      for (FieldLayout& field : header.fields) read_size(text, field);
    } else if (keyword == "TYPE") {
      for (FieldLayout& field : header.fields) read_type(text, field);
    } else if (keyword == "COUNT") {
      for (FieldLayout& field : header.fields) read_count(text, field);
    } else if (keyword == "WIDTH") {
      header.width = read_side(text, "WIDTH");
    } else if (keyword == "HEIGHT") {
      header.height = read_side(text, "HEIGHT");
    } else if (keyword == "POINTS") {
      header.points = text.count("POINTS");
    } else if (keyword == "VIEWPOINT") {
      header.viewpoint = read_viewpoint(text);
    } else if (keyword == "DATA") {
      header.data = read_data(text);
      check(text, header);
      return header;
    } else if (keyword != "VERSION" && keyword[0] != '#') {
      text.fail(fmt::format("{} is no keyword of a PCD header", in_quotes(keyword)));
    }
  }
  throw InputError(text.name() + ": the header ends without 'DATA'; the file is cut off or not a PCD file");
}

template <class Value>
double value_at(const char* at) {
  Value value;
  std::memcpy(&value, at, sizeof(Value));  // PCD has the byte order of the machine; little endian in practice
  return static_cast<double>(value);
}

double binary_value(const FieldLayout& field, const char* at) {
  if (field.type == 'F') return field.bytes == 4 ? value_at<float>(at) : value_at<double>(at);
  const bool is_signed = field.type == 'I';
  switch (field.bytes) {
    case 1:
      return is_signed ? value_at<std::int8_t>(at) : value_at<std::uint8_t>(at);
    case 2:
      return is_signed ? value_at<std::int16_t>(at) : value_at<std::uint16_t>(at);
    case 4:
      return is_signed ? value_at<std::int32_t>(at) : value_at<std::uint32_t>(at);
    default:
      return is_signed ? value_at<std::int64_t>(at) : value_at<std::uint64_t>(at);
  }
}

/// Binary data lies point by point, compressed data field by field.
std::vector<double> binary_field(const PcdHeader& header, std::size_t field_index, std::string_view data) {
  const FieldLayout& field = header.fields[field_index];
  std::size_t bytes_before = 0;
  for (std::size_t f = 0; f < field_index; ++f) bytes_before += header.fields[f].size();
  const bool by_point = header.data == Data::binary;
  const std::size_t start = by_point ? bytes_before : bytes_before * header.count();
  const std::size_t step = by_point ? header.record_bytes() : field.size();
  std::vector<double> values(header.count());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = binary_value(field, data.data() + start + i * step);
  return values;
}

std::string uncompressed(std::string_view data, std::size_t expected, const std::string& name) {
  constexpr std::size_t best_ratio = 88;  // three bytes of LZF stand for 264 at most
  if (data.size() < 8) throw InputError(name + ": ends before the compressed points; the file is cut off");
  const auto compressed = static_cast<std::size_t>(value_at<std::uint32_t>(data.data()));
  const auto size = static_cast<std::size_t>(value_at<std::uint32_t>(data.data() + 4));
  data.remove_prefix(8);
  if (compressed > data.size()) {
    throw InputError(fmt::format("{}: {} compressed bytes are announced, but only {} follow; the file is cut off", name,
                                 compressed, data.size()));
  }
  if (size != expected || size > best_ratio * compressed) {
    throw InputError(fmt::format("{}: {} compressed bytes are said to hold {}: the header asks for {}", name,
                                 compressed, size, expected));
  }
  std::string result(size, '\0');
  if (::lzf_decompress(data.data(), static_cast<unsigned>(compressed), result.data(), static_cast<unsigned>(size)) !=
      size) {
    throw InputError(name + ": the compressed points are damaged");
  }
  return result;
}

std::vector<Pcd::Field> read_ascii(TextReader& text, const PcdHeader& header) {
  const std::size_t count = header.count();
  if (count > text.rest().size()) {
    throw InputError(fmt::format("{}: {} points are announced, but only {} bytes follow; the file is cut off",
                                 text.name(), count, text.rest().size()));
  }
  std::vector<Pcd::Field> fields;
  for (const FieldLayout& field : header.fields) fields.push_back({field.name, {}});
  for (std::size_t i = 0; i < count; ++i) {
    if (!text.next_line_with_words()) {
      throw InputError(
          fmt::format("{}: ends after {} of {} points; the file is cut off", text.name(), i, header.count()));
    }
    for (std::size_t f = 0; f < fields.size(); ++f) {
      for (std::size_t k = 0; k < header.fields[f].count; ++k) {
        const double value = text.number(fields[f].name);
        if (k == 0) fields[f].values.push_back(value);
      }
    }
  }
  return fields;
}

std::vector<Pcd::Field> read_binary(std::string_view data, const PcdHeader& header, const std::string& name) {
  std::string plain;
  const std::size_t record = header.record_bytes();
  if (header.data == Data::compressed) {
    plain = uncompressed(data, header.count() * record, name);
    data = plain;
  } else if (header.count() > data.size() / record) {
    throw InputError(
        fmt::format("{}: {} points of {} bytes are announced, but only {} bytes follow; the file is cut off", name,
                    header.count(), record, data.size()));
  }
  std::vector<Pcd::Field> fields;
  for (std::size_t f = 0; f < header.fields.size(); ++f) {
    fields.push_back({header.fields[f].name, binary_field(header, f, data)});
  }
  return fields;
}

}  // namespace

const std::vector<double>* Pcd::find(std::string_view field) const {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == field; });
  return found == fields.end() ? nullptr : &found->values;
}

Pcd parse_pcd(std::string_view bytes, const std::string& name, std::size_t most_values) {
  TextReader text(bytes, name);
  const PcdHeader header = read_pcd_header(text);
  // A field may hold several numbers, of which one byte each is unpacked.
  require(header.count() <= most_values / std::max(header.record_bytes() / sizeof(double), header.fields.size()), name,
          ": has ", header.count(), " points of ", header.fields.size(), " fields and ", header.record_bytes(),
          " bytes; must have at most ", most_values, " values");
  Pcd pcd;
  pcd.size = {static_cast<int>(header.width), static_cast<int>(header.height)};
  pcd.viewpoint = header.viewpoint;
  pcd.fields = header.data == Data::ascii ? read_ascii(text, header) : read_binary(text.rest(), header, name);
  return pcd;
}

}  // namespace vantage
