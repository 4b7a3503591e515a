// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

#include "adasplats/city/city_manifest.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/cloud/sequence/calibration.h"
#include "adasplats/core/executor.h"
#include "adasplats/evaluate/point_fit.h"

namespace adasplats {

/// What laying the scans of drives on a city's splats did.
struct AlignmentReport {
  std::size_t groups = 0;   ///< of scans one behind another
  std::size_t aligned = 0;  ///< that see enough of the city; others follow these
  double largest_shift_m = 0, median_shift_m = 0;  ///< of these, at the sensor
};

nlohmann::ordered_json to_json(const AlignmentReport& report);

/// Corrects the poses of drives so that they fit the splats of a city that they come by again:
/// every second or so a correction by the rays of ten scans (fit_motion()), between them what time
/// says. Reads tiles as they are come by.
class CityAlignment {
 public:
  CityAlignment(std::filesystem::path city, const CityManifest& manifest, const Executor& executor);
  ~CityAlignment();
  CityAlignment(const CityAlignment&) = delete;
  CityAlignment& operator=(const CityAlignment&) = delete;

  /// Moves points, sensor positions and poses of scans that follow those of the last call. A cloud
  /// that missing_for_calibration() objects to is left as it is.
  void lay_on(PointCloud& cloud);

  /// `applied`, a calibration that was applied before, followed by the corrections of lay_on(): for
  /// the scans that it corrects, or for all if it corrects none.
  Calibration behind(const Calibration& applied) const;
  AlignmentReport report() const;

 private:
  struct Group;
  std::vector<Group> groups_in(const PointCloud& cloud) const;
  void find_motion(Group& group);
  const FitScene* scene_around(const FitRays& rays);
  std::optional<PoseCorrection> correction_of(const TimedPose& pose,
                                              std::span<const Group> drive) const;
  void count(const Group& group, const TimedPose& pose);

  std::filesystem::path city_;
  const CityManifest& manifest_;
  const Executor& executor_;
  std::vector<std::size_t> tiles_;  ///< of scene_
  std::unique_ptr<FitScene> scene_;
  std::optional<RigidTransform> last_;       ///< of the last group that had one, world coordinates
  std::vector<PoseCorrection> corrections_;  ///< of all scans
  std::vector<double> shifts_m_;
  std::size_t groups_ = 0;
};

}  // namespace adasplats
