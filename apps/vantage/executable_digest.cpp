#include "executable_digest.hpp"

#include <filesystem>

#include "vantage/experiments/sweep_object.hpp"
#include "vantage/files/atomic_file.hpp"

namespace vantage::app {

std::string executable_digest() { return digest_of(read_file(std::filesystem::read_symlink("/proc/self/exe"))); }

}  // namespace vantage::app
