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

/// Kind of a feature. Context locates a patch and is part of all tests, because the usual noise
/// depends on the range. It is coarse, so it does not reveal noise itself.
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
/// Patches with fewer returns, a quarter of the cells, are sky or void and are ignored.
inline constexpr std::size_t kMinInPatch = kPatchRings * kPatchColumns / 4;

/// One number of a patch; NaN if undefined.
struct PatchFeature {
  const char* name;
  FeatureGroup group;
  const char* text;  ///< definition, for readers of the table
  double (*of)(const PartCounts&);
};

/// All features, in the order of the columns of features_of_patches().
std::span<const PatchFeature> patch_features();

/// Features of all patches of a scan, patch by patch. Patches are 8 rings high, from the top, and
/// divide the turn into equal sectors of about 64 steps; those with fewer than kMinInPatch returns
/// are left out. Requires count_missing().
std::vector<float> features_of_patches(const RingScan& scan, double step_rad);

/// A statistic of a whole scan, reported for both sides in addition to the tests.
struct ScanStatistic {
  const char* name;
  const char* unit;
  const char* text;
};

/// Properties of a scan that its rings do not have.
struct ScanFile {
  std::size_t unfolded_rings = 0;
  std::size_t near_points = 0;  ///< nearer than kNear_m to the origin of the scan's frame
};

/// All statistics, in the order of statistics_of_scan().
std::span<const ScanStatistic> scan_statistics();
std::vector<double> statistics_of_scan(const RingScan& scan, double step_rad, const ScanFile& file);

/// Nearer points are mostly on the vehicle itself (like ResimulateOptions::min_range_m).
inline constexpr double kNear_m = 2.5;

}  // namespace adasplats
