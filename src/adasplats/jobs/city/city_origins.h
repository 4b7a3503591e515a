// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "adasplats/jobs/city/city_work.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/splats/consistent/origin_check.h"

namespace adasplats {

/// Checks where the beams of a city's last layer started, as build_model() does of one model, by
/// tiles all over it: needs the spacing of its cells and the rays. What an earlier run has found is
/// taken. Nothing where there are no beams, or they are not to be checked. Warns of doubts. Errors:
/// data (origin_objection()).
std::optional<OriginCheck> check_city_origins(const CityWork& work, ResumableFolder& folder);

}  // namespace adasplats
