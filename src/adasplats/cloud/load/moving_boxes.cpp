// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/moving_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adasplats/cloud/load/box_files.h"

namespace adasplats {
namespace {

constexpr double kMargin_m = 0.2;

double turned_by(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 2 * std::numbers::pi);
}

}  // namespace

MovingBoxes::MovingBoxes(const std::filesystem::path& path, const BoxDrive& drive)
    : content_(read_box_file(path, drive)) {}

TimedBox BoxTrack::at(double time_s) const {
  const auto after = std::ranges::upper_bound(boxes, time_s, {}, &TimedBox::time_s);
  const TimedBox& b = after == boxes.end() ? boxes.back() : *after;
  const TimedBox& a = after == boxes.begin() ? b : *(after - 1);
  const double share =
      b.time_s > a.time_s ? std::clamp((time_s - a.time_s) / (b.time_s - a.time_s), 0.0, 1.0) : 0;
  return {time_s, a.middle + share * (b.middle - a.middle), a.half_size,
          a.yaw_rad + share * turned_by(a.yaw_rad, b.yaw_rad)};
}

std::uint16_t MovingBoxes::object_at(double time_s, Vec3d point) const {
  std::uint16_t object = 0;
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < content_.moving.size(); ++k) {
    const std::vector<TimedBox>& boxes = content_.moving[k].boxes;
    const double apart_s = boxes.size() > 1 ? boxes[1].time_s - boxes[0].time_s : 0.1;
    if (time_s < boxes.front().time_s - apart_s || time_s > boxes.back().time_s + apart_s) continue;
    const TimedBox box = content_.moving[k].at(time_s);
    const Vec3d from_middle = point - box.middle;
    const double c = std::cos(box.yaw_rad), s = std::sin(box.yaw_rad);
    const Vec3d in_box = {c * from_middle.x + s * from_middle.y,
                          -s * from_middle.x + c * from_middle.y, from_middle.z};
    if (std::fabs(in_box.x) > box.half_size.x + kMargin_m ||
        std::fabs(in_box.y) > box.half_size.y + kMargin_m ||
        std::fabs(in_box.z) > box.half_size.z + kMargin_m)
      continue;
    const double away_m = length(from_middle);
    if (away_m < least_m) {
      least_m = away_m;
      object = static_cast<std::uint16_t>(k + 1);
    }
  }
  return object;
}

std::vector<std::uint16_t> MovingBoxes::objects_in(const KittiSequence& drive, std::size_t index,
                                                   const KittiScan& scan,
                                                   const Executor& executor) const {
  const TimedPose& pose = drive.trajectory[index];
  std::vector<std::uint16_t> objects(scan.positions.size());
  executor.for_chunks(objects.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      objects[i] = object_at(scan.times_s.empty() ? pose.time_s : scan.times_s[i],
                             pose.world_from_sensor * beam_of(drive, index, scan, i).end);
  });
  return objects;
}

}  // namespace adasplats
