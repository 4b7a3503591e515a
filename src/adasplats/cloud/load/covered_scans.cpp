// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/covered_scans.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <string>

#include "adasplats/core/error.h"

namespace adasplats {

std::vector<std::size_t> covered_scans(std::span<const TimeSpan> spans_s, const Track& track,
                                       const std::filesystem::path& path, const char* scans,
                                       ProgressSink& progress) {
  const TimeSpan covered = track.covered_s();
  const auto is_covered = [&](const TimeSpan& span) {
    // The last gap that begins before the scan ends.
    const auto behind = std::ranges::lower_bound(track.gaps, span.last, {}, &TimeSpan::first);
    const bool in_gap = behind != track.gaps.begin() && span.first < std::prev(behind)->last;
    return span.first >= covered.first && span.last <= covered.last && !in_gap;
  };
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < spans_s.size(); ++k)
    if (is_covered(spans_s[k])) kept.push_back(k);
  const std::size_t all = spans_s.size();
  if (kept.size() == all) return kept;
  std::array<char, 320> text{};
  std::snprintf(text.data(), text.size(),
                ": %zu of %zu %s (%.3f to %.3f s) were made when there are no poses (these are of "
                "%.3f to %.3f s, with %zu gaps); nothing is extrapolated",
                all - kept.size(), all, scans, spans_s.front().first, spans_s.back().last,
                track.measured_s.first, track.measured_s.last, track.gaps.size());
  if (2 * kept.size() < all)
    throw Error(ErrorKind::data, path.string() + text.data() +
                                     ": the clocks differ (`time_offset` states by how much), or "
                                     "the poses are of another drive");
  progress.warn(path.string() + text.data() + ", so they are left out");
  return kept;
}

}  // namespace adasplats
