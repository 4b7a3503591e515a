// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "adasplats/io/arrays/npy.h"

namespace adasplats {

/// A named array of an .npz.
struct NamedArray {
  std::string name;  ///< letters, digits and underscores
  NpyArray array;
};

/// Writes arrays as an uncompressed .npz, which is a zip archive of .npy files (numpy.savez).
/// The same arrays give the same bytes: files in it have the oldest time of zip. Atomic. Throws
/// std::logic_error for a name that is empty, has other characters or is not unique. Errors: data
/// (4 GiB or more in total, which would need Zip64).
void write_npz(const std::filesystem::path& path, std::span<const NamedArray> arrays);

/// Writes the bytes of that file; errors name `path`.
void put_npz(ByteSink& file, const std::filesystem::path& path, std::span<const NamedArray> arrays);

}  // namespace adasplats
