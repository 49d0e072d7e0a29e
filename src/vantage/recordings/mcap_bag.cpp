#include "vantage/recordings/mcap_bag.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/files/compression.hpp"
#include "vantage/files/text_reader.hpp"

namespace vantage {
namespace {

constexpr std::string_view mcap_magic("\x89MCAP0\r\n", 8);
constexpr std::uint64_t record_head = 9;               // opcode and length
constexpr std::uint64_t footer_size = 8 + 8 + 4;       // of its content
constexpr std::uint64_t largest_definition = 1 << 24;  // schemas are texts of some kB

namespace opcode {
constexpr std::uint8_t footer = 2, schema = 3, channel = 4, message = 5, chunk = 6, data_end = 15;
}

/// What a chunk says ahead of its records.
struct ChunkHead {
  std::uint64_t unpacked_size = 0;
  std::uint32_t crc = 0;
  std::string_view compression;
  std::uint64_t records_size = 0;
};

ChunkHead read_chunk_head(ByteReader& content) {
  ChunkHead head;
  (void)content.bytes(16, "the chunk's times");
  head.unpacked_size = content.u64("the chunk's size");
  head.crc = content.u32("the chunk's checksum");
  head.compression = content.counted("the chunk's compression");
  head.records_size = content.u64("the chunk's size");
  return head;
}

bool is_mcap_compression(std::string_view name) { return name.empty() || name == "zstd" || name == "lz4"; }

/// Whether a chunk's record begins with these bytes: its sizes agree with each other and with what is left of the file.
bool is_chunk_head(std::string_view bytes, std::uint64_t left) {
  if (bytes.size() < 64 || bytes[0] != static_cast<char>(opcode::chunk)) return false;
  const std::uint64_t size = little_endian<8>(bytes.data() + 1);
  if (size > left - record_head) return false;
  try {
    ByteReader content(bytes.substr(record_head), "");
    const ChunkHead head = read_chunk_head(content);
    return is_mcap_compression(head.compression) && head.records_size == size - content.position();
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

bool McapBag::is_begin_of(std::string_view bytes) { return bytes.substr(0, mcap_magic.size()) == mcap_magic; }

McapBag::McapBag(const std::filesystem::path& path) : file_(path) {
  require(is_begin_of(file_.read(0, mcap_magic.size())), file_.name(), ": is no MCAP file");
}

std::string McapBag::format() const {
  return compressions_.empty() ? "MCAP" : fmt::format("MCAP ({})", fmt::join(compressions_, ", "));
}

std::optional<McapBag::Record> McapBag::record_at(std::uint64_t place) const {
  const std::string head = file_.read(place, record_head);
  if (head.size() < record_head || head[0] == 0) return std::nullopt;
  const Record record{static_cast<std::uint8_t>(head[0]), place + record_head, little_endian<8>(head.data() + 1)};
  if (record.size > file_.size() - record.begin) return std::nullopt;
  return record;
}

void McapBag::walk(const Visit& visit) {
  read_summary();
  bool is_closed = false;
  std::uint64_t place = mcap_magic.size();
  while (!is_closed && place < file_.size()) {
    if (const auto record = record_at(place)) {
      is_closed = record->opcode == opcode::data_end || record->opcode == opcode::footer;
      place = visit_record(*record, visit);
      continue;
    }
    const std::optional<std::uint64_t> next = next_chunk(place + 1);
    const std::string kind = file_.read(place, 1);
    if (next) {
      note_damage(fmt::format("{}: bytes {} to {} are damaged", file_.name(), place, *next));
    } else if (kind[0] == static_cast<char>(opcode::chunk) && file_.size() - place > record_head) {
      visit_chunk({opcode::chunk, place + record_head, file_.size() - place - record_head}, visit);
    }
    if (!next) break;
    place = *next;
  }
  if (!is_closed)
    note_damage(
        fmt::format("{}: has no end; its writer was stopped, or it is cut off at byte {}", file_.name(), file_.size()));
  for (const auto& [number, count] : unknown_)
    note_damage(fmt::format("{}: {} messages of channel {}, which is not described", file_.name(), count, number));
}

std::uint64_t McapBag::visit_record(const Record& record, const Visit& visit) {
  try {
    if (record.opcode == opcode::chunk) {
      visit_chunk(record, visit);
    } else if (record.opcode == opcode::message) {
      require(record.size <= largest_chunk, file_.name(), ", byte ", record.begin, ": a message of ", record.size,
              " bytes; must be at most ", largest_chunk);
      const std::string bytes = file_.read(record.begin, record.size);
      ByteReader content(bytes, file_.name(), record.begin);
      visit_message(content, {0, 0, record.begin, record.size}, visit);
    } else if (record.opcode == opcode::schema || record.opcode == opcode::channel) {
      const std::string bytes = file_.read(record.begin, std::min(record.size, largest_definition));
      ByteReader content(bytes, file_.name(), record.begin);
      read_definition(record.opcode, content);
    }
  } catch (const InputError& error) {
    note_damage(error.what());
  }
  return record.end();
}

McapBag::Chunk McapBag::unpack(std::uint64_t begin, std::uint64_t size) const {
  const std::string where = fmt::format("{}, byte {}", file_.name(), begin);
  require(size <= largest_chunk, where, ": a chunk of ", size, " bytes; must be at most ", largest_chunk);
  const std::string bytes = file_.read(begin, size);
  ByteReader content(bytes, file_.name(), begin);
  const ChunkHead head = read_chunk_head(content);
  require(is_mcap_compression(head.compression), where, ": a chunk is compressed with ", in_quotes(head.compression),
          ", must be zstd, lz4 or not at all");
  require(head.unpacked_size <= largest_chunk, where, ": a chunk unpacks to ", head.unpacked_size,
          " bytes; must be at most ", largest_chunk);
  const bool is_whole = head.records_size <= content.left();
  const std::string_view packed = content.bytes(std::min<std::uint64_t>(head.records_size, content.left()), "records");
  Chunk chunk{std::string(head.compression), {}, {}};
  if (head.compression.empty()) {
    chunk.records = packed;
    if (!is_whole) chunk.trouble = "is cut off";
  } else {
    Unpacked unpacked =
        head.compression == "zstd" ? unpack_zstd(packed, head.unpacked_size) : unpack_lz4(packed, head.unpacked_size);
    chunk.records = std::move(unpacked.bytes);
    chunk.trouble = std::move(unpacked.trouble);
  }
  const auto* data = reinterpret_cast<const Bytef*>(chunk.records.data());
  const bool is_checked = chunk.trouble.empty() && head.crc != 0;
  if (is_checked && crc32(0, data, static_cast<uInt>(chunk.records.size())) != head.crc) {
    chunk.records.clear();
    chunk.trouble = "does not have its checksum";
  }
  return chunk;
}

void McapBag::visit_chunk(const Record& record, const Visit& visit) {
  try {
    const Chunk chunk = unpack(record.begin, record.size);
    if (!chunk.compression.empty()) compressions_.insert(chunk.compression);
    if (!chunk.trouble.empty())
      note_damage(fmt::format("{}, byte {}: a chunk {}", file_.name(), record.begin, chunk.trouble));
    visit_chunk_records(chunk.records, record.begin, visit);
  } catch (const InputError& error) {
    note_damage(error.what());
  }
}

void McapBag::visit_chunk_records(std::string_view records, std::uint64_t place, const Visit& visit) {
  ByteReader reader(records, fmt::format("{}, chunk at byte {}", file_.name(), place));
  while (reader.left() > 0) {
    const std::uint8_t kind = reader.u8("a record");
    const std::uint64_t size = reader.u64("a record");
    const std::uint64_t offset = reader.position();
    ByteReader content(reader.bytes(size, "a record"), reader.name(), offset);
    if (kind == opcode::message) {
      visit_message(content, {0, place, offset, size}, visit);
    } else {
      read_definition(kind, content);
    }
  }
}

void McapBag::visit_message(ByteReader& content, MessagePlace place, const Visit& visit) {
  const std::uint16_t number = content.u16("a message's channel");
  (void)content.u32("a message's number");
  const std::uint64_t time = content.u64("a message's time");
  (void)content.u64("a message's time");
  const auto known = channels_.find(number);
  if (known == channels_.end()) {
    ++unknown_[number];
    return;
  }
  place.offset += content.position();
  place.size -= content.position();
  visit({known->second, static_cast<std::int64_t>(time), place, content.bytes(place.size, "a message")});
}

void McapBag::read_definition(std::uint8_t kind, ByteReader& content) {
  if (kind == opcode::schema) {
    const std::uint16_t number = content.u16("a schema");
    schemas_[number] = content.counted("a schema's name");
  } else if (kind == opcode::channel) {
    const std::uint16_t number = content.u16("a channel");
    const auto type = schemas_.find(content.u16("a channel's schema"));
    const std::string topic(content.counted("a channel's topic"));
    const std::string encoding(content.counted("a channel's encoding"));
    channels_[number] = topic_index(topic, type == schemas_.end() ? "" : type->second, encoding);
  }
}

void McapBag::read_summary() {
  // Footer and mcap_magic end the file; where they do not, the data section has all that is needed.
  const std::uint64_t tail = record_head + footer_size + mcap_magic.size();
  if (file_.size() < mcap_magic.size() + tail) return;
  const std::string bytes = file_.read(file_.size() - tail, tail);
  if (bytes.size() < tail || bytes[0] != static_cast<char>(opcode::footer) ||
      !is_begin_of(std::string_view(bytes).substr(tail - 8)))
    return;
  std::uint64_t place = little_endian<8>(bytes.data() + record_head);
  if (place == 0) return;
  try {
    for (auto record = record_at(place); record && record->opcode != opcode::footer;
         record = record_at(record->end())) {
      if (record->opcode != opcode::schema && record->opcode != opcode::channel) continue;
      const std::string definition = file_.read(record->begin, std::min(record->size, largest_definition));
      ByteReader content(definition, file_.name(), record->begin);
      read_definition(record->opcode, content);
    }
  } catch (const InputError&) {
    // The data section repeats what stands here.
  }
}

std::optional<std::uint64_t> McapBag::next_chunk(std::uint64_t from) const {
  constexpr std::uint64_t window = 1 << 20, head = 64;
  for (std::uint64_t place = from; place < file_.size(); place += window) {
    const std::string bytes = file_.read(place, window + head);
    const std::string_view view = bytes;
    for (std::size_t at = view.find(static_cast<char>(opcode::chunk)); at < window;
         at = view.find(static_cast<char>(opcode::chunk), at + 1)) {
      if (is_chunk_head(view.substr(at, head), file_.size() - place - at)) return place + at;
    }
  }
  return std::nullopt;
}

std::string McapBag::read(const MessagePlace& place) {
  if (place.container == 0) return file_.read(place.offset, place.size);
  const std::string& records = cache_.chunk(place.container, [&] {
    const std::string head = file_.read(place.container - record_head, record_head);
    const std::uint64_t size = std::min(little_endian<8>(head.data() + 1), file_.size() - place.container);
    return unpack(place.container, size).records;
  });
  require(place.offset + place.size <= records.size(), file_.name(), ": changed while it was read");
  return records.substr(place.offset, place.size);
}

}  // namespace vantage
