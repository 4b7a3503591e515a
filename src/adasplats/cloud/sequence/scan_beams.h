// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "adasplats/cloud/points/laser_offsets.h"
#include "adasplats/cloud/poses/trajectory.h"
#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"

namespace adasplats {

struct KittiSequence;

/// How a sensor moved during one revolution, both in the scan's frame, that of the middle.
struct SweepMotion {
  RigidTransform frame_from_begin;
  RigidTransform frame_from_end;
};

/// A measured beam in its scan's frame.
struct MeasuredBeam {
  Vec3d origin;
  Vec3d end;                       ///< the measured point
  std::uint16_t laser = kNoLaser;  ///< topmost 0
};

/// Where the beams of a sequence's scans left the sensor. Files in KITTI's layout do not say it;
/// one pose stands for a whole revolution. For what a beam passed on its way, and for what it hits
/// when it is cast again, a decimetre matters: beams graze roads and pass edges.
struct ScanBeams {
  /// The two laser blocks of a Velodyne HDL-64E sit 0.12 m and 0.2 m above the frame's origin.
  bool from_hdl64 = false;
  /// Of each scan: how far the sensor moved during the revolution, m, in the scan's frame. The
  /// revolution begins at the rear, goes clockwise seen from above, and the frame is that of its
  /// middle. Empty where points are as they were measured, not motion-compensated.
  std::vector<Vec3d> sweeps_m;
  /// Of each scan whose points are as they were measured; empty: as if the sensor stood still.
  std::vector<SweepMotion> raw_motions;
  /// Of such points without raw_motions: how far the sensor moves during a revolution, m (median).
  double unknown_sweep_m = 0;
  /// What the recognised sensor's lasers measure beside its table; beam_of() corrects it.
  LaserOffsets offsets;
  /// What was recognised where scans say themselves where beams began; else empty.
  std::string recognised;
  /// Name of the recognised sensor in the library; its rings are the lasers. Else empty.
  std::string sensor;

  /// In the scan's frame, of the beam that measured `point` (as it stands in the file).
  Vec3d origin_of(std::size_t scan, Vec3d point) const;
  MeasuredBeam beam_of(std::size_t scan, Vec3d point) const;
  /// Which laser measured it; kNoLaser where the sensor is not recognised.
  std::uint16_t laser_of(std::size_t scan, Vec3d point) const;
  /// "frame origin", "HDL-64E blocks" or "HDL-64E blocks, moving" (or ", rolling").
  std::string description() const;
};

/// Fills beams.raw_motions of scans that are not motion-compensated: poses (one a scan, of its
/// middle) moving as `motion` does, whose times are theirs and whose frame need not be.
/// `revolution_s`: KITTI's by default. Errors: data (a pose more than a second before or behind the
/// motion).
void set_raw_motions(ScanBeams& beams, const Trajectory& poses, const Trajectory& motion,
                     double revolution_s = 0.1033);

/// Finds from the points of up to five scans whether a Velodyne HDL-64E measured them: they lie on
/// the 64 cones that its beams sweep, to a few millimetres (two centimetres by chance), when the
/// motion compensation is undone where there was one. Scans as they were measured, by poses at most
/// half a second apart: also how the sensor moved (raw_motions), if points on upright things of
/// other scans are met more often with that motion taken out. Other sensors: default, all beams
/// from the frame's origin. Errors: data where the motion can be undone by the times of the poses
/// only were these milli-, micro- or nanoseconds.
ScanBeams recognize_beams(const KittiSequence& sequence, const Executor& executor);

}  // namespace adasplats
