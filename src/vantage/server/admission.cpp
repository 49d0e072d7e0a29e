#include "vantage/server/admission.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <cctype>

#include "vantage/core/error.hpp"

namespace vantage {
namespace {

constexpr std::size_t longest_host_name = 253;  // of DNS

/// The name in a Host header, without port and brackets.
std::string host_name(const std::string& header) {
  if (header.starts_with('[')) return header.substr(1, header.find(']') - 1);
  return lower(header.substr(0, header.find(':')));
}

std::string cookie_value(const std::string& cookies, const std::string& name) {
  std::size_t at = 0;
  while (at < cookies.size()) {
    const std::size_t end = std::min(cookies.find(';', at), cookies.size());
    const std::string one = cookies.substr(at, end - at);
    const std::size_t begin = one.find_first_not_of(' ');
    if (begin != std::string::npos && one.compare(begin, name.size() + 1, name + "=") == 0)
      return one.substr(begin + name.size() + 1);
    at = end + 1;
  }
  return {};
}

}  // namespace

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool same_secret(std::string_view given, std::string_view secret) {
  unsigned difference = given.size() == secret.size() ? 0 : 1;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char other = secret.empty() ? '\0' : secret[i % secret.size()];
    difference |= static_cast<unsigned char>(given[i] ^ other);
  }
  return difference == 0;
}

bool is_address(const std::string& host) {
  in_addr v4{};
  in6_addr v6{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return true;
  if (inet_pton(AF_INET6, host.substr(0, host.find('%')).c_str(), &v6) == 1) return true;
  const auto in_names = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '.'; };
  if (host.empty() || host.size() > longest_host_name || !std::all_of(host.begin(), host.end(), in_names)) return false;
  // A name that ends in a number would be taken for an address.
  const std::string last = lower(host.substr(host.find_last_of('.') + 1));
  return !last.empty() && !last.starts_with("0x") && last.find_first_not_of("0123456789") != std::string::npos;
}

bool is_loopback(const std::string& host) {
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24U) == 127;
  return lower(host) == "localhost" || host == "::1";
}

std::optional<Refusal> why_refused(const Caller& caller, const std::string& token, const std::string& cookie) {
  if (!caller.origin.empty() && !caller.origin.ends_with("//" + caller.host)) {
    return Refusal{403, concat("Origin = ", caller.origin, ": this server answers only to its own pages")};
  }
  if (token.empty()) {
    if (is_loopback(host_name(caller.host))) return std::nullopt;
    return Refusal{403, concat("Host = ", caller.host, ": must be localhost or 127.0.0.1, this server's own name")};
  }
  const bool is_bearer = caller.authorization.starts_with("Bearer ");
  for (const std::string& given : {caller.query_token, cookie_value(caller.cookies, cookie),
                                   is_bearer ? caller.authorization.substr(7) : std::string()}) {
    if (same_secret(given, token)) return std::nullopt;
  }
  return Refusal{401,
                 "token: is missing or wrong; send the header 'Authorization: Bearer TOKEN', or open the address that "
                 "the program printed"};
}

}  // namespace vantage
