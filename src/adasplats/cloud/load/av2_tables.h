// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/error.h"
#include "adasplats/io/arrow/arrow_file.h"

namespace adasplats {

inline constexpr double kNanosecond_s = 1e-9;
inline constexpr double kAv2MaxOffset_s = 1;  ///< of a point from the stamp of its sweep

Error av2_fault(const std::filesystem::path& file, const std::string& what);

/// A table of an Argoverse 2 log. Errors: no_input if it is missing.
ArrowTable read_av2_table(const std::filesystem::path& file);

/// A column of numbers. Errors: data if it is missing.
const Column& av2_column(const std::filesystem::path& file, const ArrowTable& table,
                         std::string_view name);

/// The poses of a table (qw, qx, qy, qz, tx_m, ty_m, tz_m), one in each row. Errors: data.
std::vector<RigidTransform> av2_poses_of_rows(const std::filesystem::path& file,
                                              const ArrowTable& table);

/// timestamp_ns of a row. Errors: data.
std::int64_t av2_stamp_ns(const std::filesystem::path& file, const ArrowTable& table,
                          std::size_t row);

/// The poses of the vehicle by their exact stamps, and over time.
struct Av2Poses {
  std::filesystem::path file;
  std::map<std::int64_t, RigidTransform> by_stamp_ns;
  Trajectory track;  ///< seconds resolve 60 ns; of nearer stamps the first
};

/// Reads city_SE3_egovehicle.feather of a log. Errors: no_input, data.
Av2Poses read_av2_poses(const std::filesystem::path& folder);

}  // namespace adasplats
