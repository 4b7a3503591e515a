// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/scans/synth.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
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
    app.add_flag("--overwrite", job_.overwrite, "Replace an existing output folder");
    app.add_option("--points", job_.scan.points,
                   "Approximate number of points in the mapping cloud")
        ->capture_default_str();
    app.add_option("--length", job_.street.length_m,
                   "Length of the road, m; 0: chosen to suit --points")
        ->capture_default_str();
    app.add_option("--range-noise", job_.scan.range_noise_m,
                   "Standard deviation of the range noise, m")
        ->capture_default_str();
    app.add_option("--pose-error", job_.scan.pose_error_m,
                   "Standard deviation of the offset of each pass, m")
        ->capture_default_str();
    app.add_option("--rotation-error", job_.scan.pose_error_rad,
                   "Standard deviation of the rotation of each pass, rad")
        ->capture_default_str();
    app.add_option("--passes", job_.scan.passes,
                   "Number of drives along the street, there and back")
        ->capture_default_str();
    app.add_flag("--turns", job_.scan.turns,
                 "Begin and end each pass with a turn from and into a crossing street");
    app.add_option("--speed", job_.scan.speed_m_per_s, "Speed of the vehicle, m/s")
        ->capture_default_str();
    app.add_option("--driving-spacing", job_.scan.driving_spacing_m,
                   "Distance between scans of the driving sequence, m; 0: no sequence")
        ->capture_default_str();
    app.add_option("--max-driving-scans", job_.scan.max_driving_scans,
                   "Maximum number of scans of the driving sequence")
        ->capture_default_str();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    if (job_.scan.driving_spacing_m == 0) {
      reject({"--max-driving-scans"}, "with --driving-spacing 0, which makes no sequence");
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

constexpr const char* kWorldExamples =
    "  adasplats synth world -o world --kind suburban --seed 7\n"
    "  adasplats synth world -o world --kind city --scans 40 --spacing 0.5\n";

class SynthWorldCommand final : public Command {
 public:
  explicit SynthWorldCommand(CLI::App& synth)
      : Command(synth, "world",
                "Make a scene and labelled scans of it, a different one for every seed",
                kWorldExamples) {
    OptionSet& app = options();
    require(writes_folder(add_path(app, "-o,--output", job_.output, "Folder to create")));
    app.add_flag("--overwrite", job_.overwrite, "Replace an existing output folder");
    add_settings(app, job_.world);
    add_settings(app, job_.scan);
    add_sensor_option(app, job_.scan.sensor);
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

constexpr const char* kCityExamples =
    "  adasplats synth city -o city --length 500\n"
    "  adasplats synth city -o city --length 10km --points 1e9 --seed 7\n"
    "  adasplats model city/sequences/00 -o city-model --tile 64\n";

class SynthCityCommand final : public Command {
 public:
  explicit SynthCityCommand(CLI::App& synth)
      : Command(synth, "city", "Make a city of any length and labelled scans of a drive through it",
                kCityExamples) {
    OptionSet& app = options();
    require(writes_folder(add_path(app, "-o,--output", job_.output, "Folder to create")));
    app.add_flag("--overwrite", job_.overwrite, "Replace an existing output folder");
    visit_settings(job_.city, [&](const Setting& setting, auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
        add_length(app, setting, value);
      else
        OptionsOfSettings{app}(setting, value);
    });
    app.add_option("--sensor", job_.city.sensor,
                   "Sensor: a name from 'adasplats sensors', or a file")
        ->capture_default_str();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const SynthCityReport report = run_synth_city(job_, session);
    const double seconds = watch.seconds();
    const double points_per_s = static_cast<double>(report.points) / seconds;
    session.report.update(to_json(report));
    session.report["points_per_s"] = points_per_s;
    session.report["seconds"]["total"] = seconds;
    TextTable table({"city", job_.output.string()});
    table.add_row({"metres", grouped(static_cast<std::size_t>(std::lround(job_.city.length_m)))});
    table.add_row({"scans", grouped(report.scans)});
    table.add_row({"points", grouped(report.points)});
    table.add_row({"tiles", grouped(report.pieces)});
    table.add_row({"maximum tiles in memory", grouped(report.max_pieces)});
    table.add_row({"triangles", grouped(report.mesh_triangles)});
    table.add_row({"points per second", grouped(static_cast<std::size_t>(points_per_s))});
    table.add_row({"seconds", fixed(seconds, 1)});
    print(table.text());
  }

 private:
  SynthCityJob job_;
};

}  // namespace

std::unique_ptr<Command> make_synth_street_command(CLI::App& synth) {
  return std::make_unique<SynthStreetCommand>(synth);
}
std::unique_ptr<Command> make_synth_world_command(CLI::App& synth) {
  return std::make_unique<SynthWorldCommand>(synth);
}
std::unique_ptr<Command> make_synth_city_command(CLI::App& synth) {
  return std::make_unique<SynthCityCommand>(synth);
}

}  // namespace adasplats::app
