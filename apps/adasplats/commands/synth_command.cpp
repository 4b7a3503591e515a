// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/scans/synth.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kSynthExamples =
    "  adasplats synth street -o street\n"
    "  adasplats synth street -o big --points 12300000 --range-noise 0.02 --seed 7\n";

class SynthStreetCommand final : public Command {
 public:
  explicit SynthStreetCommand(CLI::App& synth)
      : Command(synth, "street", "Make a street with exact geometry, labels and two recordings",
                kSynthExamples) {
    OptionSet& app = options();
    require(writes_folder(add_path(app, "-o,--output", job_.output, "Folder to create")));
    app.add_flag("--overwrite", job_.overwrite, "Replace an earlier output folder");
    app.add_option("--points", job_.scan.points, "About as many points in the mapping cloud")
        ->capture_default_str();
    app.add_option("--length", job_.street.length_m, "Of the road, m; 0: to suit the points")
        ->capture_default_str();
    app.add_option("--range-noise", job_.scan.range_noise_m, "Standard deviation of ranges, m")
        ->capture_default_str();
    app.add_option("--pose-error", job_.scan.pose_error_m,
                   "Standard deviation of each pass's offset, m")
        ->capture_default_str();
    app.add_option("--rotation-error", job_.scan.pose_error_rad,
                   "Standard deviation of each pass's rotation, rad")
        ->capture_default_str();
    app.add_option("--passes", job_.scan.passes, "Drives along the street, there and back")
        ->capture_default_str();
    app.add_flag("--turns", job_.scan.turns,
                 "Each pass turns into the street from the one across its end, and out of it");
    app.add_option("--speed", job_.scan.speed_m_per_s, "Of the vehicle, m/s")
        ->capture_default_str();
    app.add_option("--driving-spacing", job_.scan.driving_spacing_m,
                   "Between the scans of the driving sequence, m; 0: no sequence")
        ->capture_default_str();
    app.add_option("--most-driving-scans", job_.scan.max_driving_scans,
                   "Scans of the driving sequence at most")
        ->capture_default_str();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    if (job_.scan.driving_spacing_m == 0) {
      refuse({"--most-driving-scans"}, "with --driving-spacing 0, where nothing is driven");
    }
    const StreetReport report = run_synth_street(job_, session);
    session.report.update(to_json(report));
    session.report["seconds"]["total"] = watch.seconds();
    TextTable table({"street", job_.output.string()});
    table.add_row({"length", fixed(report.length_m, 1) + " m"});
    table.add_row({"triangles", grouped(report.mesh_triangles)});
    table.add_row({"moving objects", grouped(report.moving_objects)});
    table.add_row({"mapping points", grouped(report.mapping_points)});
    table.add_row({"mapping scans", grouped(report.mapping_scans)});
    table.add_row({"driving scans", grouped(report.driving_scans)});
    table.add_row({"seconds", fixed(watch.seconds(), 1)});
    print(table.text());
  }

 private:
  SynthJob job_;
};

}  // namespace

std::unique_ptr<Command> make_synth_street_command(CLI::App& synth) {
  return std::make_unique<SynthStreetCommand>(synth);
}

}  // namespace adasplats::app
