// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace adasplats {

/// RFC 4648, padded with =. At most 1 GiB.
std::string to_base64(std::string_view bytes);

/// The decoded bytes, with or without padding; nothing if a character is not base64 or the text has
/// 2 GiB or more.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace adasplats
