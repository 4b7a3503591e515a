// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adasplats/jobs/compare/comparison_data.h"

namespace adasplats {

/// What the paper prints for the data set of a preset: {"table", "source", "rows": [{"title",
/// "name", "generate_s", "primitives", "render_hz", "lidar_hz", "c2c_m", "thin"}]}. For
/// Preset::none the rows of PC3D-Paris, as a yardstick.
nlohmann::ordered_json paper_figures(Preset preset);

}  // namespace adasplats
