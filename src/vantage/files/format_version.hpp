#pragma once

#include <string>

#include "vantage/core/error.hpp"

namespace vantage {

/// Throws InputError where a file has a newer format than this program knows; what the file holds may then mean
/// something else, so nothing of it is used or changed. Older formats stay readable.
inline void require_known_format(double found, int known, const std::string& name) {
  require(found <= known, name, ": has format ", found, "; this program knows ", known,
          ", take the program that wrote it, or a newer one");
}

}  // namespace vantage
