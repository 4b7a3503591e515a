// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/evaluate/fit_sensor.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kFitSensorExamples =
    "  adasplats fit-sensor place.ply sequences/01_raw --motion sequences/00 -o unit.toml \\\n"
    "    --scans 0:80:2\n"
    "  adasplats simulate place.ply --trajectory sequences/01_raw --sensor unit.toml \\\n"
    "    --unit-offsets -o scans\n";

class FitSensorCommand final : public Command {
 public:
  explicit FitSensorCommand(CLI::App& program)
      : Command(program, "fit-sensor", "Learn from real scans what one unit of a sensor measures",
                kFitSensorExamples) {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.model, "Splat model of the place"));
    require(add_path(app, "SCANS", job_.scans_of,
                     "Measured scans in that place: a sequence, or a folder of files, one a scan"));
    require(writes(add_path(app, "-o,--output", output_, "Sensor to write, TOML"), {".toml"}));
    add_path(app, "--motion", job_.motion,
             "Pose file or sequence that tells how the sensor moved during raw scans; the default "
             "is SCANS itself, whose poses may be far apart");
    add_path(app, "--trajectory", job_.trajectory,
             "Poses of a folder of files without a poses.csv in it");
    add_scan_range(app, "--scans", job_.scans, "Which scans, to keep others for a test");
    add_device_options();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const FitSensorResult result = run_fit_sensor(job_, output_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    print(text_of(result));
  }

 private:
  std::string text_of(const FitSensorResult& result) const {
    TextTable table({"of this unit", "fitted"});
    table.add_row({"sensor", result.sensor});
    table.add_row({"beams, returns of " + grouped(result.scans) + " scans",
                   grouped(result.beams) + ", " + grouped(result.returns)});
    table.add_row({"returns within 0.5 m of the model", fixed(100 * result.agreement, 1) + " %"});
    table.add_row({"range offsets of lasers",
                   result.has_offsets ? "of the model's calibration" : "none: no calibration"});
    if (!result.ring_noise_m.empty()) {
      const auto [least, most] = std::ranges::minmax(result.ring_noise_m);
      table.add_row(
          {"range noise of lasers, mm", fixed(1e3 * least, 1) + " to " + fixed(1e3 * most, 1)});
    }
    table.add_row(
        {"farthest range, m", result.max_range_m ? fixed(*result.max_range_m, 1) : "the sensor's"});
    if (result.intensity) {
      table.add_row({"intensity: step, highest", fixed(result.intensity->step, 4) + ", " +
                                                     fixed(result.intensity->highest, 2)});
    }
    if (result.drop) {
      double lost = 0;
      for (const double share : result.drop->edge_runs) lost += share;
      table.add_row({"range edges with lost beams", fixed(100 * lost, 1) + " %"});
      table.add_row({"blocked sectors", grouped(result.drop->blocked.size())});
    }
    if (result.body)
      table.add_row({"half degrees that end on the vehicle", grouped(result.body->cells.size())});
    if (result.fields)
      table.add_row({"turns that tell what is alike", grouped(result.fields->turns)});
    std::string text = table.text();
    for (const std::string& reason : result.not_told) text += "not told: " + reason + "\n";
    text += "\n" + output_.string() + ": simulate --sensor " + output_.string();
    if (result.has_offsets) text += " --unit-offsets";
    return text + "; judge it by scans that it was not fitted to\n";
  }

  FitSensorJob job_;
  std::filesystem::path output_;
};

}  // namespace

std::unique_ptr<Command> make_fit_sensor_command(CLI::App& program) {
  return std::make_unique<FitSensorCommand>(program);
}

}  // namespace adasplats::app
