// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "adasplats/core/maths/extent.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

class Executor;

/// PCD 0.5-0.7: ascii, binary, binary_compressed. COUNT > 1 gives columns name_0, name_1, ...;
/// padding fields `_` are skipped. NaN points are kept (the caller drops and counts them). The
/// comments hold the `#` lines and "VIEWPOINT ...". Memory: 1x the unpacked size; packed twice
/// that, and a packed byte unpacks to at most 88.
Table read_pcd(const std::filesystem::path& path);

/// Which points of a file are wanted.
struct PointSelection {
  /// Those in it, in the coordinates of the file.
  std::optional<Extent> extent;
  /// Of a file with levels of detail (COPC) those of the levels 0 to this, each of which has about
  /// twice as many points a metre as the one before, or as many levels as points so far apart
  /// need, m; where both are given the fewer.
  std::optional<std::uint32_t> level;
  std::optional<double> resolution_m;
  /// Of a file whose records can be read at random (records_at_random()) those of a span.
  std::optional<RecordSpan> records;

  bool asks_levels() const { return level || resolution_m; }
  bool is_all() const { return !extent && !asks_levels() && !records; }
};

/// How many records a file has that need not be read from the first on: LAS, LAZ with a table of
/// chunks, binary PLY. Nothing: they are read all at once. With `salvage` as far as the file goes.
/// Errors: as read_points().
std::optional<std::uint64_t> records_at_random(const std::filesystem::path& path,
                                               bool salvage = false);

/// Throws usage where levels are asked for of a file that has none.
void require_no_levels(const std::filesystem::path& path, const PointSelection& selection);

struct LasReadOptions {
  /// Read the whole records of a truncated file instead of failing; the table's comments say
  /// "salvaged N of M records".
  bool salvage = false;
  /// Unpacks the chunks of LAZ on these threads, else on the caller's.
  const Executor* executor = nullptr;
  PointSelection selection = {};
};

/// LAS and LAZ 1.0-1.4, point formats 0-10, with scale and offset applied: x, y, z (f64), intensity
/// (u16), classification (u8), return_number, number_of_returns (u8), and where the format has them
/// gps_time (f64), red, green, blue (u16), point_source_id (u16), user_data (u8), and the
/// attributes in extra bytes that the file describes, in their types (scaled ones f64).
/// Comments: "geographic: WHAT SAYS SO" where x and y are longitude and latitude, "not metres: X IN
/// UNIT, WHAT SAYS SO" where coordinates are in feet, say, "withheld: N of M points": points that
/// are flagged as withheld are deleted, and left out. LAZ: items of versions 1 to 4 (LASzip 1.0
/// to 3.5); COPC reads as the LAZ that it is, a selection of it without unpacking the rest.
/// Memory: at most 2x the file's size (LAS), what the points take (LAZ; one that has no chunks
/// twice its size, too) and 10 MB a thread. Errors: no_input, io, data; usage (levels of a file
/// without).
Table read_las(const std::filesystem::path& path, const LasReadOptions& options = {});

/// E57 1.x (ASTM E2807): the points of all its scans in world coordinates (each through its pose):
/// x, y, z, where all scans have them red, green, blue, row, column, return_number (from 1),
/// number_of_returns, timestamp (s; of GPS, since 1980-01-06, where all scans say when they began,
/// else since then) and what extensions have, by the name without its prefix ("classification");
/// intensity where any scan has it, as stored (NaN in scans without and where it is invalid), and
/// where a scan has a pose or ranges sensor_x, sensor_y, sensor_z, the scanner's position in the
/// world (NaN for the points of others). All f64. Points whose position is invalid and those in the
/// scanner itself are left out and counted in a comment, "N points without a return". Comments,
/// too: "left out: WHAT" of columns that only some scans have and of images, "geographic: ..." and
/// "not metres: ..." as read_las(). Memory: at most 64 times the file for the values of one scan,
/// once more for the table, and 3 columns. Errors: no_input, io, data.
Table read_e57(const std::filesystem::path& path);

/// The text of `coordinateMetadata`. Errors: as read_e57().
Crs read_e57_crs(const std::filesystem::path& path);

/// Text: XYZ, PTS (a line with a count of points alone), CSV (comma, semicolon, tab or blank; a
/// header line of names is understood, also as a comment; names are in lower case; an empty cell is
/// NaN; `#` and `//` start comments). Without names: x y z; a 4th of 4 or 5 columns is intensity; 7
/// columns are x y z intensity red green blue; 6 of PTS x y z red green blue; others are column_4,
/// ... (from 1). Fewer points than a count says are an error, more are kept with a comment.
/// PTX (by its extension): several scans, brought into world coordinates, with the further columns
/// sensor_x, sensor_y, sensor_z, the scanner's position in the world; points 0 0 0 (no return) are
/// left out, a comment says how many. All columns are f64. Locale-independent.
Table read_text_points(const std::filesystem::path& path);

/// KITTI / SemanticKITTI scan of a sequence: float32 x, y, z, intensity ("remission"),
/// little-endian. The file does not say what it holds, so its values must be possible. Errors: data
/// for an intensity below 0 or above 65535 (one that is not finite is not known), and for what is
/// recognised as five floats a point or CloudCompare's own format.
Table read_kitti_bin(const std::filesystem::path& path);

/// A `.bin` by its name: of nuScenes (`*.pcd.bin`: float32 x, y, z, intensity, ring), else
/// as read_kitti_bin. Errors: data, likewise for a fifth column that holds no rings (whole numbers
/// from 0 to 255).
Table read_bin(const std::filesystem::path& path);

/// Any of the formats above and PLY, by the file's extension (any case) and first bytes, which must
/// not contradict each other. What is not selected is left out: of LAS and LAZ as it is read, of
/// others when all is there.
/// Errors: as theirs; std::logic_error for records of a file that are not at random; an unknown
/// format is ErrorKind::data naming what is understood; usage (levels are asked for, and the file
/// has none).
Table read_points(const std::filesystem::path& path, const LasReadOptions& options = {});

/// The coordinate system that a file of points says, without reading the points. Errors: as theirs.
Crs read_crs(const std::filesystem::path& path);

/// Whether the file is LAS or LAZ, as read_points() takes it. Errors: as theirs.
bool is_las(const std::filesystem::path& path);

/// What a LAS or LAZ file says of itself before its points.
struct LasFacts {
  std::string version;           ///< "1.4"
  std::size_t point_format = 0;  ///< 0 to 10
  std::uint64_t points = 0;
  Vec3d scale, offset;     ///< of the whole numbers that coordinates are stored as
  Vec3d box_min, box_max;  ///< of the points, by the header
  std::string software;
  Crs crs;
};

/// Errors: as read_las().
LasFacts read_las_facts(const std::filesystem::path& path);

}  // namespace adasplats
