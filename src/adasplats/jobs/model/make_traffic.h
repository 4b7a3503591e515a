// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/traffic/align_object.h"

namespace adasplats {

/// A moving object, or a parked vehicle.
struct TrafficObject {
  std::uint64_t id = 0;
  std::string label;
  std::string name;                       ///< of its files, such as "044-car"
  std::optional<std::uint16_t> class_id;  ///< of the scene's label scheme, if it has one for it
  Vec3d size_m;                           ///< length, width, height
  bool is_at_rest = false;
  RigidTransform world_from_object;  ///< the pose at the beginning
  double begin_s = 0, end_s = 0;
  std::size_t scans = 0, points = 0, splats = 0;
  std::size_t ground_points = 0;  ///< of the ground below it, left out
  std::size_t mirrored_points = 0;
  AlignReport aligned;
  /// Of objects at rest: measured beams that ended on it, and those of them that hit nothing in the
  /// scene without it.
  std::size_t beams = 0, open_beams = 0;
  std::string left_out;  ///< why it is not in the world; empty: it is
};

struct TrafficResult {
  ModelResult scene;
  std::vector<TrafficObject> objects;
};

/// Models a drive, its moving objects and its parked vehicles: the scene without them, and each
/// object in its own frame with its trajectory. Objects are those of `job.load.boxes`, or of the
/// labels (boxes_of_labels()), or else those that find_moving() finds, which are moving ones only.
/// Writes into `folder`: scene.ply, world.toml, by object objects/NAME.ply and, if it moves,
/// objects/NAME.csv, and boxes.csv unless boxes were given. Errors: usage (not one drive with
/// times; the method semantic), those of make_model.
TrafficResult run_traffic(const ModelJob& job, const std::filesystem::path& folder, bool overwrite,
                          Session& session);

/// The keys of a report.
nlohmann::ordered_json to_json(const TrafficResult& result);

}  // namespace adasplats
