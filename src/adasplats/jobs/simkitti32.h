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
#include "adasplats/jobs/class_counts.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/model_file.h"
#include "adasplats/jobs/session/scan_range.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/simulate/scan/returns.h"
#include "adasplats/simulate/scan/weather.h"

namespace adasplats {

/// Paper section "SimKITTI32": what another LiDAR would have measured along a labelled sequence,
/// with labels. The defaults are the paper's, but for the method of the static model: the paper's
/// is `semantic`, which loses half of the vegetation (docs/simkitti32.md).
struct SimKitti32Job {
  std::filesystem::path sequence;  ///< SemanticKITTI sequence folder with labels
  std::string labels = "semantickitti";
  ScanRange scans;              ///< which ones are modelled and simulated
  std::size_t model_every = 1;  ///< of those, every n-th makes the static model
  SplatMethod method = SplatMethod::consistent;
  std::string sensor = "hdl-32-paper";
  Vec3d offset_m = {0, 0, -0.5};  ///< of the sensor, in world axes
  double noise_m = 0.005;         ///< standard deviation of the range
  int depth = 5;                  ///< D, hits of a ray that are averaged
  bool moving = true;             ///< what moves is simulated, too
  double moving_radius_m = 0.14;  ///< of the splats of what moves
  bool keep_model = false;        ///< as model.ply beside the sequences
  /// The static model; empty: it is made of the scans, by `method` and `model_every`.
  std::filesystem::path model;
  std::filesystem::path ray_drop;  ///< chosen_ray_drop()
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

/// The settings that have no effect beside the others.
std::vector<UnusedSetting> unused_settings(const SimKitti32Job& job);

struct SimKitti32Result {
  std::size_t scans = 0;
  std::size_t scans_resumed = 0;  ///< of them an interrupted run had written
  std::size_t rays = 0;           ///< of all scans
  std::size_t points = 0;
  std::size_t moving_splats = 0;  ///< of the scans that this run wrote
  std::map<std::uint16_t, ClassCount> by_class;
  std::optional<ModelResult> model;  ///< nothing where it was given or an interrupted run made it
  double seconds_simulated = 0;
  double seconds = 0;
};

/// Makes the data set. Interrupted at any moment, the same job goes on where it stopped and gives
/// the same bytes. Scans that a given model was calibrated with, or between, stand at the poses
/// that it was corrected to. Errors: data (no labels; a given model without classes, of another
/// drive by its calibration, or that no ray of the first scans meets), usage (no scans),
/// cannot_create (also where what was left unfinished is of another job, other inputs or another
/// version).
SimKitti32Result run_simkitti32(const SimKitti32Job& job, Session& session);

/// The keys of its --report.
nlohmann::ordered_json to_json(const SimKitti32Result& result, const LabelScheme& labels);

}  // namespace adasplats
