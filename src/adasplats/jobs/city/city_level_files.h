// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/city/city_manifest.h"
#include "adasplats/jobs/output/resumable_folder.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// Writes and records the levels of detail of a city whose tiles are all modelled
/// (city/city_levels.h), but those that an earlier run recorded.
void write_level_files(const CityManifest& city, ResumableFolder& folder, Session& session);

}  // namespace adasplats
