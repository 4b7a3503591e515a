// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "adasplats/io/arrays/npy.h"

namespace adasplats {

/// One array of an .npz under its name.
struct NamedArray {
  std::string name;  ///< letters, digits and underscores
  NpyArray array;
};

/// Writes arrays as an uncompressed .npz, which is a zip archive of .npy files (numpy.savez).
/// The same arrays give the same bytes: files in it have the oldest time that zip knows. Atomic.
/// Throws std::logic_error for a name that is empty, has other characters or comes twice. Errors:
/// data (4 GiB or more in all, which needs another kind of zip).
void write_npz(const std::filesystem::path& path, std::span<const NamedArray> arrays);

/// The bytes of that file; errors name `path`.
void put_npz(ByteSink& file, const std::filesystem::path& path, std::span<const NamedArray> arrays);

}  // namespace adasplats
