// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats {

/// Where a line of a timed pose has time, x, y, z, qw, qx, qy and qz.
struct PoseColumns {
  std::array<std::size_t, 8> of{};
  std::optional<std::size_t> nanoseconds;  ///< of a time in two columns: seconds, and these
  double time_unit_s = 1;
  std::size_t count = 0;  ///< all columns of the line

  /// TUM's: time, x, y, z, qx, qy, qz, qw.
  static PoseColumns tum();
};

/// What a line says of the columns below it.
struct PoseHeading {
  std::optional<PoseColumns> columns;
  /// Where it names some of them, but not each or not clearly: what is wrong, and what is expected.
  std::string problem;
};

/// The columns that a line names, as programs call them, in any order and case:
/// - the time `time`, `timestamp`, `stamp`, `t`, `sec`, ..., in s or as a unit behind the name says
///   (`timestamp_ns`, `time [us]`), or seconds and nanoseconds (`secs`, `nsecs`);
/// - the position `x`, `tx`, `px`, `pos_x`, `position.x`, `p_RS_R_x [m]`, ...;
/// - the quaternion `qw`, `q_w`, `quat_w`, `orientation.w`, `pose.pose.orientation.w`, ... Numbers
///   (`q0`) do not say which is the scalar: they are a problem, not an order.
/// Other names are skipped. The line may be a comment (`#`, `%`).
PoseHeading pose_heading_of(std::string_view line);

/// The fields of a line: between commas, else between semicolons, else between blanks.
std::vector<std::string_view> split_pose_fields(std::string_view line);

}  // namespace adasplats
