// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/io/base/table.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

/// x, y, z (sensor frame, m) and intensity of each point, four floats; unknown intensities are 0.
/// Returned as the bytes of a file, which saves a copy. `order`: indices of the points; empty: as
/// in the scan.
std::string points_with_intensity(const ScanView& scan, std::span<const std::uint32_t> order = {});

/// instance << 16 | class of each point, 0 for missing attributes. `order`: as above.
std::vector<std::uint32_t> packed_labels(const ScanView& scan,
                                         std::span<const std::uint32_t> order = {});

/// Number of returns of each point's firing; points of one firing must be adjacent.
std::vector<std::uint8_t> returns_of_firings(const ScanView& scan);

/// Time of each point relative to the scan's time, which is that of its pose, s; sufficient for
/// motion compensation. Empty if the sensor was at rest: its points need no motion compensation.
std::vector<float> times_from_pose(const ScanView& scan);

/// The attributes of a scan as columns of a file: x y z [intensity] [label] [instance] [ring]
/// [column] [time] [range] [return_index] [vx vy vz]. They are views of `scan` and of `times`, the
/// column `time`. Attributes without a value for every point are omitted.
std::vector<ColumnView> scan_columns(const ScanView& scan, std::span<const float> times);

/// The smallest usual full scale of intensities that covers the highest one: 1, 255 or 65535.
double intensity_scale_for(double highest);

/// Name of scan `index` in data sets, such as "000042".
std::string scan_name(std::size_t index);

/// Creates a folder and its parents. Errors: cannot_create.
void create_folder(const std::filesystem::path& folder);

}  // namespace adasplats
