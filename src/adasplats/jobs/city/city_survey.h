// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/jobs/city/city_work.h"
#include "adasplats/jobs/output/resumable_folder.h"

namespace adasplats {

/// How dense the cells of the city are, by tiles all over it: needs the sorted points. What an
/// earlier run has found is taken.
void survey_spacing(CityWork& work, ResumableFolder& folder);

/// Reads what was found.
TypicalSpacing load_spacing(const std::filesystem::path& file);

}  // namespace adasplats
