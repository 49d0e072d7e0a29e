// One program per reader: CMake sets VANTAGE_FUZZ_READER to its name.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "readers.hpp"
#include "vantage/core/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vantage;
  static const auto read = std::find_if(fuzz::readers().begin(), fuzz::readers().end(), [](const fuzz::Reader& reader) {
                             return reader.name == VANTAGE_FUZZ_READER;
                           })->read;
  try {
    read({reinterpret_cast<const char*>(data), size});
  } catch (const InputError&) {
    // What a reader says to bytes that are no such file; anything else ends the program, which the fuzzer reports.
  }
  return 0;
}
