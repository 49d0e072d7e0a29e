#pragma once

#include <string>
#include <vector>

namespace vantage {

/// Something that is wrong with a set of scans.
struct Finding {
  std::string check;     // name of the check that found it
  std::string wrong;     // what is wrong, with numbers
  std::string fix;       // what to do
  std::string evidence;  // why the doctor believes so
  bool is_note = false;  // good to know, but nothing is wrong
};

}  // namespace vantage
