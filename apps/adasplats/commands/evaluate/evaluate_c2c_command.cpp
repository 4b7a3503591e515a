// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "commands/evaluate/evaluate_job.h"

namespace adasplats::app {
namespace {

constexpr const char* kEvaluateC2cExamples =
    "  adasplats evaluate c2c scans street/mapping.ply\n"
    "  adasplats evaluate c2c scans street/mapping.ply --by-class --labels semantickitti\n"
    "  adasplats evaluate c2c scans street/mapping.ply --picture distances.png\n";

std::string table_of(const CloudDistance& distance) {
  TextTable table({"measure", "value"});
  table.add_row({"C2C (simulated to original)", centimetres(distance.c2c_m)});
  table.add_row({"completeness (original to simulated)", centimetres(distance.completeness_m)});
  table.add_row({"Chamfer, mean of both", centimetres(distance.chamfer_m)});
  table.add_row({"Chamfer, sum of mean squares", fixed(distance.chamfer_m2, 5) + " m2"});
  for (const auto& [bound_m, score] : distance.f_score) {
    table.add_row({"F-score at " + fixed(100 * bound_m, 1) + " cm", fixed(score, 4)});
  }
  table.add_row({"simulated points", grouped(distance.simulated_points)});
  table.add_row({"original points", grouped(distance.original_points)});
  return table.text();
}

std::string table_of(const std::vector<std::pair<std::string, ClassDistance>>& by_class) {
  TextTable table({"class", "C2C", "C2C to all", "simulated", "original"});
  for (const auto& [name, distance] : by_class) {
    table.add_row({name, centimetres(distance.c2c_m), centimetres(distance.c2c_to_all_m),
                   grouped(distance.simulated_points), grouped(distance.original_points)});
  }
  return table.text();
}

class EvaluateC2cCommand final : public Command {
 public:
  explicit EvaluateC2cCommand(CLI::App& evaluate)
      : Command(evaluate, "c2c", "Distances between simulated and measured points",
                kEvaluateC2cExamples) {
    OptionSet& app = options();
    require(add_path(app, "SIMULATED", job_.simulated,
                     "Point file, sequence folder or output of simulate"));
    require(add_path(app, "ORIGINAL", job_.original, "Likewise"));
    app.add_flag("--by-class", by_class_, "Also by semantic class");
    app.add_flag("--nearest-classes", nearest_classes_,
                 "A simulated point is of the class of the nearest original one, whatever its own");
    app.add_option("--labels", job_.labels,
                   "Names the classes: semantickitti, paris-carla-3d, pandaset, nuscenes, asprs or "
                   "a TOML file")
        ->type_name("SCHEME");
    writes(add_path(
               app, "--picture", job_.picture,
               "Also draw the simulated points, coloured by their distance to the original (PNG)"),
           {".png"});
    writes(add_path(
               app, "--errors", job_.errors,
               "Also write the simulated points with their distances (PLY; 'adasplats view' shows "
               "them)"),
           {".ply"});
    add_vector(app, "--eye", job_.view.eye, "Where the picture's camera is, world coordinates");
    add_vector(app, "--target", job_.view.target, "What it looks at; the middle of the original");
    add_picture_width(app, job_.view.width);
  }

  void run(Session& session) override {
    if (!by_class_) refuse({"--labels", "--nearest-classes"}, "without --by-class");
    if (by_class_) job_.by_class = nearest_classes_ ? ByClass::nearest : ByClass::own;
    if (job_.picture.empty()) {
      refuse({"--eye", "--target", "--picture-width"}, "without --picture");
    }
    job_.view.height = job_.view.width * 9 / 16;
    const Stopwatch watch;
    const CloudComparison comparison = run_cloud_comparison(job_, session);
    session.report.update(to_json(comparison));
    session.report["seconds"]["total"] = watch.seconds();
    std::string text = table_of(comparison.distance);
    if (by_class_) text += "\n" + table_of(comparison.by_class);
    print(text);
  }

 private:
  CloudComparisonJob job_;
  bool by_class_ = false, nearest_classes_ = false;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_c2c_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateC2cCommand>(evaluate);
}

}  // namespace adasplats::app
