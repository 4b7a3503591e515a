// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "adasplats/calibrate/calibration.h"
#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/pipeline/model/make_model.h"
#include "adasplats/pipeline/session/session.h"

namespace adasplats {

/// What was read of a city's inputs.
struct CityPoints {
  std::size_t read = 0;
  Calibration calibration;  ///< that the points were corrected with
  double calibrated_s = 0;  ///< that finding it took
};

/// Calls `take` for the points of a job piece by piece, corrected where the job calibrates: drives
/// longer than a window by 200 scans, else file by file, else all at once.
CityPoints read_city_points(const ModelJob& job, Session& session,
                            const std::function<void(const PointCloud&)>& take);

}  // namespace adasplats
