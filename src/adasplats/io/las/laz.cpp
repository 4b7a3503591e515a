// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/laz.h"

#ifdef ADASPLATS_HAVE_LASZIP

#include <algorithm>
#include <string>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/las/las_records.h"
#include "adasplats/io/las/las_vlrs.h"
#include "adasplats/io/las/laz_layout.h"
#include "adasplats/io/las/laz_process.h"

namespace adasplats {
namespace {

/// Whether the point lies in the header's box, with a hundredth of it and ten steps to spare:
/// broken data decode to anything, writers round. A box of zeros was never filled in.
bool is_plausible(const LasHeader& header, Vec3d position) {
  if (header.box_min == Vec3d{} && header.box_max == Vec3d{}) return true;
  const Vec3d slack = 0.01 * (header.box_max - header.box_min) + 10.0 * header.scale;
  const Vec3d low = header.box_min - slack;
  const Vec3d high = header.box_max + slack;
  return position.x >= low.x && position.y >= low.y && position.z >= low.z &&
         position.x <= high.x && position.y <= high.y && position.z <= high.z;
}

}  // namespace

Table read_laz(const std::filesystem::path& path, const LasReadOptions& options) {
  const LasHeader header = read_laz_layout(path);
  LazProcess process(path, header);
  // The count is not to be believed before the points are there: the columns grow with them.
  LasColumns columns(las_format(header.format), 0);
  std::string fault;
  while (columns.size() < header.points && fault.empty()) {
    const std::vector<LasPoint> points = process.next_points();
    if (points.empty()) fault = process.fault();
    for (const LasPoint& point : points) {
      if (!is_plausible(header, point.position)) {
        fault = "a point far outside the header's box";
        break;
      }
      columns.push(point);
    }
  }
  const std::size_t rows = columns.size();
  if (!fault.empty() && !options.salvage) {
    throw data_error({path, {}, {}}, "broken LAZ at point " + std::to_string(rows) + " of " +
                                         std::to_string(header.points) + ": " + fault);
  }
  Table table = columns.take();
  columns.drop_withheld(table);
  const LasDescription description = read_las_description(path, header);
  for (std::string& comment : description.comments()) table.comments.push_back(std::move(comment));
  for (const LasExtraField& field : description.extra_fields)
    table.comments.push_back("not read: " + field.name);
  if (rows < header.points) {
    table.comments.push_back("salvaged " + std::to_string(rows) + " of " +
                             std::to_string(header.points) + " records");
  }
  return table;
}

}  // namespace adasplats

#endif
