// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "adasplats/io/base/table.h"

namespace adasplats {

/// Writes comma-separated text: lines "# COMMENT", a line with the names of the columns, and `rows`
/// lines of numbers that read back as the same values (NaN: "nan"). Atomic. Errors: cannot_create,
/// io. Throws std::logic_error for a name that is empty or has commas, quotes or line breaks.
void write_csv(const std::filesystem::path& path, std::size_t rows,
               std::span<const ColumnView> columns, std::span<const std::string> comments = {});

}  // namespace adasplats
