// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/maths/extent.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

class Executor;

/// PCD 0.5-0.7: ascii, binary, binary_compressed. COUNT > 1 gives columns name_0, name_1, ...;
/// padding fields `_` are skipped. NaN points are kept (the caller drops and counts them). The
/// comments are the `#` lines, "VIEWPOINT ..." and, of organised clouds, "HEIGHT ...". Memory: 1x
/// the uncompressed size, 2x for compressed files, where a byte expands to at most 88.
Table read_pcd(const std::filesystem::path& path);

/// The points of a file to read.
struct PointSelection {
  /// Points in this box, in the coordinates of the file.
  std::optional<Extent> extent;
  /// Of a file with levels of detail (COPC) the levels 0 to `level`, each with about half the point
  /// spacing of the previous one, or as many levels as a spacing of `resolution_m` needs; if both
  /// are given, the fewer.
  std::optional<std::uint32_t> level;
  std::optional<double> resolution_m;
  /// Of a file with random access (random_access_records()) these records.
  std::optional<RecordSpan> records;

  bool has_levels() const { return level || resolution_m; }
  bool is_all() const { return !extent && !has_levels() && !records; }
};

/// The number of records of a file with random access: LAS, LAZ with a chunk table, binary PLY.
/// Nothing for other files. With `salvage` the records within a truncated file. Errors: as
/// read_points().
std::optional<std::uint64_t> random_access_records(const std::filesystem::path& path,
                                                   bool salvage = false);

/// Throws usage if the selection has levels, for files without levels of detail.
void require_no_levels(const std::filesystem::path& path, const PointSelection& selection);

struct LasReadOptions {
  /// Read the complete records of a truncated file instead of failing, with a note.
  bool salvage = false;
  /// Decompresses the chunks of LAZ on these threads; nullptr: on the calling thread.
  const Executor* executor = nullptr;
  PointSelection selection = {};
  /// Read every field of the points, else those that models use.
  bool all_fields = false;
};

/// LAS and LAZ 1.0-1.4, point formats 0-10, with scale and offset applied: x, y, z (f64), intensity
/// (u16), classification (u8), return_number, number_of_returns (u8), if the format has them
/// gps_time (f64), red, green, blue (u16), point_source_id (u16), user_data (u8), and the
/// attributes in extra bytes that the file describes, in their types (scaled ones f64). With
/// `all_fields` also scan_angle (f32, degrees), nir (u16), synthetic, key_point, overlap,
/// scanner_channel, scan_direction_flag and edge_of_flight_line (u8), those with other values than
/// 0, and a note of what was not read. Points
/// flagged as withheld (deleted) are left out, with a note; further notes: NoteKind. LAZ: items of
/// versions 1 to 4 (LASzip 1.0 to 3.5); of COPC only the selected chunks are decompressed.
/// Memory: at most 2x the file's size (LAS), the table (LAZ; without chunks also twice the file's
/// size) and 10 MB a thread. Errors: no_input, io, data; usage (levels of a file without).
Table read_las(const std::filesystem::path& path, const LasReadOptions& options = {});

/// E57 1.x (ASTM E2807): the points of all scans in world coordinates (by their poses): x, y, z; if
/// all scans have them red, green, blue, row, column, return_number (from 1), number_of_returns,
/// timestamp (s; GPS time since 1980-01-06 if all scans state their start, else since the start)
/// and columns of extensions, by the name without prefix ("classification"); intensity if any scan
/// has it, as stored (NaN in other scans and where it is invalid); and if a scan has a pose or
/// ranges sensor_x, sensor_y, sensor_z, the scanner's position in the world (NaN for the points of
/// other scans). All f64. Points without a valid position and those at the scanner itself are left
/// out, with a note; so are images and columns of only some scans. Memory: at most 64 times the
/// file for the values of one scan, once more for the table, and 3 columns. Errors: no_input, io,
/// data.
Table read_e57(const std::filesystem::path& path);

/// The system in `coordinateMetadata`. Errors: as read_e57().
Crs read_e57_crs(const std::filesystem::path& path);

/// Text: XYZ, PTS (with lines that contain only a count of points), CSV (separated by comma,
/// semicolon, tab or blank; with an optional header line of names, possibly as a comment; names
/// become lower case; an empty cell is NaN; `#` and `//` start comments). Without names: x y z; the
/// 4th of 4 or 5 columns is intensity; 7 columns are x y z intensity red green blue; 6 of PTS x y z
/// red green blue; others are column_4, ... (from 1). Fewer points than a count states are an
/// error, more are kept with a note. All columns are f64. Independent of the locale. Reads PTX by
/// read_ptx().
Table read_text_points(const std::filesystem::path& path);

/// Leica PTX: scans of columns x rows points in the scanner's frame, each with the 4x4 matrix into
/// the world. Gives world coordinates x, y, z, intensity, if present red, green, blue, and
/// sensor_x, sensor_y, sensor_z, the scanner's position in the world; all f64. Points without a
/// return (0 0 0 in the scanner's frame) are left out, with a note. A single station with the
/// identity matrix gets a note. Errors: also data (several stations, all with the identity).
Table read_ptx(const std::filesystem::path& path);

/// Whether a file is a PTX whose first station has the identity matrix and the position 0. Errors:
/// as read_points().
bool is_ptx_in_own_frame(const std::filesystem::path& path);

/// KITTI / SemanticKITTI scan of a sequence: float32 x, y, z, intensity ("remission"),
/// little-endian. The format has no header, so the values are checked. Errors: data for an
/// intensity below 0 or above 65535 (one that is not finite is unknown), and for files recognized
/// as five floats a point or as CloudCompare's own format.
Table read_kitti_bin(const std::filesystem::path& path);

/// A `.bin` by its name: of nuScenes (`*.pcd.bin`: float32 x, y, z, intensity, ring), else
/// as read_kitti_bin. Errors: data, also for a fifth column that is not a ring (integers from 0 to
/// 255).
Table read_bin(const std::filesystem::path& path);

/// Reads any of the formats above and PLY, by the extension (any case) and the first bytes, which
/// must not contradict each other. Points that are not selected are dropped: of LAS and LAZ while
/// reading, of other formats afterwards. Errors: those of the formats; data (an unknown format,
/// with the supported ones); usage (levels of a file without); std::logic_error for records of a
/// file without random access.
Table read_points(const std::filesystem::path& path, const LasReadOptions& options = {});

/// The lines that begin with # at the start of a PCD or text, without the sign. Errors: no_input,
/// io, data (not a text).
std::vector<std::string> leading_comments(const std::filesystem::path& path);

/// The coordinate system of a point file, without reading the points. Errors: as read_points().
Crs read_crs(const std::filesystem::path& path);

/// Whether read_points() reads the file as LAS or LAZ. Errors: as read_points().
bool is_las(const std::filesystem::path& path);

/// The main facts in the header of a LAS or LAZ file.
struct LasFacts {
  std::string version;           ///< "1.4"
  std::size_t point_format = 0;  ///< 0 to 10
  std::uint64_t points = 0;
  Vec3d scale, offset;     ///< of the integers that store coordinates
  Vec3d box_min, box_max;  ///< of the points, as in the header
  std::string software;
  Crs crs;
  std::vector<std::string> extra_fields;  ///< names of the described extra bytes
  std::string labels;  ///< label scheme, in files of this program; empty: not stated
};

/// Errors: as read_las().
LasFacts read_las_facts(const std::filesystem::path& path);

}  // namespace adasplats
