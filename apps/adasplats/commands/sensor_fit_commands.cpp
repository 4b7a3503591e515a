// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The response of a real sensor: `fit-drop` and `fit-sensor` fit it to measured scans, `evaluate
// echoes` and `evaluate unit` test the predictions on other scans.

#include <algorithm>

#include "adasplats/core/error.h"
#include "adasplats/jobs/evaluate/evaluate_echoes.h"
#include "adasplats/jobs/evaluate/fit_sensor.h"
#include "adasplats/jobs/output/output_folder.h"
#include "cli/options/option_types.h"
#include "cli/text_table.h"
#include "commands/result_command.h"

namespace adasplats::app {
namespace {

constexpr const char* kMotionHelp =
    "Sensor motion during raw scans: a pose file or a sequence; the default, the poses of the "
    "scans, may be too sparse";

/// A command on MODEL and SEQUENCE.
class EchoCommand : public ResultCommand {
 public:
  using ResultCommand::ResultCommand;

 protected:
  void add_echo_inputs() {
    OptionSet& app = options();
    require(add_path(app, "MODEL", echo_inputs.model, "Splat model"));
    require(add_path(app, "SEQUENCE", echo_inputs.sequence,
                     "SemanticKITTI sequence folder; missing returns are identified in raw scans "
                     "of an HDL-64E"));
    add_path(app, "--motion", echo_inputs.motion, kMotionHelp);
    app.add_option("--sensor", echo_inputs.sensor,
                   "Sensor whose beams are searched for in raw scans")
        ->capture_default_str()
        ->type_name("NAME|FILE");
  }

  static TextTable drop_table() {
    return TextTable({"beams without return", "beams", "empty", "F1", "precision", "recall"});
  }
  static void add_row(TextTable& table, const std::string& name, const DropAccuracy& drop) {
    table.add_row({name, grouped(drop.beams), grouped(drop.empty), fixed(drop.f1(), 3),
                   fixed(drop.precision(), 3), fixed(drop.recall(), 3)});
  }

  EchoInputs echo_inputs;
};

class FitDropCommand final : public EchoCommand {
 public:
  explicit FitDropCommand(CLI::App& program)
      : EchoCommand(program, "fit-drop", "Learn from raw scans which beams return no echo",
                    "  adasplats fit-drop place.ply sequences/01_raw --motion sequences/00 -o "
                    "drop.toml --every 2\n"
                    "  adasplats evaluate echoes place.ply sequences/01_raw --motion sequences/00 "
                    "\\\n"
                    "    --drop drop.toml --scans 1:4:2\n") {
    OptionSet& app = options();
    add_echo_inputs();
    require(writes(add_path(app, "-o,--output", output_, "Drop model to write, TOML"), {".toml"}));
    app.add_option("--every", every_, "Use every n-th scan, and keep the others for a test")
        ->capture_default_str();
    add_device_options();
  }

 private:
  std::string make_result(Session& session) override {
    if (every_ == 0) throw Error(ErrorKind::usage, "--every is 0, expected 1 or more");
    echo_inputs.scans.stride = every_;
    check_output_file(output_);
    const FitDropResult result = fit_drop(echo_inputs, session);
    save_ray_drop(output_, result.model);
    session.report.update(to_json(result));
    TextTable table = drop_table();
    add_row(table, "misses alone", result.misses);
    add_row(table, "with the drop model", result.drop);
    return table.text() + "\n" + output_.string() + ": from " + grouped(result.scans) + " scans, " +
           grouped(result.model.blocked.size()) +
           " blocked sectors; evaluate it on scans that it was not fitted to\n";
  }

  std::filesystem::path output_;
  std::size_t every_ = 1;
};

class EvaluateEchoesCommand final : public EchoCommand {
 public:
  explicit EvaluateEchoesCommand(CLI::App& evaluate)
      : EchoCommand(evaluate, "echoes",
                    "Compare predicted intensities and missing returns with held-out scans",
                    "  adasplats evaluate echoes place.ply sequences/01\n"
                    "  adasplats evaluate echoes place.ply sequences/01_raw --motion sequences/00 "
                    "\\\n"
                    "    --drop drop.toml --scans 1:4:2\n") {
    OptionSet& app = options();
    add_echo_inputs();
    add_path(app, "--drop", drop_, "Drop model that fit-drop made from other scans");
    add_scan_range(app, "--scans", echo_inputs.scans, "Scans of the sequence to use");
    add_device_options();
  }

 private:
  std::string make_result(Session& session) override {
    echo_inputs.sensor_is_asked = is_given("--sensor");
    const EchoResult result = evaluate_echoes(echo_inputs, drop_, session);
    session.report.update(to_json(result));
    const IntensityAccuracy& intensity = result.intensity;
    std::string text = "intensity: rank correlation " + fixed(intensity.rank_correlation, 3) +
                       ", mean absolute error " + fixed(intensity.mae, 3) + " of " +
                       grouped(intensity.rays) + " beams\n";
    if (!result.misses) return text;
    TextTable table = drop_table();
    add_row(table, "misses alone", *result.misses);
    if (result.drop) add_row(table, "with the drop model", *result.drop);
    if (result.unblocked) add_row(table, "without blocked beams", *result.unblocked);
    return text + "\n" + table.text();
  }

  std::filesystem::path drop_;
};

/// MODEL and SCANS, --motion and --trajectory. Returns the required options.
std::vector<Option*> add_unit_scans(OptionSet& app, UnitScansJob& job) {
  std::vector<Option*> required = {
      add_path(app, "MODEL", job.model, "Splat model of the scene"),
      add_path(app, "SCANS", job.scans_of,
               "Measured scans of that scene: a sequence, or a folder of files, one per scan")};
  add_path(app, "--motion", job.motion, kMotionHelp);
  add_path(app, "--trajectory", job.trajectory, "Poses for a folder of files without a poses.csv");
  return required;
}

class FitSensorCommand final : public ResultCommand {
 public:
  explicit FitSensorCommand(CLI::App& program)
      : ResultCommand(program, "fit-sensor",
                      "Learn from real scans how one physical sensor measures",
                      "  adasplats fit-sensor place.ply sequences/01_raw --motion sequences/00 -o "
                      "unit.toml \\\n"
                      "    --scans 0:80:2\n"
                      "  adasplats simulate place.ply --trajectory sequences/01_raw --sensor "
                      "unit.toml \\\n"
                      "    --sensor-offsets -o scans\n") {
    OptionSet& app = options();
    for (Option* option : add_unit_scans(app, job_)) require(option);
    require(writes(add_path(app, "-o,--output", output_, "Calibrated sensor to write, TOML"),
                   {".toml"}));
    add_scan_range(app, "--scans", job_.scans, "Scans to use; keep others for a test");
    add_device_options();
  }

 private:
  std::string make_result(Session& session) override {
    const FitSensorResult result = run_fit_sensor(job_, output_, session);
    session.report.update(to_json(result));
    std::string text = table_of(result).text();
    for (const std::string& reason : result.not_estimated)
      text += "not estimated: " + reason + "\n";
    text += "\n" + output_.string() + ": simulate --sensor " + output_.string();
    if (result.has_offsets) text += " --sensor-offsets";
    return text + "; evaluate it on scans that it was not fitted to\n";
  }

  static TextTable table_of(const FitSensorResult& result) {
    TextTable table({"calibrated sensor", "fitted"});
    table.add_row({"sensor", result.sensor});
    table.add_row({"beams, returns of " + grouped(result.scans) + " scans",
                   grouped(result.beams) + ", " + grouped(result.returns)});
    table.add_row({"returns within 0.5 m of the model", percent(result.agreement)});
    table.add_row({"range offsets of lasers",
                   result.has_offsets ? "from the model's calibration" : "none: no calibration"});
    if (!result.ring_noise_m.empty()) {
      const auto [min_m, max_m] = std::ranges::minmax(result.ring_noise_m);
      table.add_row(
          {"range noise of lasers, mm", fixed(1e3 * min_m, 1) + " to " + fixed(1e3 * max_m, 1)});
    }
    table.add_row(
        {"maximum range, m", result.max_range_m ? fixed(*result.max_range_m, 1) : "the sensor's"});
    if (result.intensity)
      table.add_row({"intensity: step, highest", fixed(result.intensity->step, 4) + ", " +
                                                     fixed(result.intensity->highest, 2)});
    if (result.drop) {
      double lost = 0;
      for (const double share : result.drop->edge_runs) lost += share;
      table.add_row({"range edges with lost beams", percent(lost)});
      table.add_row({"blocked sectors", grouped(result.drop->blocked.size())});
    }
    if (result.body)
      table.add_row({"half degrees that end on the vehicle", grouped(result.body->cells.size())});
    if (result.fields) table.add_row({"turns stored as measured", grouped(result.fields->turns)});
    return table;
  }

  FitSensorJob job_;
  std::filesystem::path output_;
};

class EvaluateUnitCommand final : public ResultCommand {
 public:
  explicit EvaluateUnitCommand(CLI::App& evaluate)
      : ResultCommand(evaluate, "unit",
                      "Compare a calibrated sensor's predictions with scans it was not fitted to",
                      "  adasplats evaluate unit place.ply sequences/01 --sensor unit.toml\n"
                      "  adasplats evaluate unit place.ply sequences/01_raw --motion sequences/00 "
                      "\\\n"
                      "    --sensor unit.toml --scans 1:4:2\n") {
    OptionSet& app = options();
    for (Option* option : add_unit_scans(app, job_.scans)) require(option);
    require(app.add_option("--sensor", job_.sensor, "Calibrated sensor: a file from fit-sensor")
                ->type_name("NAME|FILE"));
    add_scan_range(app, "--scans", job_.scans.scans,
                   "Scans to use, other than those that it was fitted to");
    add_device_options();
  }

 private:
  std::string make_result(Session& session) override {
    const EvaluateUnitResult result = evaluate_unit(job_, session);
    session.report.update(to_json(result));
    TextTable intensities({"intensity", "returns", "rank correlation", "RMSE after one curve"});
    const auto add_intensity = [&](const char* name, const UnitIntensityAccuracy& of) {
      intensities.add_row({name, grouped(of.returns), fixed(of.rank_correlation, 3),
                           fixed(of.rmse_after_curve, 4)});
    };
    add_intensity("all", result.intensity);
    add_intensity("within 0.5 m of the model", result.near);
    TextTable drops({"beams lost", "beams", "lost", "F1", "precision", "recall", "accuracy"});
    const auto add_drop = [&](const char* name, const UnitDropAccuracy& of) {
      drops.add_row({name, grouped(of.beams.beams), grouped(of.beams.empty),
                     fixed(of.beams.f1(), 3), fixed(of.beams.precision(), 3),
                     fixed(of.beams.recall(), 3), percent(of.right_share)});
    };
    add_drop("all", result.drop);
    add_drop("outside the vehicle's shadow", result.unblocked);
    add_drop("the same, as many lost as expected", result.by_rate);
    return intensities.text() + "\n" + drops.text() + "\n" + percent(result.agreement) +
           " of the returns of " + grouped(result.scans) + " scans are within 0.5 m of the model\n";
  }

  EvaluateUnitJob job_;
};

}  // namespace

std::unique_ptr<Command> make_fit_drop_command(CLI::App& program) {
  return std::make_unique<FitDropCommand>(program);
}

std::unique_ptr<Command> make_fit_sensor_command(CLI::App& program) {
  return std::make_unique<FitSensorCommand>(program);
}

std::unique_ptr<Command> make_evaluate_echoes_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateEchoesCommand>(evaluate);
}

std::unique_ptr<Command> make_evaluate_unit_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateUnitCommand>(evaluate);
}

}  // namespace adasplats::app
