// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace adasplats {

/// RFC 4648, with = at the end.
std::string to_base64(std::string_view bytes);

/// Nothing where a character is none of base64.
std::optional<std::string> from_base64(std::string_view text);

}  // namespace adasplats
