// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/core/words.h"
#include "adasplats/evaluate/realism/scan_part.h"

namespace adasplats {

/// What a feature is of. Context tells where a patch is and takes part in all tests: what noise is
/// usual depends on the range. It is coarse, so that it tells no noise by itself.
enum class FeatureGroup : std::uint8_t { context, geometry, dropout, intensity };
inline constexpr std::pair<std::string_view, FeatureGroup> kFeatureGroups[] = {
    {"context", FeatureGroup::context},
    {"geometry", FeatureGroup::geometry},
    {"dropout", FeatureGroup::dropout},
    {"intensity", FeatureGroup::intensity}};
inline Words<FeatureGroup> words_of(FeatureGroup) { return kFeatureGroups; }

/// A patch of a range image: rings by columns (azimuth steps).
inline constexpr std::size_t kPatchRings = 8;
inline constexpr std::size_t kPatchColumns = 64;
/// A patch with fewer returns, a quarter of its cells, is sky or void and tells nothing.
inline constexpr std::size_t kMinInPatch = kPatchRings * kPatchColumns / 4;

/// One number of a patch; NaN where the patch does not have it.
struct PatchFeature {
  const char* name;
  FeatureGroup group;
  const char* unit;  ///< "" of shares, ratios and logarithms
  const char* text;
  double (*of)(const PartCounts&);
};

/// All features, in the order of the columns of patch_features(). The one place that knows them.
std::span<const PatchFeature> patch_features();

/// Features of all patches of a scan, patch by patch. Patches are 8 rings high, from the top, and
/// cut the turn into equal sectors as near to 64 steps as it goes; those with fewer than
/// kMinInPatch returns are left out. Needs count_missing().
std::vector<float> features_of_patches(const RingScan& scan, double step_rad);

/// What a scan as a whole says, beside the tests: the statistics that users see side by side.
struct ScanStatistic {
  const char* name;
  const char* unit;
  const char* text;
};

/// What of a scan does not lie in its rings.
struct ScanFile {
  std::size_t unfolded_rings = 0;
  std::size_t near_points = 0;  ///< nearer than kNear_m to the origin of the scan's frame
};

/// All statistics, in the order of statistics_of_scan().
std::span<const ScanStatistic> scan_statistics();
std::vector<double> statistics_of_scan(const RingScan& scan, double step_rad, const ScanFile& file);

/// Nearer points are mostly on the vehicle itself (so is ResimulateOptions::min_range_m chosen).
inline constexpr double kNear_m = 2.5;

}  // namespace adasplats
