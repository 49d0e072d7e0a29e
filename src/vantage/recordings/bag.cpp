#include "vantage/recordings/bag.hpp"

#include <algorithm>

namespace vantage {

std::size_t Bag::topic_index(const std::string& name, std::string type, const std::string& encoding) {
  if (const auto at = type.find("/msg/"); at != std::string::npos) type.erase(at, 4);
  BagTopic topic{name, std::move(type), encoding};
  const auto known = std::find(topics_.begin(), topics_.end(), topic);
  if (known != topics_.end()) return static_cast<std::size_t>(known - topics_.begin());
  topics_.push_back(std::move(topic));
  return topics_.size() - 1;
}

void Bag::note_damage(const std::string& line) {
  constexpr std::size_t most = 10;
  if (damage_.size() < most) damage_.push_back(line);
  if (damage_.size() == most) damage_.push_back("and more like these");
}

const std::string& ChunkCache::chunk(std::uint64_t place, const std::function<std::string()>& load) {
  constexpr std::size_t kept = 2;
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.place == place; });
  if (known != entries_.end()) {
    std::rotate(entries_.begin(), known, known + 1);
  } else {
    if (entries_.size() == kept) entries_.pop_back();  // before the next one takes memory
    entries_.insert(entries_.begin(), Entry{place, load()});
  }
  return entries_.front().bytes;
}

}  // namespace vantage
