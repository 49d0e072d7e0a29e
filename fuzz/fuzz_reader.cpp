// One program per group of readers: CMake sets VANTAGE_FUZZ_GROUP to its name and
// VANTAGE_FUZZ_READERS to the list that it is in. Every reader of the group
// gets every input, so that what is new to one is tried on those of like formats too.

#include <cstddef>
#include <cstdint>

#include "readers.hpp"
#include "vantage/core/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vantage;
  for (const fuzz::Reader& reader : fuzz::VANTAGE_FUZZ_READERS()) {
    if (reader.group != VANTAGE_FUZZ_GROUP) continue;
    try {
      reader.read({reinterpret_cast<const char*>(data), size});
    } catch (const InputError&) {
      // What a reader says to bytes that are no such file; anything else ends the program, which the fuzzer reports.
    }
  }
  return 0;
}
