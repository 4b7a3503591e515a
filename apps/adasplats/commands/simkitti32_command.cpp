// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/error.h"
#include "adasplats/jobs/scans/simkitti32.h"
#include "adasplats/jobs/session/inputs.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kSimkitti32Examples =
    "  adasplats simkitti32 dataset/sequences/08 -o simkitti32\n"
    "  adasplats simkitti32 sequences/00 -o vlp16 --sensor velodyne-vlp-16 --offset 0,0,0\n"
    "  adasplats simkitti32 sequences/08 -o part --scans 0:500 --model-every 2\n"
    "  adasplats simkitti32 sequences/08 -o made --model model.ply  # model ... --remove moving\n"
    "The same command resumes an interrupted run (Ctrl-C, kill -9), with the same bytes as "
    "result.\n"
    "adasplats.json in the output describes the data set and how it was made.\n";

class SimKitti32Command final : public Command {
 public:
  explicit SimKitti32Command(CLI::App& program)
      : Command(program, "simkitti32", "Turn a SemanticKITTI sequence into that of another LiDAR",
                kSimkitti32Examples) {
    OptionSet& app = options();
    require(add_path(app, "SEQUENCE", job_.sequence, "SemanticKITTI sequence folder with labels"));
    require(writes_folder(add_path(app, "-o,--output", job_.output, "Folder to create")));
    add_sensor_option(app, job_.sensor)->basic();
    add_scan_range(app, "--scans", job_.scans, "Scans to model and simulate")->basic();
    app.add_option("--labels", job_.labels, "Label scheme: semantickitti or a TOML file")
        ->capture_default_str()
        ->type_name("SCHEME");
    add_settings(app, job_);
    add_path(app, "--model", job_.model,
             "Use this model with its classes, or a world file with its objects, instead of making "
             "one from the scans; if it is calibrated, scans are simulated at its corrected poses")
        ->group("Static model")
        ->basic();
    add_path(app, "--ray-drop", job_.ray_drop,
             "Model of lost beams: a file of 'adasplats fit-drop', or 'none'");
    app.add_flag("--overwrite", job_.overwrite, "Replace an existing output folder");
    add_device_options(GpuCount::several);
  }

  void run(Session& session) override {
    for (const UnusedSetting& unused : unused_settings(job_)) {
      reject({option_of(unused.setting).c_str()}, unused.why);
    }
    if (is_given("--fog") && !(job_.weather.fog_visibility_m > 0))
      throw Error(ErrorKind::usage, "--fog must be greater than 0");
    const LabelScheme labels = load_label_scheme(job_.labels);
    const SimKitti32Result result = run_simkitti32(job_, session);
    session.report.update(to_json(result, labels));
    print(table_of(result, labels) + "\n" + job_.output.string() + ": " + grouped(result.scans) +
          " scans (" + grouped(result.scans_resumed) + " from an interrupted run), " +
          grouped(result.points) + " points of " + grouped(result.rays) + " rays, in " +
          fixed(result.seconds, 1) + " s\n");
  }

 private:
  static std::string table_of(const SimKitti32Result& result, const LabelScheme& labels) {
    double original = 0;
    double simulated = 0;
    for (const auto& [id, count] : result.by_class) {
      original += static_cast<double>(count.original);
      simulated += static_cast<double>(count.simulated);
    }
    TextTable table({"class", "original", "", "simulated", ""});
    for (const auto& [id, count] : result.by_class) {
      const SemanticClass* const known = labels.find(id);
      table.add_row(
          {std::to_string(id) + (known != nullptr ? " " + known->name : ""),
           grouped(count.original), percent(static_cast<double>(count.original) / original),
           grouped(count.simulated), percent(static_cast<double>(count.simulated) / simulated)});
    }
    return table.text();
  }

  SimKitti32Job job_;
};

}  // namespace

std::unique_ptr<Command> make_simkitti32_command(CLI::App& program) {
  return std::make_unique<SimKitti32Command>(program);
}

}  // namespace adasplats::app
