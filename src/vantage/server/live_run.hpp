#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace vantage {

/// One run that is shown to any number of browsers while it goes on: the document of docs/report-data.md, and the
/// events that changed it. Writers wait for no connection, at most for the document to be put into text, which is once
/// for each change that somebody asks about; a reader that fell behind finds a gap and reads the whole
/// document. Every member may be called from any thread.
class LiveRun {
 public:
  using Json = nlohmann::ordered_json;

  /// Where a reader of events stands. A new one starts with the greeting.
  struct Reader {
    std::uint64_t run = 0;       // which run it was greeted with; 0: none yet
    std::uint64_t revision = 0;  // the last event that it has
  };

  /// Shows `document` (RunData) from now on, with revision 0; readers are greeted again.
  void begin(Json document);
  /// Changes the document by one event, `scan`, `plan`, `take`, `setup`, `state` or `result`, and tells the readers.
  /// Throws Error for other names and before begin().
  void add(std::string_view event, const Json& data);

  /// The document with its `revision` as JSON text; null while there is none.
  [[nodiscard]] std::shared_ptr<const std::string> document() const;

  /// What `reader` has not heard yet in the text of server-sent events, empty where nothing came within `patience`.
  /// Null after close().
  [[nodiscard]] std::shared_ptr<const std::string> next(Reader& reader, std::chrono::milliseconds patience) const;
  /// The greeting for a reader that has already heard one: lets it know that the connection is alive.
  [[nodiscard]] std::string greeting(const Reader& reader) const;
  /// Ends all waiting in next(), now and later.
  void close();

 private:
  struct Event {
    std::uint64_t revision;
    std::shared_ptr<const std::string> text;
  };

  void keep_few_events();

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  Json document_;
  std::uint64_t run_ = 0;  // 0: none yet
  std::string run_name_;   // differs from run to run and from program to program
  std::uint64_t revision_ = 0;
  std::deque<Event> events_;  // the latest ones
  std::size_t event_bytes_ = 0;
  bool closed_ = false;
  mutable std::shared_ptr<const std::string> text_;  // of document_; null: not made yet
};

}  // namespace vantage
