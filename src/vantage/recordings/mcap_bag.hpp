#pragma once

#include <map>
#include <optional>
#include <set>

#include "vantage/files/byte_reader.hpp"
#include "vantage/files/input_file.hpp"
#include "vantage/recordings/bag.hpp"

namespace vantage {

/// An MCAP file (https://mcap.dev/spec): reads the data section from its beginning to its end and needs no index, so
/// that files whose writer was killed can be read.
class McapBag : public Bag {
 public:
  /// Throws InputError where the file is no MCAP.
  explicit McapBag(const std::filesystem::path& path);

  void walk(const Visit& visit) override;
  [[nodiscard]] std::string read(const MessagePlace& place) override;
  [[nodiscard]] std::string format() const override;

  [[nodiscard]] static bool is_begin_of(std::string_view bytes);

 private:
  struct Record {
    std::uint8_t opcode = 0;
    std::uint64_t begin = 0;  // of its content in the file
    std::uint64_t size = 0;
    [[nodiscard]] std::uint64_t end() const { return begin + size; }
  };
  struct Chunk {
    std::string compression;
    std::string records;
    std::string trouble;  // why it is not whole
  };

  [[nodiscard]] std::optional<Record> record_at(std::uint64_t place) const;
  [[nodiscard]] std::uint64_t visit_record(const Record& record, const Visit& visit);
  void visit_chunk(const Record& record, const Visit& visit);
  void visit_chunk_records(std::string_view records, std::uint64_t place, const Visit& visit);
  void visit_message(ByteReader& content, MessagePlace place, const Visit& visit);
  void read_definition(std::uint8_t kind, ByteReader& content);
  void read_summary();
  [[nodiscard]] Chunk unpack(std::uint64_t begin, std::uint64_t size) const;
  [[nodiscard]] std::optional<std::uint64_t> next_chunk(std::uint64_t from) const;

  InputFile file_;
  std::map<std::uint16_t, std::string> schemas_;    // names of message types by their number
  std::map<std::uint16_t, std::size_t> channels_;   // topics by the number of their channel
  std::map<std::uint16_t, std::uint64_t> unknown_;  // messages of channels that are not described
  std::set<std::string> compressions_;
  ChunkCache cache_;
};

}  // namespace vantage
