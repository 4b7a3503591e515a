// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/serve/request_check.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <system_error>

namespace adasplats {
namespace {

/// An address as 4 or 16 bytes, because different texts may mean the same address.
struct NumericAddress {
  int family = AF_UNSPEC;
  std::array<unsigned char, 16> bytes{};
  bool operator==(const NumericAddress&) const = default;
};

NumericAddress numeric_address(const std::string& text) {
  NumericAddress result;
  for (const int family : {AF_INET, AF_INET6}) {
    if (inet_pton(family, text.c_str(), result.bytes.data()) != 1) continue;
    result.family = family;
    return result;
  }
  return {};
}

/// Compares every byte, so that the time does not depend on the number of equal bytes.
bool equal_in_constant_time(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = static_cast<unsigned char>(difference | (a[i] ^ b[i]));
  return difference == 0;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    const std::string_view digits = text.substr(i + 1, 2);
    unsigned char value = 0;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (digits.size() != 2 || error != std::errc{} || end != digits.data() + 2) return std::nullopt;
    decoded += static_cast<char>(value);
    i += 2;
  }
  return decoded;
}

bool is_plain_path(std::string_view path) {
  const bool plain = std::none_of(path.begin(), path.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\';
  });
  if (!plain) return false;
  while (true) {
    const std::size_t slash = path.find('/');
    const std::string_view segment = path.substr(0, slash);
    if (segment == "." || segment == "..") return false;
    if (slash == std::string_view::npos) return true;
    path.remove_prefix(slash + 1);
  }
}

struct HostAndPort {
  std::string name;  ///< without brackets
  bool in_brackets = false;
  std::uint16_t port = 80;  ///< default of HTTP
};

std::optional<HostAndPort> split_host(std::string_view host) {
  HostAndPort result;
  const bool bracket = host.starts_with('[');
  const std::size_t end = bracket ? host.find(']') : host.find(':');
  if (bracket && end == std::string_view::npos) return std::nullopt;
  result.name = std::string(host.substr(bracket ? 1 : 0, bracket ? end - 1 : end));
  result.in_brackets = bracket;
  if (result.name.find('\0') != std::string::npos) return std::nullopt;
  std::string_view rest = host.substr(std::min(host.size(), bracket ? end + 1 : end));
  if (rest.empty()) return result;
  rest.remove_prefix(1);
  const char* last = rest.data() + rest.size();
  const auto [parsed, error] = std::from_chars(rest.data(), last, result.port);
  if (error != std::errc{} || parsed != last) return std::nullopt;
  return result;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c - '\0'; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

std::optional<std::string> path_after_token(std::string_view target, std::string_view token) {
  target = target.substr(0, target.find_first_of("?#"));
  if (target.size() < token.size() + 2 || target[0] != '/' || target[token.size() + 1] != '/' ||
      !equal_in_constant_time(target.substr(1, token.size()), token))
    return std::nullopt;
  std::optional<std::string> path = percent_decoded(target.substr(token.size() + 2));
  if (path && !is_plain_path(*path)) return std::nullopt;
  return path;
}

bool is_loopback(const std::string& address) {
  const NumericAddress numeric = numeric_address(address);
  return (numeric.family == AF_INET && numeric.bytes[0] == 127) ||
         (numeric.family == AF_INET6 && numeric == numeric_address("::1"));
}

bool is_own_host(std::string_view host, const ListenAddress& address) {
  const std::optional<HostAndPort> split = split_host(host);
  if (!split || split->port != address.port) return false;
  if (!split->in_brackets && equal_ignoring_case(split->name, "localhost")) return true;
  const NumericAddress numeric = numeric_address(split->name);
  // IPv6 addresses have brackets, IPv4 addresses do not (RFC 3986, 3.2.2).
  if (numeric.family != (split->in_brackets ? AF_INET6 : AF_INET)) return false;
  return numeric == numeric_address(address.address) || numeric == numeric_address("127.0.0.1") ||
         numeric == numeric_address("::1") || !is_loopback(address.address);
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return equal_ignoring_case(origin.substr(0, kScheme.size()), kScheme) &&
         equal_ignoring_case(origin.substr(kScheme.size()), host);
}

std::string host_of(const ListenAddress& listening) {
  const NumericAddress numeric = numeric_address(listening.address);
  const bool six = numeric.family == AF_INET6;
  std::string address = listening.address;
  if (numeric.bytes == NumericAddress{}.bytes) address = six ? "::1" : "127.0.0.1";
  if (six) address = std::string("[") + address + "]";
  return address + ":" + std::to_string(listening.port);
}

}  // namespace adasplats
