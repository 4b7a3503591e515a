// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/dataset/scan_writer.h"

namespace adasplats {

/// Writes poses.csv, world_from_sensor of every scan, next to the scans.
class WriterWithPoses : public ScanWriter {
 public:
  using ScanWriter::ScanWriter;
  void append(std::size_t /*index*/, const EncodedScan& scan) override {
    trajectory_.push_back(scan.pose);
  }
  void keep(std::size_t /*index*/, const TimedPose& pose) override { trajectory_.push_back(pose); }
  void finish() override { write_trajectory_csv(folder() / "poses.csv", trajectory_); }

 protected:
  /// Poses of the scans so far, by number.
  const Trajectory& trajectory() const { return trajectory_; }

 private:
  Trajectory trajectory_;
};

}  // namespace adasplats
