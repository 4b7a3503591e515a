// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace adasplats {

/// Number `index`, zero-padded to at least this number of digits.
std::string padded_number(std::size_t index, std::size_t digits);

/// A deterministic token for `name`, like those of nuScenes: 32 hexadecimal digits of its SHA-256.
std::string token_of(std::string_view name);

/// The same, with the dashes of a UUID.
std::string uuid_of(std::string_view name);

}  // namespace adasplats
