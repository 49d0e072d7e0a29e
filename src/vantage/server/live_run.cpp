#include "vantage/server/live_run.hpp"

#include "vantage/core/error.hpp"
#include "vantage/server/random_name.hpp"
#include "vantage/server/without_folders.hpp"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

// A reader that lags behind more than this reads the document, which is less than so many events.
constexpr std::size_t max_events = 256;
constexpr std::size_t max_event_bytes = std::size_t{32} << 20;

/// One line of JSON, whatever bytes its texts hold.
std::string line(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string greeting_text(const std::string& run_name, std::uint64_t revision) {
  return concat("event: hello\ndata: ", line({{"run", run_name}, {"revision", revision}}), "\n\n");
}

void apply(Json& document, std::string_view event, const Json& data) {
  require(data.is_object(), "event ", event, ": must be an object, is ", data.type_name());
  const auto take = [&](Json& target, std::initializer_list<const char*> keys) {
    for (const char* key : keys)
      if (data.contains(key)) target[key] = data[key];
  };
  if (event == "scan") {
    document["scans"].push_back(data);
    document["next"] = nullptr;
    document.erase("take");
  } else if (event == "plan") {
    document["next"] = data;
  } else if (event == "take") {
    document["take"] = data;
  } else if (event == "setup") {
    take(document, {"camera", "candidates"});
  } else if (event == "state") {
    take(document["meta"], {"state"});
    take(document, {"stop_reason", "summary"});
  } else if (event == "result") {
    take(document, {"cloud", "mesh", "truth"});
  } else {
    throw Error(concat("event '", event, "': must be scan, plan, take, setup, state or result"));
  }
}

/// Options name files of this machine, which others see: their names are left.
void hide_folders(Json& document) {
  if (!document.contains("meta") || !document["meta"].is_object() || !document["meta"].contains("options")) return;
  for (Json& value : document["meta"]["options"])
    if (value.is_string()) value = without_folders(value.get<std::string>());
}

}  // namespace

void LiveRun::begin(Json document) {
  require(document.is_object(), "the document of a run must be an object, is ", document.type_name());
  hide_folders(document);
  const std::lock_guard lock(mutex_);
  document_ = std::move(document);
  ++run_;
  run_name_ = random_name();
  revision_ = 0;
  events_.clear();
  event_bytes_ = 0;
  text_.reset();
  changed_.notify_all();
}

void LiveRun::add(std::string_view event, const Json& data) {
  const std::string data_line = line(data);
  const std::lock_guard lock(mutex_);
  if (run_ == 0) throw Error(concat("event '", event, "' before the run began"));
  apply(document_, event, data);
  ++revision_;
  text_.reset();
  events_.push_back({revision_, std::make_shared<const std::string>(
                                    concat("id: ", revision_, "\nevent: ", event, "\ndata: ", data_line, "\n\n"))});
  event_bytes_ += events_.back().text->size();
  keep_few_events();
  changed_.notify_all();
}

void LiveRun::keep_few_events() {
  while (events_.size() > 1 && (events_.size() > max_events || event_bytes_ > max_event_bytes)) {
    event_bytes_ -= events_.front().text->size();
    events_.pop_front();
  }
}

std::shared_ptr<const std::string> LiveRun::document() const {
  const std::lock_guard lock(mutex_);
  if (run_ == 0) return nullptr;
  if (!text_) {
    std::string text = line(document_);
    text.pop_back();  // the closing brace
    text_ = std::make_shared<const std::string>(concat(text, text == "{" ? "" : ",", "\"revision\":", revision_, "}"));
  }
  return text_;
}

std::shared_ptr<const std::string> LiveRun::next(Reader& reader, std::chrono::milliseconds patience) const {
  std::unique_lock lock(mutex_);
  const auto is_new = [&] { return closed_ || reader.run != run_ || (run_ != 0 && reader.revision < revision_); };
  if (!changed_.wait_for(lock, patience, is_new)) return std::make_shared<const std::string>();
  if (closed_) return nullptr;
  if (reader.run != run_) {
    // Whoever is greeted reads the document, so the events before now are not needed.
    reader = {run_, revision_};
    return std::make_shared<const std::string>(greeting_text(run_name_, revision_));
  }
  for (const Event& event : events_) {
    if (event.revision <= reader.revision) continue;
    reader.revision = event.revision;
    return event.text;
  }
  throw Error("a live run lost its events");  // add() keeps at least the last one
}

std::string LiveRun::greeting(const Reader& reader) const {
  const std::lock_guard lock(mutex_);
  if (reader.run == 0 || reader.run != run_) return ": nothing to show yet\n\n";
  return greeting_text(run_name_, reader.revision);
}

void LiveRun::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

}  // namespace vantage
