#include "vantage/server/without_folders.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace vantage {
namespace {

/// Whether a path may begin at this place of a text.
bool begins_word(std::string_view text, std::size_t at) {
  if (at == 0) return true;
  const auto before = static_cast<unsigned char>(text[at - 1]);
  return std::isalnum(before) == 0 && before < 0x80 &&
         std::string_view("/._-~").find(text[at - 1]) == std::string_view::npos;
}

void replace_words(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; !from.empty() && (at = text.find(from, at)) != std::string::npos;) {
    if (begins_word(text, at)) text.replace(at, from.size(), to);
    at += to.size() + 1;
  }
}

/// With the folder's name for its path, however it is written. Folders with blanks in their names are found by this
/// only.
std::string below_name(std::string text, const std::filesystem::path& folder) {
  std::string whole = std::filesystem::absolute(folder).lexically_normal().string();
  while (whole.size() > 1 && whole.back() == '/') whole.pop_back();
  const std::string name = std::filesystem::path(whole).filename().string() + "/";
  std::error_code unknown;
  const std::filesystem::path canonical = std::filesystem::canonical(folder, unknown);
  replace_words(text, whole + "/", name);
  if (!unknown) replace_words(text, canonical.string() + "/", name);
  replace_words(text, folder.string() + "/", name);
  return text;
}

}  // namespace

std::string without_folders(std::string text, const std::filesystem::path& folder) {
  if (!folder.empty()) text = below_name(std::move(text), folder);
  constexpr std::string_view ends = " \t\n\r\"'<>|,;()";
  for (std::size_t at = 0; (at = text.find('/', at)) != std::string::npos;) {
    if (!begins_word(text, at)) {
      ++at;
      continue;
    }
    std::size_t end = std::min(text.find_first_of(ends, at), text.size());
    while (end > at + 1 && std::string_view(":./").find(text[end - 1]) != std::string_view::npos) --end;
    const std::size_t last = text.rfind('/', end - 1);
    text.erase(at, last + 1 - at);
    at += end - last;
  }
  return text;
}

}  // namespace vantage
