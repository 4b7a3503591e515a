// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/boxed_drive.h"

#include <map>
#include <memory>
#include <utility>

#include "adasplats/cloud/load/box_files.h"

namespace adasplats {
namespace {

/// Reads scans of a sequence and marks the points in boxes at the times of the scans.
class BoxedReader final : public ScanReader {
 public:
  BoxedReader(KittiSequence sequence, MovingBoxes boxes)
      : sequence_(std::move(sequence)), boxes_(std::move(boxes)) {
    for (std::size_t k = 0; k < sequence_.scans.size(); ++k)
      numbers_.emplace(sequence_.scans[k], k);
  }

  KittiScan read(const std::filesystem::path& file) const override {
    const std::size_t index = numbers_.at(file);
    const TimedPose& pose = sequence_.trajectory[index];
    KittiScan scan = read_all_returns(sequence_, index);
    for (const Vec3f point : scan.positions)
      scan.in_boxes.push_back(
          boxes_.object_at(pose.time_s, pose.world_from_sensor * vec_cast<double>(point)));
    return scan;
  }

 private:
  KittiSequence sequence_;
  MovingBoxes boxes_;
  std::map<std::filesystem::path, std::size_t> numbers_;
};

}  // namespace

KittiSequence with_boxes(KittiSequence sequence, const DriveSettings& settings) {
  if (settings.boxes.empty() || !is_kitti_raw_drive(sequence.folder)) return sequence;
  MovingBoxes boxes = boxes_of_drive(settings, sequence.scans, sequence.trajectory);
  sequence.reader = std::make_shared<BoxedReader>(sequence, std::move(boxes));
  return sequence;
}

}  // namespace adasplats
