// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/evaluate/evaluate_truth.h"
#include "adasplats/jobs/provenance/metrics_json.h"
#include "adasplats/sensors/lidar_model.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kEvaluateTruthExamples =
    "  adasplats evaluate truth model.ply street/mesh.ply \\\n"
    "      --trajectory street/true_driving_trajectory.csv\n"
    "  adasplats evaluate truth model.ply street/mesh.ply --trajectory poses.csv \\\n"
    "      --offset 1,1,-0.5 --every 5 --drop-movable --report truth.json\n";

constexpr const char* kDefinitions =
    "Rays without noise, within the sensor's ranges. range: of rays that meet the true surface,\n"
    "simulated - true; shares are of these rays, errors of those that hit the model. hole: the\n"
    "model has nothing there, or later by more than 50 cm. ghost: of rays without a true surface,\n"
    "those that hit the model. surface: distance of the simulated points to the nearest true\n"
    "surface. bleeding: share of the simulated points farther than 10 cm from the true surface "
    "and\n"
    "strictly between (10 cm margin) the true ranges of two of: the beam, its neighbours in\n"
    "azimuth and on the rings above and below.\n";

void add_row(TextTable& table, const std::string& name, const TruthAccuracy& a) {
  table.add_row({name, grouped(a.range.rays), percent(a.hole_share), percent(a.range.early_50cm),
                 percent(a.range.late_50cm), centimetres(a.range.median_m),
                 fixed(a.range.rmse_m, 3), percent(a.range.within.at(0.05)),
                 percent(a.range.within.at(0.10)), centimetres(a.surface.mean_m),
                 centimetres(a.surface.median_m), centimetres(a.surface.p95_m)});
}

std::string table_of(const TruthResult& result) {
  TextTable table({"rays on", "rays", "hole", "early", "late", "range median", "RMSE m", "<5 cm",
                   "<10 cm", "surface mean", "median", "95 %"});
  add_row(table, "all", result.all);
  if (!result.by_class.empty()) table.add_row({});
  for (const auto& [name, accuracy] : result.by_class) add_row(table, name, accuracy);
  return table.text() + "\nghosts " + percent(result.ghost_share) + " of " +
         grouped(result.rays - result.all.range.rays) + " rays, bleeding " +
         percent(result.bleeding_share) + " of " + grouped(result.all.surface.points) +
         " points\n\n" + kDefinitions;
}

class EvaluateTruthCommand final : public Command {
 public:
  explicit EvaluateTruthCommand(CLI::App& evaluate)
      : Command(evaluate, "truth", "Cast a sensor's rays into a model and into the true surface",
                kEvaluateTruthExamples) {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.model, "Splat model or triangle mesh"));
    require(add_path(app, "TRUTH", job_.truth, "True surface: a triangle mesh, with classes"));
    require(add_path(app, "--trajectory", job_.trajectory,
                     "Poses of the sensor: KITTI poses.txt, CSV, TUM, or a sequence folder"));
    app.add_option("--sensor", job_.sensor, "As of simulate")
        ->capture_default_str()
        ->type_name("NAME|FILE");
    add_vector(app, "--offset", offset_, "Shift of the trajectory in world axes, m")
        ->default_str("0,0,0");
    app.add_option("--every", job_.every, "Take every n-th pose")
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--labels", job_.labels,
                   "What the mesh's classes mean: a name or a TOML file (default: what the file "
                   "says, else semantickitti)")
        ->type_name("SCHEME");
    app.add_flag("--keep-moving", keep_moving_, "Count rays on moving objects");
    app.add_flag("--drop-movable", job_.options.drop_movable,
                 "Leave out rays on movable objects (parked cars)");
    add_device_options();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    job_.offset_m = offset_.value_or(Vec3d{});
    if (keep_moving_ && job_.options.drop_movable) {
      throw Error(ErrorKind::usage, "--keep-moving and --drop-movable exclude each other");
    }
    job_.options.drop_moving = !keep_moving_;
    const TruthResult result = evaluate_truth(job_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    print(table_of(result));
  }

 private:
  TruthJob job_;
  std::optional<Vec3d> offset_;
  bool keep_moving_ = false;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_truth_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateTruthCommand>(evaluate);
}

}  // namespace adasplats::app
