// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The subcommands of `evaluate`, but for those of calibrated sensors (sensor_fit_commands.cpp).

#include <algorithm>

#include "adasplats/core/error.h"
#include "adasplats/jobs/evaluate/evaluate_clouds.h"
#include "adasplats/jobs/evaluate/evaluate_labels.h"
#include "adasplats/jobs/evaluate/evaluate_realism.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/evaluate/evaluate_surface.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
#include "cli/text_table.h"
#include "commands/result_command.h"

namespace adasplats::app {
namespace {

constexpr const char* kLabelSchemes =
    "Label scheme: semantickitti, paris-carla-3d, pandaset, nuscenes, asprs or a TOML file";

Option* add_scheme(OptionSet& app, std::string& labels, const std::string& help) {
  return app.add_option("--labels", labels, help)->type_name("SCHEME");
}

void add_every(OptionSet& app, std::size_t& every, const std::string& help) {
  app.add_option("--every", every, help)->capture_default_str()->type_name("N");
}

void require_one_removal(bool keep_moving, bool drop_movable) {
  if (keep_moving && drop_movable)
    throw Error(ErrorKind::usage, "--keep-moving and --drop-movable exclude each other");
}

std::string result_text(const CloudDistance& distance) {
  TextTable table({"measure", "value"});
  table.add_row({"C2C (simulated to original)", centimetres(distance.c2c_m)});
  table.add_row({"completeness (original to simulated)", centimetres(distance.completeness_m)});
  table.add_row({"Chamfer, mean of both", centimetres(distance.chamfer_m)});
  table.add_row({"Chamfer, sum of mean squares", fixed(distance.chamfer_m2, 5) + " m2"});
  for (const auto& [bound_m, score] : distance.f_score)
    table.add_row({"F-score at " + fixed(100 * bound_m, 1) + " cm", fixed(score, 4)});
  table.add_row({"simulated points", grouped(distance.simulated_points)});
  table.add_row({"original points", grouped(distance.original_points)});
  return table.text();
}

std::string result_text(const std::vector<std::pair<std::string, ClassDistance>>& by_class) {
  TextTable table({"class", "C2C", "C2C to all", "simulated", "original"});
  for (const auto& [name, distance] : by_class)
    table.add_row({name, centimetres(distance.c2c_m), centimetres(distance.c2c_to_all_m),
                   grouped(distance.simulated_points), grouped(distance.original_points)});
  return table.text();
}

class EvaluateC2cCommand final : public ResultCommand {
 public:
  explicit EvaluateC2cCommand(CLI::App& evaluate)
      : ResultCommand(
            evaluate, "c2c", "Measure distances between simulated and measured points",
            "  adasplats evaluate c2c scans street/mapping.ply\n"
            "  adasplats evaluate c2c scans street/mapping.ply --by-class --labels semantickitti\n"
            "  adasplats evaluate c2c scans street/mapping.ply --picture distances.png\n") {
    OptionSet& app = options();
    require(add_path(app, "SIMULATED", job_.simulated,
                     "Point file, sequence folder or output of simulate"));
    require(add_path(app, "ORIGINAL", job_.original,
                     "Point file, sequence folder or output of simulate"));
    app.add_flag("--by-class", by_class_, "Also by semantic class");
    app.add_flag("--nearest-classes", nearest_classes_,
                 "Give each simulated point the class of the nearest original point");
    add_scheme(app, job_.labels, kLabelSchemes);
    writes(add_path(app, "--picture", job_.picture,
                    "Also draw the simulated points, coloured by distance to the original (PNG)"),
           {".png"});
    writes(add_path(app, "--errors", job_.errors,
                    "Also write the simulated points with their distances (PLY; 'adasplats view' "
                    "shows them)"),
           {".ply"});
    add_vector(app, "--eye", job_.view.eye, "Camera position for --picture, world coordinates");
    add_vector(app, "--target", job_.view.target,
               "Point that the camera looks at; default: the middle of the original points");
    add_picture_width(app, job_.view.width);
  }

 private:
  std::string make_result(Session& session) override {
    if (!by_class_) reject({"--labels", "--nearest-classes"}, "without --by-class");
    if (by_class_) job_.by_class = nearest_classes_ ? ByClass::nearest : ByClass::own;
    if (job_.picture.empty()) reject({"--eye", "--target", "--picture-width"}, "without --picture");
    job_.view.height = job_.view.width * 9 / 16;
    const CloudComparison comparison = evaluate_clouds(job_, session);
    session.report.update(to_json(comparison));
    const std::string text = result_text(comparison.distance);
    return by_class_ ? text + "\n" + result_text(comparison.by_class) : text;
  }

  CloudComparisonJob job_;
  bool by_class_ = false, nearest_classes_ = false;
};

void add_row(TextTable& table, const std::string& name, const BeamAccuracy& a) {
  table.add_row({name, grouped(a.rays), percent(a.no_hit), centimetres(a.median_m),
                 fixed(a.mae_m, 3), fixed(a.rmse_m, 3), percent(a.within.at(0.05)),
                 percent(a.within.at(0.10)), percent(a.within.at(0.50)), percent(a.early_50cm),
                 percent(a.late_50cm)});
}

std::string returns_text(const std::string& name, const BeamReturns& returns) {
  return name + ": holes " + percent(returns.holes) + " of " + grouped(returns.returned) +
         " beams with return hit nothing; 'this beam returns': precision " +
         percent(returns.precision) + ", recall " + percent(returns.recall) + ", F1 " +
         percent(returns.f1) + "\n";
}

/// Ghosts and holes; empty if no beams without return could be identified.
std::string returns_text(const HeldOutResult& result) {
  const EmptyBeamHits& empty = result.empty;
  if (empty.beams == 0) return {};
  std::string text = "Ghosts: " + percent(empty.ghosts) + " of " + grouped(empty.beams) +
                     " beams without return hit the model within " + fixed(empty.reach_m, 1) +
                     " m\n" + returns_text("All beams", result.returns);
  if (result.upward_returns.returned > 0)
    text += returns_text("Only beams as far upward as those", result.upward_returns);
  return text;
}

std::string protocol_text(const Lidar4dEvaluation& result) {
  TextTable images({"LiDAR4D protocol", "RMSE", "MedAE", "SSIM", "PSNR"});
  const auto add = [&](const std::string& name, const ImageError& error) {
    images.add_row({name, fixed(error.rmse, 4), fixed(error.medae, 4), fixed(error.ssim, 4),
                    fixed(error.psnr_db, 2)});
  };
  add("depth, m", result.depth);
  if (result.intensity) add("intensity", *result.intensity);
  std::string text =
      "\n" + images.text() + "Ray drop: RMSE " + fixed(result.drop.rmse, 4) + ", accuracy " +
      fixed(result.drop.accuracy, 4) + ", F-score " + fixed(result.drop.f_score, 4) +
      "; points: Chamfer " + fixed(result.chamfer_m2, 4) + " m2, F-score " +
      fixed(result.f_score_224mm, 4) + " (squared distances below 0.05 m2, as in its code), " +
      fixed(result.f_score_5cm, 4) + " within 5 cm\n" + grouped(result.scans) +
      " scans as range images of " + grouped(result.layout.rows) + " x " +
      grouped(result.layout.columns) + "; " + std::string(kLidar4dComparable) + ":\n";
  for (const std::string_view difference : kLidar4dDiffers)
    text += "- " + std::string(difference) + "\n";
  return text;
}

std::string intensity_text(const ResimulateResult& result) {
  if (!result.intensities) return "";
  return "Intensities of beams within 50 cm: RMSE " + fixed(result.intensities->rmse_after_fit, 3) +
         " of the full scale after a linear fit, rank correlation " +
         fixed(result.intensities->rank_correlation, 2) + "\n";
}

std::string result_text(const HeldOutResult& result) {
  TextTable table({"beams", "rays", "no hit", "median", "MAE m", "RMSE m", "<5 cm", "<10 cm",
                   "<50 cm", "early", "late"});
  add_row(table, "all", result.all);
  if (result.with_given) add_row(table, "all, as given", result.with_given->all);
  if (result.registered) add_row(table, "all, registered to the model", result.registered->all);
  for (const auto* parts : {&result.by_range, &result.by_incidence, &result.by_surroundings,
                            &result.by_motion, &result.by_class}) {
    if (!parts->empty()) table.add_row({});
    for (const auto& [name, accuracy] : *parts) add_row(table, name, accuracy);
  }
  const CloudDistance& clouds = result.clouds;
  return table.text() + "\nPoses: " + std::string(word_of(result.poses, words_of(result.poses))) +
         "; beams from " + result.beams + "; Chamfer " + centimetres(clouds.chamfer_m) + ", " +
         fixed(clouds.chamfer_m2, 4) +
         " m2; shares are of all rays, errors of the rays that hit\n" + intensity_text(result) +
         returns_text(result) + (result.lidar4d ? protocol_text(*result.lidar4d) : "");
}

class EvaluateResimulateCommand final : public ResultCommand {
 public:
  explicit EvaluateResimulateCommand(CLI::App& evaluate)
      : ResultCommand(
            evaluate, "resimulate", "Cast the beams of held-out scans again and compare ranges",
            "  adasplats evaluate resimulate model.ply sequences/01\n"
            "  adasplats evaluate resimulate model.ply sequences/01 --max-range 80 --report "
            "held-out.json\n"
            "  adasplats evaluate resimulate model.ply sequences/01 --protocol lidar4d\n") {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.model, "Splat model or mesh"));
    require(add_path(app, "SEQUENCE", job_.sequence,
                     "SemanticKITTI sequence folder, or with --trajectory a folder of scans, one "
                     "per file"));
    add_path(app, "--trajectory", job_.trajectory,
             "Poses of the sensor (or of the vehicle) for a folder of scans");
    add_settings(app, static_cast<HeldOutScans&>(job_));
    add_path(app, "--boxes", job_.boxes,
             "Boxes of objects by time; points in boxes of moving objects are left out, or with "
             "--keep-moving counted separately");
    add_scheme(app, job_.labels, "Label scheme: a name or a TOML file")->capture_default_str();
    app.add_option("--min-range", job_.options.min_range_m, "Minimum range of a beam, m")
        ->capture_default_str();
    app.add_option("--max-range", job_.options.max_range_m, "Maximum range of a beam, m")
        ->capture_default_str();
    app.add_flag("--beams-from-poses", job_.beams_from_poses,
                 "Start beams at the poses, even if the sensor is recognised");
    add_path(
        app, "--motion", job_.motion,
        "Sensor motion during raw scans: poses in the sequence's time (CSV, TUM, KITTI poses)");
    app.add_flag("--all-poses", job_.extras.all_poses,
                 "Also with the poses as given, and with each scan registered to the model");
    add_choice<std::optional<HeldOutProtocol>>(
        app, "--protocol", job_.extras.protocol, choices_of_optional(kHeldOutProtocols),
        "Also the metrics of a publication: range images of 66 x 1030, depth, intensity, ray drop, "
        "points");
    app.add_flag("--keep-moving", keep_moving_, "Count beams on moving objects");
    app.add_flag("--drop-movable", job_.options.drop_movable,
                 "Leave out beams on movable objects (parked cars)");
    writes(add_path(app, "--picture", job_.picture,
                    "Also draw the middle scan, its points coloured by range error (PNG)"),
           {".png"});
    add_picture_width(app, job_.picture_width);
    writes(add_path(app, "--errors", job_.errors,
                    "Also write the measured points with their range errors (PLY; 'adasplats "
                    "view' shows them)"),
           {".ply"});
    add_scan_range(app, "--scans", job_.scans, "Scans of the sequence to use");
    add_device_options();
  }

 private:
  std::string make_result(Session& session) override {
    if (job_.picture.empty()) reject({"--picture-width"}, "without --picture");
    require_one_removal(keep_moving_, job_.options.drop_movable);
    job_.options.drop_moving = !keep_moving_;
    const HeldOutResult result = evaluate_resimulation(job_, session);
    session.report.update(to_json(result));
    return result_text(result);
  }

  ResimulateJob job_;
  bool keep_moving_ = false;
};

constexpr const char* kTruthDefinitions =
    "Rays have no noise and are limited to the sensor's ranges. Range errors (simulated - true)\n"
    "are of the rays that meet the true surface and hit the model, shares of all rays that meet\n"
    "the true surface. hole: the model has nothing there, or only more than 50 cm behind. ghost:\n"
    "of the rays without a true surface, those that hit the model. surface: distance of the\n"
    "simulated points to the nearest true surface. bleeding: simulated points more than 10 cm\n"
    "from the true surface and, with a margin of 10 cm, between the true ranges of the beam and\n"
    "its neighbours (in azimuth and on the rings above and below).\n";

void add_row(TextTable& table, const std::string& name, const TruthAccuracy& a) {
  table.add_row({name, grouped(a.range.rays), percent(a.hole_share), percent(a.range.early_50cm),
                 percent(a.range.late_50cm), centimetres(a.range.median_m),
                 fixed(a.range.rmse_m, 3), percent(a.range.within.at(0.05)),
                 percent(a.range.within.at(0.10)), centimetres(a.surface.mean_m),
                 centimetres(a.surface.median_m), centimetres(a.surface.p95_m)});
}

std::string result_text(const TruthResult& result) {
  TextTable table({"rays on", "rays", "hole", "early", "late", "range median", "RMSE m", "<5 cm",
                   "<10 cm", "surface mean", "median", "95 %"});
  add_row(table, "all", result.all);
  if (!result.by_class.empty()) table.add_row({});
  for (const auto& [name, accuracy] : result.by_class) add_row(table, name, accuracy);
  return table.text() + "\nghosts " + percent(result.ghost_share) + " of " +
         grouped(result.rays - result.all.range.rays) + " rays, bleeding " +
         percent(result.bleeding_share) + " of " + grouped(result.all.surface.points) +
         " points\n\n" + kTruthDefinitions;
}

class EvaluateTruthCommand final : public ResultCommand {
 public:
  explicit EvaluateTruthCommand(CLI::App& evaluate)
      : ResultCommand(
            evaluate, "truth",
            "Cast a sensor's rays into a model and the true surface and compare them",
            "  adasplats evaluate truth model.ply street/mesh.ply \\\n"
            "      --trajectory street/true_driving_trajectory.csv\n"
            "  adasplats evaluate truth model.ply street/mesh.ply --trajectory poses.csv \\\n"
            "      --offset 1,1,-0.5 --every 5 --drop-movable --report truth.json\n") {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.model, "Splat model or triangle mesh"));
    require(add_path(app, "TRUTH", job_.truth, "True surface: a triangle mesh, with classes"));
    require(add_path(app, "--trajectory", job_.trajectory,
                     "Poses of the sensor: KITTI poses.txt, CSV, TUM, or a sequence folder"));
    app.add_option("--sensor", job_.sensor, "Sensor; see 'adasplats sensors'")
        ->capture_default_str()
        ->type_name("NAME|FILE");
    add_vector(app, "--offset", offset_, "Shift of the trajectory in world axes, m")
        ->default_str("0,0,0");
    add_every(app, job_.every, "Use every n-th pose");
    add_scheme(app, job_.labels,
               "Label scheme of the mesh: a name or a TOML file (default: the scheme named in the "
               "file, else semantickitti)");
    app.add_flag("--keep-moving", keep_moving_, "Count rays on moving objects");
    app.add_flag("--drop-movable", job_.options.drop_movable,
                 "Leave out rays on movable objects (parked cars)");
    add_device_options();
  }

 private:
  std::string make_result(Session& session) override {
    job_.offset_m = offset_.value_or(Vec3d{});
    require_one_removal(keep_moving_, job_.options.drop_movable);
    job_.options.drop_moving = !keep_moving_;
    const TruthResult result = evaluate_truth(job_, session);
    session.report.update(to_json(result));
    return result_text(result);
  }

  TruthJob job_;
  std::optional<Vec3d> offset_;
  bool keep_moving_ = false;
};

std::string result_text(const PresenceResult& result) {
  TextTable table({"points", "count", "in the model"});
  const auto add = [&table](const std::string& name, const Presence& part) {
    if (part.points > 0) table.add_row({name, grouped(part.points), percent(part.share())});
  };
  add("all", result.all);
  add("still", result.still);
  add("moving", result.moving);
  if (!result.by_class.empty()) table.add_row({});
  for (const auto& [name, part] : result.by_class) add(name, part);
  return table.text();
}

class EvaluatePresenceCommand final : public ResultCommand {
 public:
  explicit EvaluatePresenceCommand(CLI::App& evaluate)
      : ResultCommand(
            evaluate, "presence", "Count the measured points at which a model has a surface",
            "  adasplats evaluate presence model.ply sequences/00\n"
            "  adasplats evaluate presence model.ply street/mapping.ply --labels semantickitti\n") {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.model, "Splat model or triangle mesh"));
    require(
        add_path(app, "POINTS", job_.points, "Point file with sensor positions, or a sequence"));
    add_scheme(app, job_.labels,
               std::string(kLabelSchemes) + "; default: semantickitti for sequence folders");
    app.add_option("--within", job_.options.within_m,
                   "Maximum distance from the point, along the ray that measured it, m")
        ->capture_default_str();
    app.add_option("--min-range", job_.options.min_range_m, "Minimum range of a point, m")
        ->capture_default_str();
    app.add_option("--max-range", job_.options.max_range_m, "Maximum range of a point, m")
        ->capture_default_str();
    add_load_options(app, job_.load);
    add_device_options();
  }

 private:
  std::string make_result(Session& session) override {
    const PresenceResult result = evaluate_presence(job_, session);
    session.report.update(to_json(result));
    return result_text(result);
  }

  PresenceJob job_;
};

std::string class_text(std::uint16_t id, const LabelScheme& labels) {
  const SemanticClass* const found = labels.find(id);
  return std::to_string(id) + (found != nullptr ? " " + found->name : "");
}

std::string result_text(const LabelAgreementResult& result, const LabelScheme& labels) {
  TextTable table({"simulated class", "points", "agree", "nearest original"});
  const auto add = [&table](const std::string& name, const LabelAgreement& part) {
    table.add_row(
        {name, grouped(part.points), percent(part.share()), centimetres(part.distance_m)});
  };
  for (const auto& [id, part] : result.by_class) add(class_text(id, labels), part);
  add("both labelled", result.labelled);
  add("all", result.all);
  return table.text();
}

std::string confusions_text(const LabelAgreementResult& result, const LabelScheme& labels) {
  constexpr std::size_t kConfusionsShown = 8;
  std::vector<std::pair<std::size_t, std::pair<std::uint16_t, std::uint16_t>>> largest;
  for (const auto& [classes, points] : result.confusions) largest.push_back({points, classes});
  std::ranges::sort(largest, std::greater<>());
  largest.resize(std::min(largest.size(), kConfusionsShown));
  TextTable table({"simulated class, class of the nearest original", "points", "of all"});
  for (const auto& [points, classes] : largest)
    table.add_row({class_text(classes.first, labels) + ", " + class_text(classes.second, labels),
                   grouped(points),
                   percent(static_cast<double>(points) / static_cast<double>(result.all.points))});
  return table.text();
}

class EvaluateLabelsCommand final : public ResultCommand {
 public:
  explicit EvaluateLabelsCommand(CLI::App& evaluate)
      : ResultCommand(evaluate, "labels",
                      "Count the simulated points that have the class of the nearest measured one",
                      "  adasplats evaluate labels simkitti32/sequences/08 dataset/sequences/08\n"
                      "  adasplats evaluate labels simkitti32/sequences/08 dataset/sequences/08 "
                      "--every 50\n") {
    OptionSet& app = options();
    require(add_path(app, "SIMULATED", job_.simulated, "Sequence folder with labels"));
    require(add_path(app, "ORIGINAL", job_.original, "The sequence that it was made from"));
    app.add_option("--window", job_.options.window,
                   "Original scans to search before and after the scan of the same time")
        ->capture_default_str()
        ->type_name("N");
    add_every(app, job_.options.every, "Use every n-th simulated scan");
    add_scheme(app, job_.labels, "Label scheme: semantickitti or a TOML file")
        ->capture_default_str();
  }

 private:
  std::string make_result(Session& session) override {
    const LabelScheme labels = load_label_scheme(job_.labels);
    const LabelAgreementResult result = evaluate_labels(job_, session);
    session.report.update(to_json(result));
    return result_text(result, labels) + "\n" + confusions_text(result, labels);
  }

  LabelAgreementJob job_;
};

constexpr const char* kSegmentationDefinitions =
    "IoU: correctly predicted points of a class, divided by the points that are of the class or\n"
    "are predicted to be. Only points with a true class count; a prediction of no class is "
    "wrong.\n";

/// One row for each class with true points, and their mean. `name_of` returns a class's name.
template <class NameOf>
std::string iou_table(const std::string& kind, const std::string& mean_name,
                      const SegmentationConfusion& confusion, double min_share,
                      const NameOf& name_of) {
  TextTable table({kind, "IoU", "precision", "recall", "share"});
  for (std::size_t c = 0; c < confusion.classes(); ++c) {
    if (confusion.of_truth(c) == 0) continue;
    table.add_row({name_of(c), percent(confusion.iou(c)), percent(confusion.precision(c)),
                   percent(confusion.recall(c)), percent(confusion.share(c))});
  }
  table.add_row({});
  table.add_row({mean_name, percent(confusion.mean_iou(min_share))});
  return table.text();
}

std::string result_text(const SegmentationResult& result) {
  const SegmentationConfusion& confusion = result.confusion;
  const double min_share = result.options.min_share;
  const std::vector<std::string> groups = segmentation_groups();
  return iou_table("class", "mean without rare classes", confusion, min_share,
                   [&](std::size_t c) {
                     return result.classes.classes()[c].name +
                            (confusion.is_rare(c, min_share) ? " (rare)" : "");
                   }) +
         "\n" +
         iou_table("group", "mean", grouped(confusion, result.classes), 0,
                   [&](std::size_t g) { return groups[g]; }) +
         "\naccuracy " + percent(confusion.accuracy()) + " of " + grouped(confusion.points()) +
         " points; " + grouped(confusion.ignored()) + " have no class\n\n" +
         kSegmentationDefinitions;
}

class EvaluateSegmentationCommand final : public ResultCommand {
 public:
  explicit EvaluateSegmentationCommand(CLI::App& evaluate)
      : ResultCommand(
            evaluate, "segmentation", "Compare predicted classes with the true ones",
            "  adasplats evaluate segmentation predicted/sequences/08 dataset/sequences/08\n"
            "  adasplats evaluate segmentation predicted dataset --scans 0:100 --report "
            "miou.json\n"
            "  adasplats evaluate segmentation predicted.ply true.las --labels classes.toml\n") {
    OptionSet& app = options();
    require(add_path(app, "PREDICTED", job_.predicted,
                     "Sequence folder or tree (its predictions, else its labels), .label file, or "
                     "points with classes"));
    require(add_path(app, "TRUE", job_.truth,
                     "The true labels of the same points, in any of these forms"));
    add_scheme(app, job_.labels,
               "Label scheme: semantickitti (the 19 classes of its benchmark), paris-carla-3d or "
               "a TOML file")
        ->capture_default_str();
    add_scan_range(app, "--scans", job_.scans, "Scans of each true sequence to use");
    app.add_option("--min-share", job_.options.min_share,
                   "Minimum share of the true points of a class that counts in the mean")
        ->capture_default_str();
  }

 private:
  std::string make_result(Session& session) override {
    const SegmentationResult result = evaluate_segmentation(job_, session);
    session.report.update(to_json(result));
    return result_text(result);
  }

  SegmentationJob job_;
};

constexpr const char* kRealismDefinitions =
    "AUC: how often a classifier gives a simulated patch of 8 x 64 beams a higher score than a\n"
    "real one, in scans it was not trained on: 0.5 by chance, 1 always; in brackets the 95 %\n"
    "interval over resampled scans. Real, real: one of every two neighbouring real scans takes "
    "the\n"
    "place of a simulated one. Boosted trees are the reference; logistic regression is a second\n"
    "opinion for those who tune a simulation against the trees. Statistics are means over scans;\n"
    "their AUC distinguishes scans by that number alone. Simulate SIMULATED at the poses of REAL:\n"
    "scans of two places differ as much as the places do.\n";

std::string interval_text(const std::optional<AucInterval>& test) {
  if (!test) return "-";
  return fixed(test->mean, 3) + " (" + fixed(test->low, 3) + " .. " + fixed(test->high, 3) + ")";
}

std::string tests_table(const RealismReport& report) {
  TextTable table({"AUC", "trees", "logistic", "real, real: trees", "logistic"});
  for (std::size_t t = 0; t < std::size(kRealismFeatures); ++t)
    table.add_row(
        {std::string(kRealismFeatures[t].first), interval_text(report.simulated_real.trees[t]),
         interval_text(report.simulated_real.logistic[t]), interval_text(report.real_real.trees[t]),
         interval_text(report.real_real.logistic[t])});
  return table.text();
}

/// With about four significant digits.
std::string value_text(double value) {
  const double size = value < 0 ? -value : value;
  return fixed(value, size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 4);
}

std::string statistics_table(const RealismReport& report) {
  TextTable table({"of a scan", "real", "simulated", "AUC"});
  const auto add = [&](const std::string& name, const StatisticPair& pair) {
    table.add_row({name, value_text(pair.real), value_text(pair.simulated), fixed(pair.auc, 2)});
  };
  for (std::size_t s = 0; s < report.statistics.size(); ++s) {
    const ScanStatistic& statistic = scan_statistics()[s];
    const std::string unit = *statistic.unit == 0 ? "" : std::string(", ") + statistic.unit;
    add(statistic.text + unit, report.statistics[s]);
  }
  add("distance to planes of the next scan, median, m", report.plane_residual_m);
  return table.text();
}

class EvaluateRealismCommand final : public ResultCommand {
 public:
  explicit EvaluateRealismCommand(CLI::App& evaluate)
      : ResultCommand(
            evaluate, "realism", "Test whether simulated scans can be distinguished from real ones",
            "  adasplats evaluate realism scans sequences/01_raw\n"
            "  adasplats evaluate realism scans sequences/00 --scans 0:40 --report realism.json\n"
            "  adasplats evaluate realism scans frames --trajectory vehicle.csv\n") {
    OptionSet& app = options();
    require(add_path(app, "SIMULATED", job_.simulated,
                     "Scans simulated at the poses of REAL: a sequence, or the output folder of "
                     "'adasplats simulate'"));
    require(add_path(app, "REAL", job_.real,
                     "Measured scans of the same sensor: a sequence, or a folder of files, one per "
                     "scan"));
    add_path(app, "--trajectory", job_.trajectory,
             "Poses for a folder of files without a poses.csv");
    add_scan_range(app, "--scans", job_.scans, "Scans of each side to use");
  }

 private:
  std::string make_result(Session& session) override {
    const RealismReport report = evaluate_realism(job_, session);
    session.report.update(to_json(report));
    return tests_table(report) + "\n" + statistics_table(report) + "\n" +
           grouped(report.simulated_real.patches) + " patches of " +
           grouped(report.simulated_scans) + " simulated and " + grouped(report.real_scans) +
           " real scans of a " + report.sensor + "\n\n" + kRealismDefinitions;
  }

  RealismJob job_;
};

}  // namespace

std::vector<std::unique_ptr<Command>> make_evaluate_commands(CLI::App& evaluate) {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(std::make_unique<EvaluateC2cCommand>(evaluate));
  commands.push_back(std::make_unique<EvaluateResimulateCommand>(evaluate));
  commands.push_back(std::make_unique<EvaluateTruthCommand>(evaluate));
  commands.push_back(std::make_unique<EvaluatePresenceCommand>(evaluate));
  commands.push_back(make_evaluate_echoes_command(evaluate));
  commands.push_back(make_evaluate_unit_command(evaluate));
  commands.push_back(std::make_unique<EvaluateLabelsCommand>(evaluate));
  commands.push_back(std::make_unique<EvaluateSegmentationCommand>(evaluate));
  commands.push_back(std::make_unique<EvaluateRealismCommand>(evaluate));
  return commands;
}

}  // namespace adasplats::app
