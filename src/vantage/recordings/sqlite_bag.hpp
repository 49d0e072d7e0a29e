#pragma once

#include <memory>

#include "vantage/recordings/bag.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace vantage {

/// A .db3 file of ROS 2: the tables `topics` and `messages` of an SQLite database, with all versions of its layout.
/// Also messages that were compressed one by one (Zstandard) are unpacked.
class SqliteBag : public Bag {
 public:
  /// Throws InputError where the file is no such database.
  explicit SqliteBag(const std::filesystem::path& path);

  void walk(const Visit& visit) override;
  [[nodiscard]] std::string read(const MessagePlace& place) override;
  [[nodiscard]] std::string format() const override;

  [[nodiscard]] static bool is_begin_of(std::string_view bytes);

 private:
  using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
  using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

  void open(bool is_immutable);
  void check_tables();
  [[nodiscard]] Statement statement(const char* sql) const;
  [[nodiscard]] std::string reason() const;
  [[nodiscard]] std::string unpacked(std::string_view bytes, std::int64_t row);

  std::string name_;
  Database database_;
  Statement one_message_;
  bool has_packed_messages_ = false;
};

}  // namespace vantage
