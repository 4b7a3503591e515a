// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adasplats/evaluate/point_fit.h"
#include "adasplats/jobs/city/city_addition.h"
#include "adasplats/jobs/city/city_work.h"
#include "adasplats/jobs/output/resumable_folder.h"

namespace adasplats {

/// Offset of the points of the last layer from the splats of the city that they are added to, from
/// rays that end in tiles of both. Estimated once and stored in the folder. Errors: data (the
/// offset exceeds AdditionChoice::max_shift_m, so two places would be modelled as one), those of
/// reading.
PointFit require_fit(const CityToExtend& before, const CityWork& work, ResumableFolder& folder);

/// The keys of the report's `fit`.
nlohmann::ordered_json to_json(const PointFit& fit);

}  // namespace adasplats
