#include "vantage/files/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "vantage/core/error.hpp"

namespace vantage {

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "vantage-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw Error(concat("cannot make the temporary folder ", name, ": ", std::generic_category().message(errno)));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace vantage
