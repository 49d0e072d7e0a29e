#include "vantage/recordings/sqlite_bag.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <map>

#include "vantage/core/error.hpp"
#include "vantage/files/compression.hpp"
#include "vantage/files/input_file.hpp"

namespace vantage {
namespace {

constexpr std::string_view sqlite_magic("SQLite format 3\0", 16);

std::string column_text(sqlite3_stmt* row, int column) {
  const auto* bytes = sqlite3_column_text(row, column);
  return bytes == nullptr ? std::string() : reinterpret_cast<const char*>(bytes);
}

std::string_view column_blob(sqlite3_stmt* row, int column) {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(row, column));
  return bytes == nullptr ? std::string_view()
                          : std::string_view(bytes, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

/// The path as SQLite wants it to open a file that nobody changes, and without creating files beside it.
std::string immutable_uri(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path) {
    if (c == '?' || c == '#' || c == '%') {
      uri += fmt::format("%{:02x}", static_cast<unsigned char>(c));
    } else {
      uri += c;
    }
  }
  return uri + "?immutable=1";
}

}  // namespace

bool SqliteBag::is_begin_of(std::string_view bytes) { return bytes.substr(0, sqlite_magic.size()) == sqlite_magic; }

SqliteBag::SqliteBag(const std::filesystem::path& path)
    : name_(path.string()), database_(nullptr, sqlite3_close), one_message_(nullptr, sqlite3_finalize) {
  require(is_begin_of(InputFile(path).read(0, sqlite_magic.size())), name_, ": is no SQLite database");
  try {
    open(false);
    check_tables();
  } catch (const InputError&) {
    // A recorder that was killed leaves a journal beside the file, which a reader without write permission cannot open;
    // what is in the file itself can be read.
    one_message_.reset();
    open(true);
    check_tables();
  }
}

void SqliteBag::open(bool is_immutable) {
  sqlite3* opened = nullptr;
  const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX | (is_immutable ? SQLITE_OPEN_URI : 0);
  const int result = sqlite3_open_v2((is_immutable ? immutable_uri(name_) : name_).c_str(), &opened, flags, nullptr);
  database_.reset(opened);
  require(result == SQLITE_OK, name_, ": cannot be opened: ", reason());
  // The file may come from anybody: no code in its schema is run, and no text or blob may be larger than a message is.
  sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(largest_chunk));
  sqlite3_exec(opened, "PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0", nullptr, nullptr, nullptr);
}

void SqliteBag::check_tables() {
  const Statement tables =
      statement("SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('topics', 'messages')");
  const bool is_bag = sqlite3_step(tables.get()) == SQLITE_ROW && sqlite3_column_int(tables.get(), 0) == 2;
  require(is_bag, name_, ": has no tables 'topics' and 'messages'; it is no recording of ROS 2");
  one_message_ = statement("SELECT data FROM messages WHERE id = ?");
}

SqliteBag::Statement SqliteBag::statement(const char* sql) const {
  sqlite3_stmt* prepared = nullptr;
  const int result = sqlite3_prepare_v2(database_.get(), sql, -1, &prepared, nullptr);
  Statement owned(prepared, sqlite3_finalize);
  require(result == SQLITE_OK, name_, ": cannot be read: ", reason());
  return owned;
}

std::string SqliteBag::reason() const { return database_ == nullptr ? "no memory" : sqlite3_errmsg(database_.get()); }

void SqliteBag::walk(const Visit& visit) {
  std::map<std::int64_t, std::size_t> topic_of;
  const Statement topics = statement("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(topics.get())) == SQLITE_ROW) {
    topic_of[sqlite3_column_int64(topics.get(), 0)] =
        topic_index(column_text(topics.get(), 1), column_text(topics.get(), 2), column_text(topics.get(), 3));
  }
  require(result == SQLITE_DONE, name_, ": the table of topics cannot be read: ", reason());

  const Statement rows = statement("SELECT id, topic_id, timestamp, data FROM messages ORDER BY id");
  std::int64_t last = 0, unknown = 0, damaged = 0;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    last = sqlite3_column_int64(rows.get(), 0);
    const auto topic = topic_of.find(sqlite3_column_int64(rows.get(), 1));
    if (topic == topic_of.end()) {
      ++unknown;
      continue;
    }
    try {
      const std::string_view stored = column_blob(rows.get(), 3);
      const std::string packed = is_zstd(stored) ? unpacked(stored, last) : std::string();
      const std::string_view bytes = is_zstd(stored) ? packed : stored;
      visit({topic->second,
             sqlite3_column_int64(rows.get(), 2),
             {0, static_cast<std::uint64_t>(last), 0, bytes.size()},
             bytes});
    } catch (const InputError& error) {
      if (++damaged == 1) note_damage(error.what());
    }
  }
  if (result != SQLITE_DONE) note_damage(fmt::format("{}: cannot be read after message {}: {}", name_, last, reason()));
  if (unknown > 0) note_damage(fmt::format("{}: {} messages of topics that are not described", name_, unknown));
  if (damaged > 1) note_damage(fmt::format("{}: {} messages are damaged", name_, damaged));
}

std::string SqliteBag::unpacked(std::string_view bytes, std::int64_t row) {
  has_packed_messages_ = true;
  Unpacked result = unpack_zstd(bytes, largest_chunk);
  require(result.trouble.empty(), name_, ": message ", row, " ", result.trouble);
  return std::move(result.bytes);
}

std::string SqliteBag::read(const MessagePlace& place) {
  sqlite3_reset(one_message_.get());
  sqlite3_bind_int64(one_message_.get(), 1, static_cast<std::int64_t>(place.container));
  const int result = sqlite3_step(one_message_.get());
  require(result == SQLITE_ROW, name_, ": message ", place.container, " cannot be read: ", reason());
  const std::string_view stored = column_blob(one_message_.get(), 0);
  std::string bytes =
      is_zstd(stored) ? unpacked(stored, static_cast<std::int64_t>(place.container)) : std::string(stored);
  sqlite3_reset(one_message_.get());
  return bytes;
}

std::string SqliteBag::format() const {
  return has_packed_messages_ ? "ROS 2 sqlite3 (zstd messages)" : "ROS 2 sqlite3";
}

}  // namespace vantage
