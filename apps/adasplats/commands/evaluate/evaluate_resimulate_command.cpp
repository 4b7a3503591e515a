// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/provenance/metrics_json.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "commands/evaluate/evaluate_job.h"

namespace adasplats::app {
namespace {

constexpr const char* kEvaluateResimulateExamples =
    "  adasplats evaluate resimulate place.ply sequences/01\n"
    "  adasplats evaluate resimulate place.ply sequences/01 --max-range 80 --report "
    "held-out.json\n"
    "  adasplats evaluate resimulate place.ply sequences/01 --protocol lidar4d\n";

void add_row(TextTable& table, const std::string& name, const BeamAccuracy& a) {
  table.add_row({name, grouped(a.rays), percent(a.no_hit), centimetres(a.median_m),
                 fixed(a.mae_m, 3), fixed(a.rmse_m, 3), percent(a.within.at(0.05)),
                 percent(a.within.at(0.10)), percent(a.within.at(0.50)), percent(a.early_50cm),
                 percent(a.late_50cm)});
}

/// Of the beams that returned nothing.
std::string ghosts_of(const EmptyBeamHits& empty) {
  return "Ghosts: " + percent(empty.ghosts) + " of " + grouped(empty.beams) +
         " beams without return hit the model within " + fixed(empty.reach_m, 1) + " m\n";
}

std::string returns_of(const std::string& name, const BeamReturns& returns) {
  return name + ": holes " + percent(returns.holes) + " of " + grouped(returns.returned) +
         " that returned hit nothing; 'this beam returns': precision " +
         percent(returns.precision) + ", recall " + percent(returns.recall) + ", F1 " +
         percent(returns.f1) + "\n";
}

/// Ghosts and their converse; empty where no empty beams are known.
std::string returns_of(const HeldOutResult& result) {
  if (result.empty.beams == 0) return {};
  std::string text = ghosts_of(result.empty) + returns_of("All beams", result.returns);
  if (result.upward_returns.returned > 0)
    text += returns_of("Beams as far up as those", result.upward_returns);
  return text;
}

void add_images(TextTable& table, const std::string& name, const ImageError& error) {
  table.add_row({name, fixed(error.rmse, 4), fixed(error.medae, 4), fixed(error.ssim, 4),
                 fixed(error.psnr_db, 2)});
}

/// By the protocol of LiDAR4D, and what it may be compared with.
std::string protocol_of(const Lidar4dEvaluation& result) {
  TextTable images({"LiDAR4D protocol", "RMSE", "MedAE", "SSIM", "PSNR"});
  add_images(images, "depth, m", result.depth);
  if (result.intensity) add_images(images, "intensity", *result.intensity);
  std::string text =
      "\n" + images.text() + "Ray drop: RMSE " + fixed(result.drop.rmse, 4) + ", accuracy " +
      fixed(result.drop.accuracy, 4) + ", F-score " + fixed(result.drop.f_score, 4) +
      "; points: Chamfer " + fixed(result.chamfer_m2, 4) + " m2, F-score " +
      fixed(result.f_score_224mm, 4) + " (squared distances below 0.05 m2, as its code has it), " +
      fixed(result.f_score_5cm, 4) + " within 5 cm\n" + grouped(result.scans) +
      " scans as range images of " + grouped(result.layout.rows) + " x " +
      grouped(result.layout.columns) + "; " + std::string(kLidar4dComparable) + ":\n";
  for (const std::string_view difference : kLidar4dDiffers)
    text += "- " + std::string(difference) + "\n";
  return text;
}

std::string table_of(const HeldOutResult& result) {
  TextTable table({"beams", "rays", "no hit", "median", "MAE m", "RMSE m", "<5 cm", "<10 cm",
                   "<50 cm", "early", "late"});
  add_row(table, "all", result.all);
  if (result.with_given) add_row(table, "all, as given", result.with_given->all);
  if (result.registered) add_row(table, "all, registered to the model", result.registered->all);
  for (const auto* parts : {&result.by_range, &result.by_incidence, &result.by_class}) {
    if (!parts->empty()) table.add_row({});
    for (const auto& [name, accuracy] : *parts) add_row(table, name, accuracy);
  }
  const CloudDistance& clouds = result.clouds;
  return table.text() + "\nPoses: " + std::string(word_of(result.poses, words_of(result.poses))) +
         "; beams from " + result.beams + "; Chamfer " + centimetres(clouds.chamfer_m) + ", " +
         fixed(clouds.chamfer_m2, 4) + " m2; shares are of all rays, errors of hits\n" +
         returns_of(result) + (result.lidar4d ? protocol_of(*result.lidar4d) : "");
}

class EvaluateResimulateCommand final : public Command {
 public:
  explicit EvaluateResimulateCommand(CLI::App& evaluate)
      : Command(evaluate, "resimulate", "Cast the beams of held-out scans again",
                kEvaluateResimulateExamples) {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.model, "Splat model or mesh"));
    require(add_path(app, "SEQUENCE", job_.sequence,
                     "SemanticKITTI sequence folder, or with --trajectory a folder of scans, one a "
                     "file"));
    add_path(app, "--trajectory", job_.trajectory,
             "Poses of the sensor (or of the vehicle) for a folder of scans");
    add_settings(app, static_cast<HeldOutScans&>(job_));
    add_path(app, "--boxes", job_.boxes,
             "Boxes of objects by time; what those that move hold is left out");
    app.add_option("--labels", job_.labels, "What labels mean: a name or a TOML file")
        ->capture_default_str()
        ->type_name("SCHEME");
    app.add_option("--min-range", job_.options.min_range_m, "Nearer beams are left out, m")
        ->capture_default_str();
    app.add_option("--max-range", job_.options.max_range_m, "Farther beams are left out, m")
        ->capture_default_str();
    app.add_flag("--beams-from-poses", job_.beams_from_poses,
                 "Beams start at the poses, even where the sensor is recognised");
    add_path(app, "--motion", job_.motion,
             "How the sensor moved, for scans that are not motion-compensated: poses in the "
             "sequence's time (CSV, TUM, KITTI poses)");
    app.add_flag("--all-poses", job_.extras.all_poses,
                 "Also with the poses as given, and with each scan registered to the model");
    add_choice<std::optional<HeldOutProtocol>>(app, "--protocol", job_.extras.protocol,
                                               choices_of_optional(kHeldOutProtocols),
                                               "Also the measures of a publication: range images "
                                               "of 66 x 1030, depth, intensity, ray drop, "
                                               "points");
    app.add_flag("--keep-moving", keep_moving_, "Count beams on moving objects");
    app.add_flag("--drop-movable", job_.options.drop_movable,
                 "Leave out beams on movable objects (parked cars)");
    writes(add_path(app, "--picture", job_.picture,
                    "Also draw the middle scan, its points coloured by the range error (PNG)"),
           {".png"});
    add_picture_width(app, job_.picture_width);
    writes(
        add_path(
            app, "--errors", job_.errors,
            "Also write the measured points with their range errors (PLY; 'adasplats view' shows "
            "them)"),
        {".ply"});
    add_scan_range(app, "--scans", job_.scans, "Which scans of the sequence");
    add_device_options();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    if (job_.picture.empty()) refuse({"--picture-width"}, "without --picture");
    if (keep_moving_ && job_.options.drop_movable) {
      throw Error(ErrorKind::usage, "--keep-moving and --drop-movable exclude each other");
    }
    job_.options.drop_moving = !keep_moving_;
    const HeldOutResult result = run_resimulate(job_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    print(table_of(result));
  }

 private:
  ResimulateJob job_;
  bool keep_moving_ = false;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_resimulate_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateResimulateCommand>(evaluate);
}

}  // namespace adasplats::app
