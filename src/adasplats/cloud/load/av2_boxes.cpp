// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "adasplats/cloud/load/av2_tables.h"
#include "adasplats/cloud/load/box_collector.h"
#include "adasplats/cloud/load/box_files.h"

namespace adasplats {
namespace {

const std::vector<std::string>& av2_texts(const std::filesystem::path& file,
                                          const ArrowTable& table, const std::string& name) {
  const auto column = table.texts.find(name);
  if (column == table.texts.end()) throw av2_fault(file, "has no column of text '" + name + "'");
  return column->second;
}

/// The rows by time, those of one time in the order of the file.
std::vector<std::size_t> rows_by_stamp(const std::vector<std::int64_t>& stamps_ns) {
  std::vector<std::size_t> rows(stamps_ns.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::ranges::stable_sort(rows, {}, [&](std::size_t row) { return stamps_ns[row]; });
  return rows;
}

}  // namespace

BoxContent read_av2_boxes(const std::filesystem::path& file) {
  const ArrowTable table = read_arrow_file(file);
  const std::vector<RigidTransform> vehicle_from_box = av2_poses_of_rows(file, table);
  const Column& length = av2_column(file, table, "length_m");
  const Column& width = av2_column(file, table, "width_m");
  const Column& height = av2_column(file, table, "height_m");
  const std::vector<std::string>& tracks = av2_texts(file, table, "track_uuid");
  const std::vector<std::string>& categories = av2_texts(file, table, "category");
  std::vector<std::int64_t> stamps_ns;
  for (std::size_t row = 0; row < table.numbers.rows; ++row)
    stamps_ns.push_back(av2_stamp_ns(file, table, row));
  const Av2Poses poses = read_av2_poses(file.parent_path());
  BoxCollector boxes(file);
  for (const std::size_t row : rows_by_stamp(stamps_ns)) {
    const auto place = [&] {
      return file.string() + ": row " + std::to_string(row) + " (from 0), track " + tracks[row] +
             ": ";
    };
    const auto vehicle = poses.by_stamp_ns.find(stamps_ns[row]);
    if (vehicle == poses.by_stamp_ns.end())
      throw Error(ErrorKind::data, place() + poses.file.string() + " has no pose at its stamp " +
                                       std::to_string(stamps_ns[row]));
    const RigidTransform pose = vehicle->second * vehicle_from_box[row];
    const Vec3d half_size = {length.as_double(row) / 2, width.as_double(row) / 2,
                             height.as_double(row) / 2};
    boxes.add(boxes.number_of(tracks[row]), categories[row],
              {kNanosecond_s * static_cast<double>(stamps_ns[row]), pose.translation, half_size,
               yaw_of_box(pose.rotation)},
              {}, place);
  }
  return boxes.take(true);
}

}  // namespace adasplats
