// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/session/scan_range.h"

#include "adasplats/core/error.h"

namespace adasplats {

std::string text_of(const ScanRange& range) {
  if (range == ScanRange()) return "";
  return std::to_string(range.first) + ":" + std::to_string(range.count) +
         (range.stride == 1 ? "" : ":" + std::to_string(range.stride));
}

std::vector<std::size_t> chosen_scans(const ScanRange& range, std::size_t scans,
                                      const std::filesystem::path& folder) {
  if (range.stride == 0)
    throw Error(ErrorKind::usage, "scans: the stride is 0, expected 1 or more");
  std::vector<std::size_t> chosen;
  for (std::size_t i = range.first; i < scans && chosen.size() < range.count; i += range.stride)
    chosen.push_back(i);
  if (!chosen.empty()) return chosen;
  throw Error(ErrorKind::usage,
              "scans: " + folder.string() + " has only " + std::to_string(scans) + " scans");
}

}  // namespace adasplats
