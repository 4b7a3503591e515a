// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace adasplats {

/// `count` scans of a sequence (or as many as there are) from `first` on, every `stride`-th.
struct ScanRange {
  std::size_t first = 0;
  std::size_t count = static_cast<std::size_t>(-1);
  std::size_t stride = 1;
  bool operator==(const ScanRange&) const = default;
};

/// "FIRST:COUNT[:STRIDE]"; empty for all scans.
std::string text_of(const ScanRange& range);

/// Numbers of the scans in a range, for a sequence in `folder` with `scans` scans. Errors: usage
/// (the range is empty).
std::vector<std::size_t> chosen_scans(const ScanRange& range, std::size_t scans,
                                      const std::filesystem::path& folder);

}  // namespace adasplats
