#include "vantage/recordings/ros1_bag.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/files/compression.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {
namespace {

constexpr std::string_view ros1_magic = "#ROSBAG V2.0\n";
constexpr std::uint64_t largest_header = 1 << 20;  // descriptions of connections hold the text of the message type

namespace op {
constexpr int message_data = 2, bag_header = 3, chunk = 5, chunk_info = 6, connection = 7;
}

/// A number of a field, which is stored as its bytes.
template <int Bytes, class FieldMap>
std::optional<std::uint64_t> field_number(const FieldMap& fields, std::string_view name) {
  const auto found = fields.find(name);
  if (found == fields.end() || found->second.size() != Bytes) return std::nullopt;
  return little_endian<Bytes>(found->second.data());
}

template <class FieldMap>
std::string field_text(const FieldMap& fields, std::string_view name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string() : found->second;
}

std::int64_t nanoseconds(std::uint64_t time) {  // seconds in the lower half, nanoseconds in the upper one
  return static_cast<std::int64_t>((time & 0xFFFFFFFFU) * 1'000'000'000 + (time >> 32U));
}

}  // namespace

int Ros1Bag::Record::op() const { return static_cast<int>(field_number<1>(fields, "op").value_or(0)); }

bool Ros1Bag::is_begin_of(std::string_view bytes) { return bytes.substr(0, 7) == ros1_magic.substr(0, 7); }

Ros1Bag::Ros1Bag(const std::filesystem::path& path) : file_(path) {
  const std::string head = file_.read(0, ros1_magic.size());
  require(is_begin_of(head), file_.name(), ": is no bag of ROS 1");
  require(head == ros1_magic, file_.name(), ": is a bag of the format ", in_quotes(head),
          ", must be 2.0; `rosbag fix` of ROS 1 converts older ones");
}

std::string Ros1Bag::format() const {
  return compressions_.empty() ? "ROS 1 bag" : fmt::format("ROS 1 bag ({})", fmt::join(compressions_, ", "));
}

Ros1Bag::Fields Ros1Bag::read_fields(std::string_view header, const std::string& name) {
  Fields fields;
  ByteReader reader(header, name);
  while (reader.left() > 0) {
    const std::string_view field = reader.counted("a field");
    const std::size_t equals = field.find('=');
    require(equals != std::string_view::npos, name, ": a field of a record has no '='");
    fields.emplace(field.substr(0, equals), field.substr(equals + 1));
  }
  return fields;
}

std::optional<Ros1Bag::Record> Ros1Bag::record_at(std::uint64_t place) const {
  const std::string size = file_.read(place, 4);
  if (size.size() < 4) return std::nullopt;
  const std::uint64_t header_size = little_endian<4>(size.data());
  if (header_size > largest_header) return std::nullopt;
  const std::string header = file_.read(place + 4, header_size + 4);
  if (header.size() < header_size + 4) return std::nullopt;
  try {
    Record record{read_fields(std::string_view(header).substr(0, header_size), file_.name()), place,
                  place + 4 + header_size + 4, little_endian<4>(header.data() + header_size)};
    if (record.op() < op::message_data || record.op() > op::connection) return std::nullopt;
    return record;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Ros1Bag::Record Ros1Bag::up_to_damage(Record record) const {
  const auto end = damaged_ends_.find(record.place);
  if (end != damaged_ends_.end()) record.size = std::min(record.size, end->second - record.begin);
  return record;
}

void Ros1Bag::walk(const Visit& visit) {
  read_index();
  std::uint64_t place = ros1_magic.size();
  bool has_end = false;  // connections and chunk infos behind the last chunk
  while (place < file_.size()) {
    const auto record = record_at(place);
    // A size that is wrong leads into the middle of another record.
    const bool is_whole = record && record->end() <= file_.size() &&
                          (record->end() == file_.size() || record_at(record->end()).has_value());
    std::optional<std::uint64_t> next = is_whole ? record->end() : next_chunk(record ? record->begin : place + 1);
    if (!is_whole && next)
      note_damage(
          fmt::format("{}: bytes {} to {} are damaged; what can be read of them is", file_.name(), place, *next));
    if (record && !is_whole && next) damaged_ends_[record->place] = *next;
    if (record) visit_record(up_to_damage(*record), visit);
    has_end = record && record->op() == op::chunk_info;
    place = next.value_or(file_.size());
    if (!next) note_damage(fmt::format("{}: is cut off at byte {}", file_.name(), file_.size()));
  }
  if (!has_end) note_damage(fmt::format("{}: has no index; its writer was stopped, or it is cut off", file_.name()));
  for (const auto& [number, count] : unknown_)
    note_damage(fmt::format("{}: {} messages of connection {}, which is not described", file_.name(), count, number));
}

void Ros1Bag::visit_record(const Record& record, const Visit& visit) {
  if (record.op() == op::bag_header) {
    require(field_text(record.fields, "encryptor").empty(), file_.name(), ": is encrypted (",
            in_quotes(field_text(record.fields, "encryptor")), "); decrypt it first");
  } else if (record.op() == op::chunk) {
    visit_chunk(record, visit);
  } else if (record.op() == op::connection) {
    const std::string data = file_.read(record.begin, std::min(record.size, largest_header));
    try {
      read_connection(record.fields, data);
    } catch (const InputError& error) {
      note_damage(error.what());
    }
  }
}

Ros1Bag::Chunk Ros1Bag::unpack(const Record& record) const {
  const std::string where = fmt::format("{}, byte {}", file_.name(), record.begin);
  const std::string compression = field_text(record.fields, "compression");
  const std::uint64_t size = field_number<4>(record.fields, "size").value_or(record.size);
  require(std::max(size, record.size) <= largest_chunk, where, ": a chunk of ", std::max(size, record.size),
          " bytes; must be at most ", largest_chunk);
  const std::string packed = file_.read(record.begin, record.size);
  const std::string cut_off = packed.size() < record.size ? "is cut off" : "";
  if (compression == "none" || compression.empty()) return {packed, cut_off};
  require(compression == "bz2" || compression == "lz4", where, ": a chunk is compressed with ", in_quotes(compression),
          ", must be bz2, lz4 or none");
  Unpacked unpacked = compression == "bz2" ? unpack_bzip2(packed, size) : unpack_lz4(packed, size);
  return {std::move(unpacked.bytes), std::move(unpacked.trouble)};
}

void Ros1Bag::visit_chunk(const Record& record, const Visit& visit) {
  try {
    const Chunk chunk = unpack(record);
    const std::string compression = field_text(record.fields, "compression");
    if (compression != "none" && !compression.empty()) compressions_.insert(compression);
    if (!chunk.trouble.empty())
      note_damage(fmt::format("{}, byte {}: a chunk {}", file_.name(), record.begin, chunk.trouble));
    const std::string_view records = chunk.records;
    std::size_t at = 0;
    while (at < records.size()) {
      try {
        at = visit_chunk_record(records, at, record.place, visit);
      } catch (const InputError& error) {
        const std::size_t next = next_in_chunk(records, at + 1);
        note_damage(fmt::format("{}; {} bytes of the chunk are passed over", error.what(), next - at));
        at = next;
      }
    }
  } catch (const InputError& error) {
    note_damage(error.what());
  }
}

std::size_t Ros1Bag::visit_chunk_record(std::string_view records, std::size_t at, std::uint64_t place,
                                        const Visit& visit) {
  ByteReader reader(records.substr(at), fmt::format("{}, chunk at byte {}", file_.name(), place));
  const Fields fields = read_fields(reader.counted("a record"), reader.name());
  const std::uint64_t size = reader.u32("a record");
  const std::uint64_t offset = at + reader.position();
  const std::string_view data = reader.bytes(size, "a record");
  const int kind = Record{fields}.op();
  require(kind == op::connection || kind == op::message_data, reader.name(), ": byte ", at, " is no message");
  if (kind == op::connection) read_connection(fields, data);
  if (kind == op::message_data) visit_message(fields, {0, place, offset, size}, data, visit);
  return offset + size;
}

/// Where the next message or connection of a chunk begins, or its end.
std::size_t Ros1Bag::next_in_chunk(std::string_view records, std::size_t from) {
  constexpr std::string_view field("\x04\0\0\0op=", 7);  // some bytes behind the record's begin
  constexpr std::size_t furthest = 64;
  for (std::size_t found = records.find(field, from); found != std::string_view::npos;
       found = records.find(field, found + 1)) {
    for (std::size_t back = 4; back <= furthest && from + back <= found; ++back) {
      try {
        ByteReader reader(records.substr(found - back), "");
        const Fields fields = read_fields(reader.counted("a record"), "");
        const int kind = Record{fields}.op();
        if (kind == op::connection || kind == op::message_data) return found - back;
      } catch (const InputError&) {
        continue;
      }
    }
  }
  return records.size();
}

void Ros1Bag::read_index() {
  // Connections are described where they begin, which may be damaged, and once more behind the last chunk.
  const auto header = record_at(ros1_magic.size());
  if (!header || header->op() != op::bag_header) return;
  const std::uint64_t place = field_number<8>(header->fields, "index_pos").value_or(0);
  if (place == 0 || place >= file_.size()) return;
  for (auto record = record_at(place); record && record->op() == op::connection; record = record_at(record->end())) {
    try {
      read_connection(record->fields, file_.read(record->begin, std::min(record->size, largest_header)));
    } catch (const InputError&) {
      return;  // the chunks repeat it
    }
  }
}

void Ros1Bag::visit_message(const Fields& fields, MessagePlace place, std::string_view bytes, const Visit& visit) {
  const auto connection = field_number<4>(fields, "conn");
  const auto time = field_number<8>(fields, "time");
  require(connection && time, file_.name(), ", chunk at byte ", place.container, ": a message has no 'conn' or 'time'");
  const auto known = connections_.find(static_cast<std::uint32_t>(*connection));
  if (known == connections_.end()) {
    ++unknown_[static_cast<std::uint32_t>(*connection)];
  } else {
    visit({known->second, nanoseconds(*time), place, bytes});
  }
}

void Ros1Bag::read_connection(const Fields& fields, std::string_view data) {
  const auto connection = field_number<4>(fields, "conn");
  require(connection.has_value(), file_.name(), ": a connection has no 'conn'");
  const Fields about = read_fields(data, file_.name());
  connections_[static_cast<std::uint32_t>(*connection)] =
      topic_index(field_text(fields, "topic"), field_text(about, "type"), "ros1");
}

std::optional<std::uint64_t> Ros1Bag::next_chunk(std::uint64_t from) const {
  // Every chunk's header has this field, some bytes behind the record's begin.
  constexpr std::string_view field = "compression=";
  constexpr std::uint64_t window = 1 << 20, furthest = 64;
  for (std::uint64_t place = from; place < file_.size(); place += window) {
    const std::string bytes = file_.read(place, window + field.size());
    for (std::size_t at = bytes.find(field); at < window; at = bytes.find(field, at + 1)) {
      for (std::uint64_t back = 8; back <= furthest && back <= place + at - from; ++back) {
        const std::uint64_t candidate = place + at - back;
        const auto record = record_at(candidate);
        if (record && record->op() == op::chunk && record->fields.count("compression") == 1 &&
            record->fields.count("size") == 1)
          return candidate;
      }
    }
  }
  return std::nullopt;
}

std::string Ros1Bag::read(const MessagePlace& place) {
  const std::string& records = cache_.chunk(place.container, [&] {
    const auto record = record_at(place.container);
    require(record.has_value(), file_.name(), ": changed while it was read");
    return unpack(up_to_damage(*record)).records;
  });
  require(place.offset + place.size <= records.size(), file_.name(), ": changed while it was read");
  return records.substr(place.offset, place.size);
}

}  // namespace vantage
