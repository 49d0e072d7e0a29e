#include "vantage/server/multipart.hpp"

#include <algorithm>
#include <cctype>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr std::size_t longest_boundary = 74;  // 70 and the dashes before and after it
constexpr std::size_t most_parts = 16;
constexpr std::size_t longest_header = 4096;

/// What stands before `end`, which is removed with it.
std::string_view take_until(std::string_view& rest, std::string_view end, std::string_view what) {
  const std::size_t at = rest.find(end);
  require(at != std::string_view::npos, "multipart body: ", what, " is cut off");
  const std::string_view found = rest.substr(0, at);
  rest.remove_prefix(at + end.size());
  return found;
}

/// The value of `key="..."` in a header line, empty where it has none.
std::string parameter(std::string_view line, std::string_view key) {
  const std::string wanted = concat("; ", key, "=\"");
  const std::size_t at = line.find(wanted);
  if (at == std::string_view::npos) return {};
  const std::size_t begin = at + wanted.size();
  const std::size_t end = line.find('"', begin);
  return end == std::string_view::npos ? std::string() : std::string(line.substr(begin, end - begin));
}

bool starts_with_word(std::string_view line, std::string_view word) {
  return line.size() >= word.size() && std::equal(word.begin(), word.end(), line.begin(), [](char a, char b) {
           return a == std::tolower(static_cast<unsigned char>(b));
         });
}

FormPart parse_headers(std::string_view headers) {
  FormPart part;
  while (!headers.empty()) {
    const std::string_view line = headers.substr(0, headers.find("\r\n"));
    headers.remove_prefix(std::min(headers.size(), line.size() + 2));
    if (!starts_with_word(line, "content-disposition:")) continue;
    part.name = parameter(line, "name");
    part.file_name = parameter(line, "filename");
  }
  require(!part.name.empty(), "multipart body: a part has no Content-Disposition with a name");
  return part;
}

}  // namespace

std::vector<FormPart> parse_multipart(std::string_view body) {
  require(body.starts_with("--"), "multipart body: must begin with its boundary");
  const std::string boundary = "\r\n" + std::string(take_until(body, "\r\n", "the boundary"));
  require(boundary.size() > 4 && boundary.size() <= longest_boundary, "multipart body: the boundary has ",
          boundary.size() - 4, " characters, must have 1 to 70");
  std::vector<FormPart> parts;
  while (true) {
    const std::string_view headers = take_until(body, "\r\n\r\n", "a part");
    require(headers.size() <= longest_header, "multipart body: the header of a part has more than ", longest_header,
            " bytes");
    FormPart part = parse_headers(headers);
    part.body = take_until(body, boundary, "part '" + part.name + "'");
    for (const FormPart& other : parts)
      require(other.name != part.name, "multipart body: there are two parts '", part.name, "'");
    parts.push_back(std::move(part));
    if (body.starts_with("--")) return parts;
    require(body.starts_with("\r\n"), "multipart body: a boundary is followed by something else than a line end");
    body.remove_prefix(2);
    require(parts.size() < most_parts, "multipart body: has more than ", most_parts, " parts");
  }
}

}  // namespace vantage
