// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/evaluate/truth.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/sensors/lidar_model.h"

namespace adasplats {

/// A model against the true surface, with the rays that `simulate` would cast.
struct TruthJob {
  std::filesystem::path model;
  std::filesystem::path truth;  ///< triangle mesh
  std::string sensor = kDefaultSensor;
  std::filesystem::path trajectory;  ///< pose file or sequence folder
  Vec3d offset_m;
  std::size_t every = 1;  ///< takes every n-th pose
  std::string labels;     ///< empty: what the mesh's file says, else semantickitti
  TruthOptions options;
};

TruthResult evaluate_truth(const TruthJob& job, Session& session);

}  // namespace adasplats
