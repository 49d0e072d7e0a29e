#pragma once

#include <map>
#include <optional>
#include <set>

#include "vantage/files/byte_reader.hpp"
#include "vantage/files/input_file.hpp"
#include "vantage/recordings/bag.hpp"

namespace vantage {

/// A bag of ROS 1, format 2.0 (https://wiki.ros.org/Bags/Format/2.0), as RealSense cameras write it too. Its records
/// are read in their order, so that bags that were not closed (.bag.active) can be read without reindexing.
class Ros1Bag : public Bag {
 public:
  /// Throws InputError where the file is no such bag.
  explicit Ros1Bag(const std::filesystem::path& path);

  void walk(const Visit& visit) override;
  [[nodiscard]] std::string read(const MessagePlace& place) override;
  [[nodiscard]] std::string format() const override;

  [[nodiscard]] static bool is_begin_of(std::string_view bytes);

 private:
  /// The fields of a record's header by their names.
  using Fields = std::map<std::string, std::string, std::less<>>;
  struct Record {
    Fields fields;
    std::uint64_t place = 0;  // of the record in the file
    std::uint64_t begin = 0;  // of its data
    std::uint64_t size = 0;   // of its data
    [[nodiscard]] std::uint64_t end() const { return begin + size; }
    [[nodiscard]] int op() const;
  };
  struct Chunk {
    std::string records;
    std::string trouble;  // why it is not whole
  };

  [[nodiscard]] static Fields read_fields(std::string_view header, const std::string& name);
  /// The record that begins there, also where its data goes beyond the end of the file; none where there is no record.
  [[nodiscard]] std::optional<Record> record_at(std::uint64_t place) const;
  /// The record without what lies behind the next one that was found, where its size is wrong.
  [[nodiscard]] Record up_to_damage(Record record) const;
  void visit_record(const Record& record, const Visit& visit);
  void visit_chunk(const Record& record, const Visit& visit);
  /// Returns where the next record begins.
  std::size_t visit_chunk_record(std::string_view records, std::size_t at, std::uint64_t place, const Visit& visit);
  [[nodiscard]] static std::size_t next_in_chunk(std::string_view records, std::size_t from);
  void read_index();
  void visit_message(const Fields& fields, MessagePlace place, std::string_view bytes, const Visit& visit);
  void read_connection(const Fields& fields, std::string_view data);
  [[nodiscard]] Chunk unpack(const Record& record) const;
  [[nodiscard]] std::optional<std::uint64_t> next_chunk(std::uint64_t from) const;

  InputFile file_;
  std::map<std::uint32_t, std::size_t> connections_;     // topics by the number of the connection
  std::map<std::uint32_t, std::uint64_t> unknown_;       // messages of connections that are not described
  std::map<std::uint64_t, std::uint64_t> damaged_ends_;  // of records by their place
  std::set<std::string> compressions_;
  ChunkCache cache_;
};

}  // namespace vantage
