// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace adasplats {

/// Where a server listens.
struct ListeningPlace {
  std::string address;  ///< numeric
  std::uint16_t port = 0;
};

/// The decoded path behind "/TOKEN/" of a request's target, without its query. Nothing where the
/// target does not begin so, its percent-encoding is broken (RFC 3986, 2.1), or what it names can
/// be no path of ours: "." and ".." as segments, backslashes, control characters. It is decoded
/// once, so "%252e" stays "%2e". How long it takes does not depend on how much of a token is right.
std::optional<std::string> path_behind_token(std::string_view target, std::string_view token);

/// Whether a request's Host (RFC 9110, 7.2) is one that our page has: the address, "localhost",
/// "127.0.0.1" or "[::1]" with our port; any numeric address where we listen beyond this machine. A
/// name of somebody's domain that was made to lead here (DNS rebinding) is none.
bool is_own_host(std::string_view host, const ListeningPlace& place);

/// Whether an Origin (RFC 6454, 7) is the page that `host`, a request's Host, has served.
bool is_own_origin(std::string_view origin, std::string_view host);

/// Whether an address is of this machine alone: 127.0.0.0/8 or ::1.
bool is_loopback(const std::string& address);

/// "127.0.0.1:8123" or "[::1]:8123"; for an address that stands for all, the loopback one.
std::string host_of(const ListeningPlace& place);

}  // namespace adasplats
