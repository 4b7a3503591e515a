// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "adasplats/core/executor.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// Why the points of a file are in the frame of the sensor that measured them.
struct SensorFrame {
  std::string because;
  bool has_pose = false;   ///< the file states a pose other than the identity (PCD: VIEWPOINT)
  bool by_points = false;  ///< scan_pattern_of() shows it alone: also world points measured from
                           ///< near the origin
};

/// Infers it from the columns: ranges are the distances from the origin (m, or mm as Ouster writes
/// them), or the points of each ring have one elevation above it. Also files in KITTI's .bin
/// format, which are scans, if the origin is among their points. Nothing if undetermined.
std::optional<SensorFrame> sensor_frame_of(const std::filesystem::path& file, const Table& table,
                                           std::span<const Vec3d> positions);

/// Whether a PCD states a pose of its sensor other than the identity.
bool has_viewpoint(const Table& table);

/// Why points look like one scan of a spinning sensor at the origin, z up: from there few are
/// hidden, and they are on the cones of a sensor of the library, or on rings. Rings of scans with
/// motion compensation are blurred, but neighbours along a ring are nearer than the next ring. Not
/// for more points than scans have, and not for solid-state sensors. Nothing if undetermined.
std::optional<SensorFrame> scan_pattern_of(std::span<const Vec3d> positions,
                                           const Executor& executor);

/// The drive that a file is one scan of, if it has the poses: a folder written by `simulate`, a
/// sequence or raw drive of KITTI, a nuScenes data root. Nothing for other files.
std::optional<std::filesystem::path> drive_with_scan(const std::filesystem::path& file);

/// What to do to use scans of `folder` as world points, for messages about any command.
std::string advice_for_scans(const std::filesystem::path& folder,
                             const std::filesystem::path& poses);

}  // namespace adasplats
