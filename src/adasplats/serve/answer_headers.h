// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace adasplats {

/// On every answer: the page and its data are for the page alone, and it loads from here alone.
/// connect-src 'self' holds for ws: of the same host and port, too (Content Security Policy 3,
/// 6.7.2.8).
inline constexpr const char* kSafetyHeaders[][2] = {
    {"Cache-Control", "no-store"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Content-Security-Policy",
     "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; "
     "connect-src 'self'; worker-src 'self' blob:; frame-ancestors 'none'; base-uri 'none'; "
     "form-action 'none'"},
};

/// Adds them to a message with set(name, value).
template <class Message>
void set_safety_headers(Message& message) {
  for (const auto& [name, value] : kSafetyHeaders) message.set(name, value);
}

}  // namespace adasplats
