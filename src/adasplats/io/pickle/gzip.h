// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace adasplats {

/// A gzip member (RFC 1952) of `bytes`, without name and time, so that it is reproducible.
std::string gzipped(std::string_view bytes);

/// The content of the members of a gzip file. `file` is for messages. Memory: twice the content,
/// which is at most `max_bytes`. Errors: data (not gzip, damaged, truncated, more than
/// `max_bytes`).
std::string gunzipped(const std::filesystem::path& file, std::string_view bytes,
                      std::size_t max_bytes);

}  // namespace adasplats
