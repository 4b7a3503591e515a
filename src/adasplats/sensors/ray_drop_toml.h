// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For sources alone: toml++ is heavy.

#include <toml++/toml.h>

#include <filesystem>

#include "adasplats/sensors/ray_drop_model.h"

namespace adasplats {

/// What a table with the keys of ray_drop_toml() says. `path`: its file, for errors. Errors: config
/// with the line.
RayDropModel ray_drop_of_table(const toml::table& table, const std::filesystem::path& path);

}  // namespace adasplats
