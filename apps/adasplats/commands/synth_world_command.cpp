// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/scans/synth.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kWorldExamples =
    "  adasplats synth world -o world --kind suburban --seed 7\n"
    "  adasplats synth world -o world --kind city --scans 40 --spacing 0.5\n";

class SynthWorldCommand final : public Command {
 public:
  explicit SynthWorldCommand(CLI::App& synth)
      : Command(synth, "world", "Make a place and labelled scans of it, another with every seed",
                kWorldExamples) {
    OptionSet& app = options();
    require(writes_folder(add_path(app, "-o,--output", job_.output, "Folder to create")));
    app.add_flag("--overwrite", job_.overwrite, "Replace an earlier output folder");
    add_settings(app, job_.world);
    add_settings(app, job_.scan);
    app.add_option("--sensor", job_.scan.sensor, "A sensor of 'adasplats sensors', or a file")
        ->capture_default_str();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const WorldReport report = run_synth_world(job_, session);
    session.report.update(to_json(report));
    session.report["seconds"]["total"] = watch.seconds();
    TextTable table({"world", job_.output.string()});
    table.add_row({"triangles", grouped(report.mesh_triangles)});
    table.add_row({"moving objects", grouped(report.moving_objects)});
    table.add_row({"scans", grouped(report.scans)});
    table.add_row({"points", grouped(report.points)});
    table.add_row({"seconds", fixed(watch.seconds(), 1)});
    print(table.text());
  }

 private:
  WorldJob job_;
};

}  // namespace

std::unique_ptr<Command> make_synth_world_command(CLI::App& synth) {
  return std::make_unique<SynthWorldCommand>(synth);
}

}  // namespace adasplats::app
