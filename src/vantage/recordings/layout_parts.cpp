#include "vantage/recordings/layout_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "vantage/core/error.hpp"
#include "vantage/core/text.hpp"
#include "vantage/files/natural_order.hpp"
#include "vantage/files/text_reader.hpp"
#include "vantage/formats/pose_file.hpp"

namespace vantage::layout_parts {
namespace {

constexpr std::array depth_endings{".png", ".exr", ".tif", ".tiff", ".raw", ".npy", ".pfm"};
constexpr std::size_t most_files = 1'000'000;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Whether the whole name fits a pattern of letters, * (any number of any letters) and ? (any letter).
bool fits(std::string_view name, std::string_view pattern) {
  std::size_t n = 0, p = 0, star = std::string_view::npos, resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n]) && pattern[p] != '*') {
      ++n, ++p;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

void sort_by_number(std::vector<fs::path>& paths) {
  std::sort(paths.begin(), paths.end(),
            [](const fs::path& a, const fs::path& b) { return comes_before(a.string(), b.string()); });
}

/// "depth_0001" and "0001.depth" are frame 0001: the name without that word and what separates it.
std::string frame_name(std::string stem) {
  const std::string word = "depth";
  const std::size_t at = lower(stem).find(word);
  if (at == std::string::npos) return stem;
  constexpr std::string_view separators = "._- ";
  std::string before = stem.substr(0, at), after = stem.substr(at + word.size());
  while (!before.empty() && separators.find(before.back()) != std::string_view::npos) before.pop_back();
  while (!after.empty() && separators.find(after.front()) != std::string_view::npos) after.erase(after.begin());
  const std::string rest = before + (before.empty() || after.empty() ? "" : "-") + after;
  return rest.empty() ? stem : rest;
}

bool is_pose_file(const fs::path& path) {
  const std::string ending = lower(path.extension().string());
  return ending == ".txt" || ending == ".json" || ending == ".pose";
}

/// Pose files of a folder by the numbers in their names.
MatchedPoses poses_from_folder(const fs::path& folder, const std::vector<LayoutFrame>& frames) {
  std::map<std::int64_t, fs::path> by_number;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!is_pose_file(entry.path())) continue;
    const std::string stem = entry.path().stem().string();
    // Beside other files a pose file must say that it is one.
    const bool is_named =
        lower(stem).find("pose") != std::string::npos || lower(folder.filename().string()).find("pose") == 0;
    const auto number = number_in(stem);
    if (is_named && number) by_number.emplace(*number, entry.path());
  }
  MatchedPoses result;
  std::size_t matched = 0;
  for (const LayoutFrame& frame : frames) {
    const auto number = number_in(frame.name);
    const auto found = number ? by_number.find(*number) : by_number.end();
    result.poses.push_back(found == by_number.end() ? std::nullopt : read_pose_unless_lost(found->second));
    result.why_not.emplace_back(found == by_number.end() ? "has no pose"
                                                         : "has a pose that is not finite: tracking was lost");
    matched += result.poses.back() ? 1 : 0;
  }
  result.how = fmt::format("{} matched by their numbers", matched);
  return result;
}

}  // namespace

bool is_depth_image(const fs::path& path) {
  const std::string ending = lower(path.extension().string());
  return std::find(depth_endings.begin(), depth_endings.end(), ending) != depth_endings.end();
}

std::vector<fs::path> files_matching(const fs::path& folder, const std::string& pattern) {
  std::vector<fs::path> found{folder};
  const std::vector<std::string> parts = split(pattern, '/');
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty() || parts[i] == ".") {
      if (i == 0 && parts[i].empty()) found = {fs::path("/")};  // an absolute path
      continue;
    }
    std::vector<fs::path> next;
    for (const fs::path& each : found) {
      if (!fs::is_directory(each)) continue;
      if (parts[i] == "..") {
        next.push_back(each / "..");
        continue;
      }
      for (const auto& entry : fs::directory_iterator(each)) {
        if (fits(entry.path().filename().string(), parts[i])) next.push_back(entry.path());
        require(next.size() <= most_files, "depth = ", in_quotes(pattern), ": fits more than ", most_files, " files");
      }
    }
    found = std::move(next);
  }
  std::erase_if(found, [](const fs::path& path) { return !fs::is_regular_file(path); });
  sort_by_number(found);
  return found;
}

std::vector<fs::path> depth_images_in(const fs::path& folder) {
  std::vector<fs::path> images;
  if (!fs::is_directory(folder)) return images;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_depth_image(entry.path()) && entry.path().filename().string()[0] != '.') images.push_back(entry.path());
  }
  sort_by_number(images);
  return images;
}

std::vector<LayoutFrame> frames_of(const std::vector<fs::path>& images) {
  std::vector<LayoutFrame> frames;
  std::map<std::string, int> uses;
  for (const fs::path& image : images) {
    frames.push_back({.name = frame_name(image.stem().string()), .depth = image});
    ++uses[frames.back().name];
  }
  // Images of the same name in several folders are told apart by these.
  for (LayoutFrame& frame : frames) {
    if (uses[frame.name] > 1)
      frame.name = frame.depth.parent_path().filename().string() + "-" + frame.depth.stem().string();
  }
  return frames;
}

std::optional<fs::path> first_file(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::vector<fs::path> found = files_matching(folder, name);
    if (!found.empty()) return found.front();
  }
  return std::nullopt;
}

void take_poses(FolderLayout& layout, const fs::path& source, const ScanFolderOptions& options) {
  if (!options.has_poses()) {
    for (LayoutFrame& frame : layout.frames) frame.world_from_sensor = Pose::Identity();
    layout.poses = "no poses";
    return;
  }
  MatchedPoses matched;
  if (fs::is_directory(source)) {
    matched = poses_from_folder(source, layout.frames);
    layout.poses = fmt::format("poses in {}, {}", source.filename().string(), matched.how);
  } else {
    std::vector<FrameKey> keys;
    for (const LayoutFrame& frame : layout.frames) keys.push_back({frame.name, frame.time_s});
    const PoseList list = read_pose_list(source);
    matched = match_poses(list, keys, options.match, source.string());
    layout.poses = fmt::format("{} {}, {}", list.kind, source.filename().string(), matched.how);
  }
  std::vector<LayoutFrame> posed;
  for (std::size_t i = 0; i < layout.frames.size(); ++i) {
    if (matched.poses[i]) {
      layout.frames[i].world_from_sensor = matched.poses[i];
      posed.push_back(std::move(layout.frames[i]));
    } else {
      layout.left_out.push_back(fmt::format("frame {} {}", in_quotes(layout.frames[i].name), matched.why_not[i]));
    }
  }
  require(!posed.empty(), source.string(), ": has no pose for any of the ", layout.frames.size(), " depth images; ",
          layout.left_out.empty() ? "" : layout.left_out.back());
  layout.frames = std::move(posed);
}

}  // namespace vantage::layout_parts
