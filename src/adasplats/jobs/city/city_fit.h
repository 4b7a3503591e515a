// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adasplats/evaluate/point_fit.h"
#include "adasplats/jobs/city/city_addition.h"
#include "adasplats/jobs/city/city_work.h"
#include "adasplats/jobs/output/resumable_folder.h"

namespace adasplats {

/// How the points of the last layer lie beside the splats of the city that they are added to, by
/// rays that end in tiles of both, all over what they have in common; found once, and kept in the
/// folder. Errors: data (they lie farther beside than AdditionChoice::max_shift_m: two places
/// would be modelled as one), those of reading.
PointFit require_fit(const CityToExtend& before, const CityWork& work, ResumableFolder& folder);

/// The keys of the report's `fit`.
nlohmann::ordered_json to_json(const PointFit& fit);

}  // namespace adasplats
