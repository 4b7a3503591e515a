// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/evaluate/presence.h"
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
  std::size_t every = 1;  ///< use every n-th pose
  std::string labels;     ///< empty: the scheme named in the mesh file, else semantickitti
  TruthOptions options;
};

TruthResult evaluate_truth(const TruthJob& job, Session& session);
nlohmann::ordered_json to_json(const TruthResult& result);

/// At which measured points does a model have a surface?
struct PresenceJob {
  std::filesystem::path model;
  std::filesystem::path points;  ///< file with sensor positions, or a sequence
  std::string labels;            ///< label scheme as for label_scheme_for()
  PresenceOptions options;
  LoadOptions load;
};

PresenceResult evaluate_presence(const PresenceJob& job, Session& session);
nlohmann::ordered_json to_json(const PresenceResult& result);

}  // namespace adasplats
