#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace vantage {

/// What a request says of who sends it.
struct Caller {
  std::string host = {};           // header Host
  std::string origin = {};         // header Origin, which browsers send
  std::string query_token = {};    // ?token=
  std::string cookies = {};        // header Cookie
  std::string authorization = {};  // header Authorization
};

/// A request that is not let in.
struct Refusal {
  int status;  // of HTTP
  std::string text;
};

/// In small letters (ASCII), as names in headers compare.
[[nodiscard]] std::string lower(std::string text);

/// Why the caller is not let in by a server with this token (empty: whoever is on this machine), or nothing. Without a
/// token the request must name this machine, which keeps other web pages from reaching the server through DNS. Pages of
/// other servers are refused in any case. `cookie` is the name of the cookie that holds the token.
[[nodiscard]] std::optional<Refusal> why_refused(const Caller& caller, const std::string& token,
                                                 const std::string& cookie);

/// Whether the texts are the same, in a time that depends on the length of `given` alone.
[[nodiscard]] bool same_secret(std::string_view given, std::string_view secret);

/// Of tokens, characters.
inline constexpr std::size_t shortest_token = 16;

/// Whether the text is an IPv4 or IPv6 address as it is written in full, or may be the name of a machine. Short forms
/// of numbers like 0 or 127.1 are neither.
[[nodiscard]] bool is_address(const std::string& host);

/// Whether only programs of this machine reach `host`.
[[nodiscard]] bool is_loopback(const std::string& host);

}  // namespace vantage
