// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "adasplats/cloud/origins/track.h"
#include "adasplats/core/progress.h"

namespace adasplats {

/// Of scans that were measured within `spans_s`, in the clock of the poses, those that poses cover,
/// by their numbers. Others are told of; `scans` is what they are called. Errors: data where more
/// than half of them are not covered.
std::vector<std::size_t> covered_scans(std::span<const TimeSpan> spans_s, const Track& track,
                                       const std::filesystem::path& path, const char* scans,
                                       ProgressSink& progress);

}  // namespace adasplats
