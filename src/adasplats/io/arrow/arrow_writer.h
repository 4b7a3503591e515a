// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/io/arrow/arrow_file.h"

namespace adasplats {

/// The bytes of an Arrow IPC file (Feather version 2) with one record batch, uncompressed: the
/// columns of text by name, then those of numbers in their order, without null values. Every column
/// has `numbers.rows` values (otherwise std::logic_error). Errors: data (texts of a column that
/// exceed 2 GiB).
std::string arrow_file_bytes(const ArrowTable& table);

}  // namespace adasplats
