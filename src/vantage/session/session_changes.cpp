#include <algorithm>

#include "vantage/core/error.hpp"
#include "vantage/session/sealed_file.hpp"
#include "vantage/session/session.hpp"

namespace vantage {

/// Makes the model of these scans, but for those left out, from the disk.
void Session::merge_again(std::vector<int> numbers) {
  model_is_whole_ = false;
  while (!model_is_whole_) {
    std::erase_if(numbers, [this](int number) { return left_out_.contains(number); });
    auto fresh = std::make_unique<SessionModel>(options());
    int number = -1;
    try {
      for (const int each : numbers) {
        number = each;
        const std::optional<Located> known = folder_.located(number);
        const Located found = fresh->add(number, folder_.read(number), known);
        if (!known) store_located(number, found);
        tell_follower(*fresh);
      }
      model_ = std::move(fresh);
      model_is_whole_ = true;
    } catch (const std::exception& error) {
      leave_out(number, error.what());
    }
  }
  if (state()) publish();
}

std::optional<int> Session::same_scan(const SessionScan& scan) {
  const std::string bytes = measured_bytes(scan);
  const std::lock_guard storing(storing_);
  const auto [first, last] = numbers_of_content_.equal_range(checksum_of(bytes));
  for (auto each = first; each != last; ++each) {
    try {
      const SessionScan there = folder_.read(each->second);
      const bool keys_differ = !scan.key.empty() && !there.key.empty() && scan.key != there.key;
      if (!keys_differ && measured_bytes(there) == bytes) return each->second;
    } catch (const std::exception&) {
      // Nobody knows whether what cannot be read is the same.
    }
  }
  return std::nullopt;
}

void Session::remove(int number) {
  // Whoever reads the scans once more from the disk ends first.
  const std::lock_guard finishing(finishing_);
  const std::lock_guard meshing(meshing_);
  const std::lock_guard merging(merging_);
  std::vector<int> merged = model_->numbers();
  {
    const std::lock_guard storing(storing_);
    const std::vector<int>& there = folder_.scans();
    require(std::binary_search(there.begin(), there.end(), number), "scan ", number, ": is not in the session",
            folder_.removed().contains(number) ? ", it was taken out before" : "");
    folder_.remove(number);
    std::erase_if(waiting_, [number](const Waiting& each) { return each.number == number; });
    std::erase_if(number_of_key_, [number](const auto& each) { return each.second == number; });
    std::erase_if(numbers_of_content_, [number](const auto& each) { return each.second == number; });
    const std::lock_guard looking(looking_);
    --stored_;
    removed_.insert(number);
    left_out_.erase(number);
  }
  if (std::erase(merged, number) > 0) merge_again(std::move(merged));
}

void Session::restore(int number) {
  const std::lock_guard finishing(finishing_);
  const std::lock_guard meshing(meshing_);
  const std::lock_guard merging(merging_);
  std::vector<int> merged = model_->numbers();
  {
    const std::lock_guard storing(storing_);
    require(folder_.removed().contains(number), "scan ", number, ": was not taken out");
    folder_.restore(number);
    note_identity({number, folder_.read(number)});
    const std::lock_guard looking(looking_);
    ++stored_;
    removed_.erase(number);
  }
  merged.insert(std::upper_bound(merged.begin(), merged.end(), number), number);
  merge_again(std::move(merged));
}

}  // namespace vantage
