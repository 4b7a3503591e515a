// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/evaluate/evaluate_unit.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kEvaluateUnitExamples =
    "  adasplats evaluate unit place.ply sequences/01 --sensor unit.toml\n"
    "  adasplats evaluate unit place.ply sequences/01_raw --motion sequences/00 \\\n"
    "    --sensor unit.toml --scans 1:4:2\n";

std::string percent(double share) { return fixed(100 * share, 1) + " %"; }

std::string text_of(const EvaluateUnitResult& result) {
  TextTable intensities({"intensity", "returns", "rank correlation", "RMSE after one curve"});
  const auto add_intensity = [&](const char* name, const UnitIntensityAccuracy& of) {
    intensities.add_row(
        {name, grouped(of.returns), fixed(of.rank_correlation, 3), fixed(of.rmse_after_curve, 4)});
  };
  add_intensity("all", result.intensity);
  add_intensity("within 0.5 m of the model", result.near);
  TextTable drops({"beams lost", "beams", "lost", "F1", "precision", "recall", "accuracy"});
  const auto add_drop = [&](const char* name, const UnitDropAccuracy& of) {
    drops.add_row({name, grouped(of.beams.beams), grouped(of.beams.empty), fixed(of.beams.f1(), 3),
                   fixed(of.beams.precision(), 3), fixed(of.beams.recall(), 3),
                   percent(of.right_share)});
  };
  add_drop("all", result.drop);
  add_drop("outside of the vehicle's shadow", result.unblocked);
  add_drop("the same, as many as expected", result.by_rate);
  return intensities.text() + "\n" + drops.text() + "\n" + percent(result.agreement) +
         " of the returns of " + grouped(result.scans) + " scans lie within 0.5 m of the model\n";
}

class EvaluateUnitCommand final : public Command {
 public:
  explicit EvaluateUnitCommand(CLI::App& evaluate)
      : Command(evaluate, "unit",
                "How well what fit-sensor learned foretells intensities and lost beams of other "
                "scans",
                kEvaluateUnitExamples) {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.scans.model, "Splat model of the place"));
    require(add_path(app, "SCANS", job_.scans.scans_of,
                     "Measured scans in that place: a sequence, or a folder of files, one a scan"));
    require(app.add_option("--sensor", job_.sensor, "The unit: a file of fit-sensor")
                ->type_name("NAME|FILE"));
    add_path(app, "--motion", job_.scans.motion,
             "Pose file or sequence that tells how the sensor moved during raw scans; the default "
             "is SCANS itself, whose poses may be far apart");
    add_path(app, "--trajectory", job_.scans.trajectory,
             "Poses of a folder of files without a poses.csv in it");
    add_scan_range(app, "--scans", job_.scans.scans, "Which scans: others than it was fitted to");
    add_device_options();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const EvaluateUnitResult result = evaluate_unit(job_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    print(text_of(result));
  }

 private:
  EvaluateUnitJob job_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_unit_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateUnitCommand>(evaluate);
}

}  // namespace adasplats::app
