// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/io/point_format.h"
#include "adasplats/jobs/calibrate/calibrate.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "commands/calibration_text.h"

namespace adasplats::app {
namespace {

constexpr const char* kCalibrateExamples =
    "  adasplats calibrate sequences/00 -o calibrated\n"
    "  adasplats calibrate frames --trajectory vehicle.csv -o calibrated --scans 0:64:2\n"
    "  adasplats simulate model.ply --sensor calibrated/sensor.toml --sensor-offsets \\\n"
    "    --trajectory calibrated/trajectory.csv -o scans\n";

class CalibrateCommand final : public Command {
 public:
  explicit CalibrateCommand(CLI::App& program)
      : Command(program, "calibrate",
                "Estimate errors of poses, lasers and mount from the points of a drive",
                kCalibrateExamples) {
    OptionSet& app = options();
    require(add_paths(
        app, "INPUT", job_.inputs,
        "SemanticKITTI sequence folders, recordings, and with --trajectory folders of scans "
        "with times (" +
            point_format_names() + ")"));
    require(writes_folder(
        add_path(app, "-o,--output", job_.output,
                 "Folder to create: trajectory.csv, poses.txt, lasers.csv, "
                 "sensor.toml, report.html and report.json, as far as they were estimated")));
    app.add_flag("--overwrite", job_.overwrite, "Replace an existing output folder");
    add_settings(app, job_.calibrate);
    add_settings(app, job_.windows);
    add_load_options(app, job_.load);
    add_device_options();
  }

  void run(Session& session) override {
    // OptiX only casts rays; calibration runs on CUDA.
    if (session.device.kind == DeviceKind::optix) session.device.kind = DeviceKind::cuda;
    const CalibrateResult result = run_calibrate(job_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = result.seconds;
    TextTable table({"calibration", job_.output.string()});
    table.add_row({"sensor", result.sensor.empty() ? "not recognised" : result.sensor});
    table.add_row({"scans", grouped(result.given.size())});
    table.add_row({"planes", grouped(result.report.planes)});
    table.add_row({"weakest direction", fixed(100 * result.report.weakest_share, 2) + " %"});
    if (result.report.mount) add_mount(*result.report.mount, table);
    if (result.report.windows)
      table.add_row({"windows", grouped(result.report.windows->windows.size())});
    for (const std::string& file : result.files) table.add_row({"written", file});
    table.add_row({"seconds", fixed(result.seconds, 1)});
    print(table.text() + "\n" + calibration_text(result.report, result.calibration));
  }

 private:
  static void add_mount(const MountReport& report, TextTable& table) {
    table.add_row({"mount", report.objection.empty() ? "corrected" : "as given"});
    if (const std::string names = not_observed_text(report.found); !names.empty())
      table.add_row({"not observed", names});
  }

  CalibrateJob job_;
};

}  // namespace

std::unique_ptr<Command> make_calibrate_command(CLI::App& program) {
  return std::make_unique<CalibrateCommand>(program);
}

}  // namespace adasplats::app
