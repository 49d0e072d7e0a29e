#include "vantage/server/multipart.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "vantage/core/error.hpp"
#include "vantage/files/plain_text.hpp"
#include "vantage/server/admission.hpp"

namespace vantage {
namespace {

constexpr std::size_t longest_boundary = 70;
constexpr std::size_t most_parts = 16;
constexpr std::size_t longest_part_header = 4096;
constexpr std::string_view blanks = " \t";

std::string_view without_blanks(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// Takes a word, or text in quotes, from the front.
std::string take_value(std::string_view& rest) {
  std::string value;
  if (!rest.starts_with('"')) {
    const std::string_view word = rest.substr(0, rest.find(';'));
    rest.remove_prefix(word.size());
    return std::string(without_blanks(word));
  }
  rest.remove_prefix(1);
  while (!rest.empty() && rest[0] != '"') {
    // Paths of Windows come with single backslashes.
    if (rest.size() > 1 && rest[0] == '\\' && (rest[1] == '"' || rest[1] == '\\')) rest.remove_prefix(1);
    value += rest[0];
    rest.remove_prefix(1);
  }
  rest.remove_prefix(std::min(rest.find(';'), rest.size()));
  return value;
}

/// A line that separates parts.
struct Delimiter {
  std::size_t begin, end;  // in the body, with the line ends before and after it
  bool is_last;
};

/// The first one at or after `from`.
std::optional<Delimiter> find_delimiter(std::string_view body, const std::string& dashed, std::size_t from) {
  for (std::size_t at = from; (at = body.find(dashed, at)) != std::string_view::npos; ++at) {
    const bool begins_line = at == 0 || (at >= 2 && body.substr(at - 2, 2) == "\r\n");
    if (!begins_line) continue;
    const std::size_t begin = at == 0 ? 0 : at - 2;
    std::size_t end = at + dashed.size();
    if (body.substr(end, 2) == "--") return Delimiter{begin, end + 2, true};
    end = std::min(body.find_first_not_of(blanks, end), body.size());
    if (body.substr(end, 2) == "\r\n") return Delimiter{begin, end + 2, false};
  }
  return std::nullopt;
}

/// Takes the next header, continued lines joined, from a part.
std::string take_header(std::string_view& part) {
  std::string header;
  do {
    const std::string_view line = part.substr(0, part.find("\r\n"));
    header += line;
    part.remove_prefix(std::min(part.size(), line.size() + 2));
  } while (!header.empty() && !part.empty() && blanks.find(part[0]) != std::string_view::npos);
  return header;
}

FormPart parse_part(std::string_view part) {
  const std::size_t end = part.starts_with("\r\n") ? 0 : part.find("\r\n\r\n");
  require(end != std::string_view::npos, "multipart body: a part is cut off");
  require(end <= longest_part_header, "multipart body: the header of a part has more than ", longest_part_header,
          " bytes");
  FormPart result;
  for (std::string header; !(header = take_header(part)).empty();) {
    const std::size_t colon = std::min(header.find(':'), header.size());
    const std::string name = lower(std::string(without_blanks(std::string_view(header).substr(0, colon))));
    const std::string_view value = std::string_view(header).substr(std::min(colon + 1, header.size()));
    if (name == "content-disposition") {
      result.name = header_parameter(value, "name");
      result.file_name = header_parameter(value, "filename");
    } else if (name == "content-transfer-encoding") {
      constexpr std::array plain{"binary", "8bit", "7bit"};
      const std::string encoding = lower(std::string(without_blanks(value)));
      require(std::find(plain.begin(), plain.end(), encoding) != plain.end(),
              "multipart body: Content-Transfer-Encoding = ", printable(encoding), ": must be binary, or missing");
    }
  }
  require(!result.name.empty(), "multipart body: a part has no Content-Disposition with a name");
  require_plain_text(result.name, "multipart body: the name of a part");
  result.body = part;
  return result;
}

}  // namespace

std::string header_parameter(std::string_view header, std::string_view name) {
  std::string_view rest = header;
  rest.remove_prefix(std::min(rest.find(';'), rest.size()));
  while (!rest.empty()) {
    rest.remove_prefix(1);  // the semicolon
    const std::size_t equals = rest.find('=');
    const std::size_t next = rest.find(';');
    if (equals == std::string_view::npos) return {};
    if (next < equals) {  // a parameter without a value
      rest.remove_prefix(next);
      continue;
    }
    const std::string found = lower(std::string(without_blanks(rest.substr(0, equals))));
    rest.remove_prefix(equals + 1);
    rest.remove_prefix(std::min(rest.find_first_not_of(blanks), rest.size()));
    std::string value = take_value(rest);
    if (found == name) return value;
  }
  return {};
}

std::vector<FormPart> parse_multipart(std::string_view body, std::string_view boundary) {
  require(!boundary.empty(), "multipart body: the header Content-Type has no boundary");
  require(boundary.size() <= longest_boundary, "multipart body: the boundary has ", boundary.size(),
          " characters, must have 1 to ", longest_boundary);
  const std::string dashed = concat("--", boundary);
  auto before = find_delimiter(body, dashed, 0);
  require(before.has_value(), "multipart body: has no line with the boundary of the header Content-Type, ",
          printable(boundary));
  std::vector<FormPart> parts;
  while (!before->is_last) {
    // The line end of one delimiter may begin the next one, where a part is empty.
    const auto after = find_delimiter(body, dashed, before->end - 2);
    require(after.has_value(), "multipart body: part ", parts.size() + 1, " is cut off");
    require(parts.size() < most_parts, "multipart body: has more than ", most_parts, " parts");
    const std::size_t size = after->begin > before->end ? after->begin - before->end : 0;
    FormPart part = parse_part(body.substr(before->end, size));
    for (const FormPart& other : parts)
      require(other.name != part.name, "multipart body: there are two parts '", part.name, "'");
    parts.push_back(std::move(part));
    before = after;
  }
  return parts;
}

}  // namespace vantage
