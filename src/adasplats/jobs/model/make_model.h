// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/calibrate/windows.h"
#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/segment/point_classes.h"
#include "adasplats/jobs/session/session.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/splats/model_engine.h"

namespace adasplats {

/// What a recording gets wrong is estimated from its points and corrected, where the evidence is
/// clear (calibrate()); all of it, or parts alone.
struct CalibrationChoice {
  bool on = true;
  CalibrateOptions options;
  CalibrateWindowOptions windows;  ///< of drives longer than one
};

template <class Visit>
void visit_settings(CalibrationChoice& choice, Visit&& visit) {
  constexpr const char* kGroup = "Calibration";
  visit(
      Setting{
          .name = "calibrate",
          .help = "Estimate and correct the errors of poses and lasers where the evidence is clear",
          .group = kGroup,
          .basic = true},
      choice.on);
  visit(
      Setting{.name = "calibrate_poses", .help = "Correct the pose of every scan", .group = kGroup},
      choice.options.poses);
  visit(Setting{.name = "calibrate_ranges",
                .help = "Correct the range offset of every laser",
                .group = kGroup},
        choice.options.ranges);
  visit(Setting{.name = "calibrate_elevations",
                .help = "Correct the elevation offset of every laser",
                .group = kGroup},
        choice.options.elevations);
  visit(Setting{.name = "calibrate_mount",
                .help = "Correct the sensor mount, common to all scans",
                .group = kGroup},
        choice.options.mount_correction);
}

/// Whether points get their classes from a network, in place of the labels that they may have.
struct SegmentChoice {
  bool on = false;
  std::filesystem::path network;  ///< a file; empty: default_network()
};

template <class Visit>
void visit_settings(SegmentChoice& choice, Visit&& visit) {
  visit(Setting{.name = "segment",
                .help = "Classify the points with a network; labels in the input are replaced",
                .basic = true},
        choice.on);
  visit(Setting{.name = "network",
                .help = "Network file that classifies the points (default: the included network)"},
        choice.network);
}

/// A quick first model, by ConsistentOptions::draft(), of a quarter of the scans of drives, or of
/// the points of other inputs.
struct DraftChoice {
  bool on = false;
  static constexpr std::size_t kEvery = 4;
  /// Of a drive. Fewer scans have too few rays to find wrong poses by.
  static constexpr std::size_t kMinScans = 8;
};

template <class Visit>
void visit_settings(DraftChoice& choice, Visit&& visit) {
  visit(Setting{.name = "draft",
                .help = "Make a quick, coarse model of a quarter of the data",
                .basic = true},
        choice.on);
}

/// The warning where points come with labels.
inline constexpr const char* kLabelsReplaced =
    "the labels of the points are replaced by the network's (`segment`)";

/// What has no effect in a draft: all options of methods.
std::vector<UnusedSetting> unused_settings(const DraftChoice& draft, const MethodChoice& method);
/// What has no effect where nothing is segmented.
std::vector<UnusedSetting> unused_settings(const SegmentChoice& choice);

/// How a model is made of points.
struct ModelOptions {
  DraftChoice draft;      ///< on: then `build.recipe` has no effect
  std::string labels;     ///< as label_scheme_for takes it; not where the points are segmented
  SegmentChoice segment;  ///< then the scheme is semantickitti_labels()
  /// Points in these boxes of objects at rest are removed after the calibration, which they help.
  std::shared_ptr<const MovingBoxes> parked;
  BuildOptions build;
  /// The user requested `build.remove`: if it cannot remove anything, that is an error instead of a
  /// warning.
  bool removal_is_asked = false;
  CalibrationChoice calibration;
};

/// The network that classifies the points; nothing if none is requested. Errors: usage (labels are
/// given, too; `remove` is moving, but the network has no moving classes), those of
/// PointClassifier.
std::optional<PointClassifier> classifier_for(const ModelOptions& options);

/// Of point files.
struct ModelJob : ModelOptions {
  std::vector<std::filesystem::path> inputs;
  LoadOptions load;
};

/// How points got their classes from a network.
struct SegmentReport {
  NetworkFacts network;
  PointClasses classes;          ///< without ids and confidences
  bool replaced_labels = false;  ///< that the input had
};

/// What a draft was made of.
struct DraftFacts {
  static constexpr std::string_view kScans = "scans", kPoints = "points";
  std::string_view of = kPoints;
  std::size_t every = DraftChoice::kEvery;  ///< one of so many
};

struct ModelResult {
  std::optional<DraftFacts> draft;
  LoadReport loaded;  ///< points_read alone, where nothing was loaded
  std::optional<SegmentReport> segmented;
  BuildReport built;
  std::optional<CalibrationReport> calibrated;  ///< nothing: it was not asked for
  Calibration calibration;                      ///< what was applied
  std::vector<StepTime> steps;                  ///< of loading, building and what the caller adds
  double seconds = 0;
};

/// Loads and builds on the session's device. Errors: usage (the semantic method without labels or
/// segmentation, both of them, `remove` moving of a network that knows nothing that moves), those
/// of load_cloud, PointClassifier and build_model.
std::pair<SplatModel, ModelResult> make_model(const ModelJob& job, Session& session);

/// Makes a model of point files and saves it. Errors: also those of writing.
ModelResult run_model(const ModelJob& job, const std::filesystem::path& output, Session& session);

/// Builds of points in memory. Errors: those of build_model and PointClassifier.
std::pair<SplatModel, ModelResult> make_model(const PointCloud& cloud, const ModelOptions& options,
                                              Session& session);
/// Builds of what `load` gives, without a copy; it is called again where a GPU fails.
std::pair<SplatModel, ModelResult> make_model(const std::function<PointCloud()>& load,
                                              const ModelOptions& options, Session& session);

/// Calls work(engine) with an engine on the session's device; where that is a GPU that nobody asked
/// for and it fails, again with one on the CPU.
void with_model_engine(Session& session, const std::function<void(const ModelEngine&)>& work);

/// Of a model's --report and of `info`.
nlohmann::ordered_json to_json(const TimedOrigins& timed);
nlohmann::ordered_json to_json(const SegmentReport& segmented);
/// Of the --report of models and cities.
nlohmann::ordered_json to_json(const OriginCheck& check);
/// The keys of a model's --report.
nlohmann::ordered_json to_json(const ModelResult& result);

}  // namespace adasplats
