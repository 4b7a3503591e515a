// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace adasplats {

/// Address and port on which a server listens.
struct ListenAddress {
  std::string address;  ///< numeric
  std::uint16_t port = 0;
};

/// The decoded path after "/TOKEN/" of a request's target, without its query. Nothing if the target
/// has another start, invalid percent-encoding (RFC 3986, 2.1), or an invalid path: segments "."
/// and
/// "..", backslashes, control characters. Decoded once, so "%252e" becomes "%2e". Takes the same
/// time however many characters of the token are right.
std::optional<std::string> path_after_token(std::string_view target, std::string_view token);

/// Whether a request's Host (RFC 9110, 7.2) is this server: the address, "localhost", "127.0.0.1"
/// or
/// "[::1]" with its port; any numeric address if the server listens beyond this machine. Rejects
/// domain names that resolve to this machine (DNS rebinding).
bool is_own_host(std::string_view host, const ListenAddress& address);

/// Whether an Origin (RFC 6454, 7) is a page served by `host`, a request's Host.
bool is_own_origin(std::string_view origin, std::string_view host);

/// Whether an address is a loopback address: 127.0.0.0/8 or ::1.
bool is_loopback(const std::string& address);

/// "127.0.0.1:8123" or "[::1]:8123"; the loopback address if the server listens on all addresses.
std::string host_of(const ListenAddress& listening);

}  // namespace adasplats
