#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vantage/recordings/bag_choice.hpp"

namespace vantage {

/// What is in a bag, and how it can be read. Texts are those of the bag with its control characters taken out.
struct RecordingInfo {
  struct Topic {
    std::string name, type, encoding;
    std::uint64_t messages = 0;
    double rate_hz = 0;
    std::string content;   // "640x480 16UC1", of images and clouds
    std::string frame_id;  // of images, clouds, cameras and poses
  };
  /// A topic with depth images or clouds.
  struct Source {
    std::string topic;
    std::string reading;               // where poses and intrinsics come from, or why it cannot be read
    std::vector<std::string> options;  // that read it, one word each; none where it cannot be read
  };

  std::string format;
  double duration_s = 0;
  std::vector<Topic> topics;        // by name
  std::vector<std::string> frames;  // the tree of /tf, children indented
  std::vector<Source> sources;      // the one that is read without options first
  std::vector<std::string> damage;  // what could not be read
};

/// Reads the bag once. Throws InputError where it is none.
[[nodiscard]] RecordingInfo recording_info(const std::filesystem::path& path);

}  // namespace vantage
