#include "vantage/server/http_head.hpp"

#include <fmt/format.h>

#include <boost/beast/http/status.hpp>
#include <charconv>

namespace vantage {
namespace {

/// With `%41` as A; what is no such sign stays as it is. In a query `+` is a blank.
std::string decoded(std::string_view text, char plus) {
  std::string result;
  for (std::size_t at = 0; at < text.size(); ++at) {
    unsigned char byte = 0;
    const char* digits = text.data() + at + 1;
    if (text[at] == '%' && at + 2 < text.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      result += static_cast<char>(byte);
      at += 2;
    } else {
      result += text[at] == '+' ? plus : text[at];
    }
  }
  return result;
}

}  // namespace

HttpHead parse_target(std::string_view target) {
  HttpHead head;
  const std::size_t end = std::min(target.find('?'), target.size());
  head.path = decoded(target.substr(0, end), '+');
  std::string_view rest = target.substr(std::min(end + 1, target.size()));
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(one.size() + 1, rest.size()));
    const std::size_t equals = std::min(one.find('='), one.size());
    if (one.empty()) continue;
    head.query.emplace(decoded(one.substr(0, equals), ' '), decoded(one.substr(std::min(equals + 1, one.size())), ' '));
  }
  return head;
}

std::string head_text(const HttpAnswer& answer, const std::string& cookie, std::optional<std::size_t> length) {
  std::string text = fmt::format(
      "HTTP/1.1 {} {}\r\nContent-Type: {}\r\nConnection: close\r\nAccept-Ranges: none\r\nCache-Control: no-store\r\n"
      "X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nX-Accel-Buffering: no\r\n"
      "Content-Security-Policy: default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
      "img-src data: blob:; connect-src 'self'; form-action 'none'; base-uri 'none'; frame-ancestors 'none'\r\n",
      answer.status,
      boost::beast::http::obsolete_reason(static_cast<boost::beast::http::status>(answer.status)).to_string(),
      answer.content_type);
  if (length) text += fmt::format("Content-Length: {}\r\n", *length);
  if (!cookie.empty()) text += fmt::format("Set-Cookie: {}\r\n", cookie);
  if (!answer.file_name.empty())
    text += fmt::format("Content-Disposition: attachment; filename=\"{}\"\r\n", answer.file_name);
  return text + "\r\n";
}

}  // namespace vantage
