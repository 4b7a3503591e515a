// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/io/table.h"

namespace adasplats {

/// PCD 0.5-0.7: ascii, binary, binary_compressed. COUNT > 1 gives columns name_0, name_1, ...;
/// padding fields `_` are skipped. NaN points are kept (the caller drops and counts them).
Table read_pcd(const std::filesystem::path& path);

struct LasReadOptions {
  /// Read the whole records of a truncated file instead of failing; the table's comments say
  /// "salvaged N of M records".
  bool salvage = false;
};

/// LAS 1.0-1.4, point formats 0-10, with scale and offset applied: x, y, z (f64), intensity (u16),
/// classification (u8), return_number, number_of_returns (u8), and where the format has them
/// gps_time (f64), red, green, blue (u16), point_source_id (u16), user_data (u8). LAZ through
/// LASzip where it was found at build time, else an error that says what to install.
Table read_las(const std::filesystem::path& path, const LasReadOptions& options = {});

/// Text: XYZ, PTS (first line a count), CSV (comma, semicolon, tab or blank; a header line of
/// names is understood; `#` and `//` start comments). Without names: x y z, then intensity where
/// there is a 4th or 7th column (PTS: x y z intensity r g b). Locale-independent.
Table read_text_points(const std::filesystem::path& path);

/// KITTI / SemanticKITTI scan: float32 x, y, z, intensity ("remission"), little-endian.
Table read_kitti_bin(const std::filesystem::path& path);

/// Any of the formats above and PLY, by the file's extension and first bytes.
/// Errors: as theirs; an unknown format is ErrorKind::data naming what is understood.
Table read_points(const std::filesystem::path& path, const LasReadOptions& options = {});

}  // namespace adasplats
