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

/// x, y, z (sensor frame, m) and intensity of each point, four floats; intensity 0 where it is not
/// known. As the bytes of a file: a copy less of what is most of a data set.
/// `order`: which point is the i-th; empty: the i-th.
std::string points_with_intensity(const ScanView& scan, std::span<const std::uint32_t> order = {});

/// instance << 16 | class of each point, 0 for what the scan does not have.
/// `order` as there.
std::vector<std::uint32_t> packed_labels(const ScanView& scan,
                                         std::span<const std::uint32_t> order = {});

/// How many returns the firing of each point has; points of one firing stand side by side.
std::vector<std::uint8_t> returns_of_firings(const ScanView& scan);

/// When each point was measured, s from the scan's own time (negative before it), which is that of
/// its pose; who takes the motion out needs no more. Empty where the sensor stood still: there is
/// no motion to take out of its points, whenever they were measured.
std::vector<float> times_from_pose(const ScanView& scan);

/// What the scan has, as columns of a file: x y z [intensity] [label] [instance] [ring] [column]
/// [time] [range] [return_index]. They are views of `scan` and of `times`, the column `time`.
/// Attributes with another number of values than points are left out.
std::vector<ColumnView> scan_columns(const ScanView& scan, std::span<const float> times);

/// "000042": how data sets name scan `index`.
std::string scan_name(std::size_t index);

/// Creates a folder and those above it. Errors: cannot_create.
void create_folder(const std::filesystem::path& folder);

}  // namespace adasplats
