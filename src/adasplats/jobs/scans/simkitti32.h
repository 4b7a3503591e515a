// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/core/setting.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/simulate/scan/returns.h"
#include "adasplats/simulate/scan/weather.h"

namespace adasplats {

/// Paper section "SimKITTI32": the scans of another LiDAR along a labelled sequence, with labels.
/// The defaults are the paper's except for the method of the static model: the paper's `semantic`
/// loses half of the vegetation (docs/simkitti32.md).
struct SimKitti32Job {
  std::filesystem::path sequence;  ///< SemanticKITTI sequence folder with labels
  std::string labels = "semantickitti";
  ScanRange scans;              ///< that are modelled and simulated
  std::size_t model_every = 1;  ///< every n-th of those is used for the static model
  SplatMethod method = SplatMethod::consistent;
  std::string sensor = "hdl-32-paper";
  Vec3d offset_m = {0, 0, -0.5};  ///< of the sensor, in world axes
  double noise_m = 0.005;         ///< standard deviation of the range
  int depth = 5;                  ///< D, hits of a ray that are averaged
  bool moving = true;             ///< simulate moving objects, too
  double moving_radius_m = 0.14;  ///< radius of their splats
  bool keep_model = false;        ///< as model.ply beside the sequences
  /// The static model; empty: made of the scans, by `method` and `model_every`. A world file
  /// (simulate/world/world_file.h), such as that of run_traffic(): its objects replace the splats
  /// of moving points.
  std::filesystem::path model;
  std::filesystem::path ray_drop;  ///< as for load_ray_drop_choice
  Weather weather;
  std::filesystem::path output;
  bool overwrite = false;
};

template <class Visit>
void visit_settings(SimKitti32Job& job, Visit&& visit) {
  constexpr const char* kModel = "Static model";
  visit(Setting{.name = "offset",
                .help = "Shift of the sensor in world axes, m",
                .key = "offset_m",
                .basic = true},
        job.offset_m);
  visit(Setting{.name = "noise",
                .help = "Standard deviation of the range noise, m",
                .key = "noise_m",
                .min = 0,
                .basic = true},
        job.noise_m);
  visit(Setting{.name = "depth",
                .help = "Number of hits averaged along a ray, D",
                .min = 1,
                .max = kMaxDepth},
        job.depth);
  visit(Setting{.name = "moving", .help = "Simulate moving objects, too", .basic = true},
        job.moving);
  visit(Setting{.name = "moving_radius",
                .help = "Splat radius of moving objects, m",
                .key = "moving_radius_m",
                .min = 0,
                .exclusive_min = true},
        job.moving_radius_m);
  visit(
      Setting{
          .name = "method",
          .help =
              "Modelling method: consistent agrees with the measured rays, semantic is the paper's",
          .group = kModel},
      job.method);
  visit(Setting{.name = "model_every",
                .help = "Use every n-th scan for the model, to save memory",
                .value = "N",
                .group = kModel,
                .min = 1,
                .max = 1e6,
                .basic = true},
        job.model_every);
  visit(Setting{.name = "keep_model",
                .help = "Keep the model in the output folder, as model.ply",
                .group = kModel},
        job.keep_model);
  visit_settings(job.weather, visit);
}

/// The settings that have no effect with the others.
std::vector<UnusedSetting> unused_settings(const SimKitti32Job& job);

/// Points of one class in the sequence and in the simulated scans.
struct ClassCount {
  std::size_t original = 0;
  std::size_t simulated = 0;
};

struct SimKitti32Result {
  std::size_t scans = 0;
  std::size_t scans_resumed = 0;  ///< written by an interrupted run
  std::size_t rays = 0;           ///< of all scans
  std::size_t points = 0;
  std::size_t moving_splats = 0;  ///< of the scans that this run wrote
  std::map<std::uint16_t, ClassCount> by_class;
  std::optional<ModelResult> model;  ///< nothing if it was given or made by an interrupted run
  double seconds_simulated = 0;
  double seconds = 0;
};

/// Makes the data set. After an interruption at any moment the same job resumes, with the same
/// bytes. If a given model is calibrated, scans are simulated at its corrected poses. Errors: data
/// (no labels; a given model without classes, of another drive by its calibration, or that no ray
/// of the first scans hits), usage (no scans), cannot_create (also if the unfinished folder is of
/// another job, other inputs or another version).
SimKitti32Result run_simkitti32(const SimKitti32Job& job, Session& session);

/// The keys of its --report.
nlohmann::ordered_json to_json(const SimKitti32Result& result, const LabelScheme& labels);

}  // namespace adasplats
