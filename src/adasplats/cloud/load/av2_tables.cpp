// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/av2_tables.h"

#include <cmath>
#include <system_error>
#include <utility>
#include <variant>

#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {

namespace fs = std::filesystem;

Error av2_fault(const fs::path& file, const std::string& what) {
  return {ErrorKind::data, file.string() + ": " + what};
}

ArrowTable read_av2_table(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    throw Error(ErrorKind::no_input,
                file.string() +
                    ": is missing; an Argoverse 2 log contains sensors/lidar, "
                    "calibration/egovehicle_SE3_sensor.feather and city_SE3_egovehicle.feather");
  return read_arrow_file(file);
}

const Column& av2_column(const fs::path& file, const ArrowTable& table, std::string_view name) {
  const Column* const column = table.numbers.find(name);
  if (column == nullptr)
    throw av2_fault(file, "has no column of numbers '" + std::string(name) + "'");
  return *column;
}

std::vector<RigidTransform> av2_poses_of_rows(const fs::path& file, const ArrowTable& table) {
  const Column& qw = av2_column(file, table, "qw");
  const Column& qx = av2_column(file, table, "qx");
  const Column& qy = av2_column(file, table, "qy");
  const Column& qz = av2_column(file, table, "qz");
  const Column& x = av2_column(file, table, "tx_m");
  const Column& y = av2_column(file, table, "ty_m");
  const Column& z = av2_column(file, table, "tz_m");
  constexpr double kTolerance = 1e-3;
  std::vector<RigidTransform> poses;
  for (std::size_t row = 0; row < table.numbers.rows; ++row) {
    const Quaternion q = {qw.as_double(row), qx.as_double(row), qy.as_double(row),
                          qz.as_double(row)};
    const Vec3d place = {x.as_double(row), y.as_double(row), z.as_double(row)};
    const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    const std::string where = "row " + std::to_string(row) + " (from 0): ";
    if (!(std::fabs(norm - 1) <= kTolerance))
      throw av2_fault(file, where + "the quaternion qw, qx, qy, qz has length " + exact_text(norm) +
                                ", expected 1");
    if (!is_finite(place)) throw av2_fault(file, where + "tx_m, ty_m, tz_m is not finite");
    poses.push_back(
        {rotation_from_quaternion(q.w / norm, q.x / norm, q.y / norm, q.z / norm), place});
  }
  return poses;
}

std::int64_t av2_stamp_ns(const fs::path& file, const ArrowTable& table, std::size_t row) {
  const Column& stamps = av2_column(file, table, "timestamp_ns");
  if (const auto* const exact = std::get_if<std::vector<std::int64_t>>(&stamps.values))
    return (*exact)[row];
  throw av2_fault(file, "column 'timestamp_ns' is not of 64-bit integers");
}

Av2Poses read_av2_poses(const fs::path& folder) {
  Av2Poses poses;
  poses.file = folder / "city_SE3_egovehicle.feather";
  const ArrowTable table = read_av2_table(poses.file);
  const std::vector<RigidTransform> city_from_vehicle = av2_poses_of_rows(poses.file, table);
  for (std::size_t row = 0; row < city_from_vehicle.size(); ++row)
    poses.by_stamp_ns.emplace(av2_stamp_ns(poses.file, table, row), city_from_vehicle[row]);
  if (poses.by_stamp_ns.empty()) throw av2_fault(poses.file, "holds no poses");
  for (const auto& [stamp_ns, pose] : poses.by_stamp_ns) {
    const double time_s = kNanosecond_s * static_cast<double>(stamp_ns);
    if (poses.track.empty() || time_s > poses.track.back().time_s)
      poses.track.push_back({time_s, pose});
  }
  // The points of the last sweep are later than its stamp.
  constexpr double kSweepOfAv2_s = 0.1;
  poses.track = with_extrapolated_ends(std::move(poses.track), kSweepOfAv2_s);
  return poses;
}

}  // namespace adasplats
