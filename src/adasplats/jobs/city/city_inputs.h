// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/sequence/calibration.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// What was read of a city's inputs.
struct CityPoints {
  std::size_t read = 0;
  Calibration calibration;  ///< that the points were corrected with
  double calibrated_s = 0;  ///< that finding it took
};

/// Records of a file that are read at once: 100 chunks of LAZ as LASzip writes them.
inline constexpr std::uint64_t kPieceRecords = 5'000'000;

/// Takes some of the points.
using TakePoints = std::function<void(PointCloud&&)>;

/// How a city's inputs are read.
struct CityReading {
  std::uint64_t piece_records = kPieceRecords;
  /// Where the points are that these are added to, world coordinates.
  std::optional<Vec3d> place = std::nullopt;
  /// Moves the points of scans behind what the job's calibration did; may be empty.
  std::function<void(PointCloud&)> lay_on = {};
};

/// Calls `take` for the points of a job piece by piece, corrected where the job calibrates: drives
/// longer than a window by 200 scans, files one by one, large ones with records at random
/// (random_access_records()) by so many, else all at once. Errors: those of load_cloud; data
/// for pieces in different coordinate systems, with different clocks, or farther from the first
/// than LoadOptions::max_distance_m; where `place` is given, farther from that.
CityPoints read_city_points(const ModelJob& job, Session& session, const TakePoints& take,
                            const CityReading& reading = {});

}  // namespace adasplats
