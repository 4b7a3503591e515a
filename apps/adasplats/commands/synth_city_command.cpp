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
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kCityExamples =
    "  adasplats synth city -o city --length 500\n"
    "  adasplats synth city -o city --length 10km --points 1e9 --seed 7\n"
    "  adasplats model city/sequences/00 -o city-model --tile 64\n";

class SynthCityCommand final : public Command {
 public:
  explicit SynthCityCommand(CLI::App& synth)
      : Command(synth, "city", "Drive through a city of any length and scan it, piece by piece",
                kCityExamples) {
    OptionSet& app = options();
    require(writes_folder(add_path(app, "-o,--output", job_.output, "Folder to create")));
    app.add_flag("--overwrite", job_.overwrite, "Replace an earlier output folder");
    visit_settings(job_.city, [&](const Setting& setting, auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
        add_length(app, setting, value);
      else
        OptionsOfSettings{app}(setting, value);
    });
    app.add_option("--sensor", job_.city.sensor, "A sensor of 'adasplats sensors', or a file")
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
    table.add_row({"pieces", grouped(report.pieces)});
    table.add_row({"most pieces in memory", grouped(report.max_pieces)});
    table.add_row({"triangles", grouped(report.mesh_triangles)});
    table.add_row({"points a second", grouped(static_cast<std::size_t>(points_per_s))});
    table.add_row({"seconds", fixed(seconds, 1)});
    print(table.text());
  }

 private:
  SynthCityJob job_;
};

}  // namespace

std::unique_ptr<Command> make_synth_city_command(CLI::App& synth) {
  return std::make_unique<SynthCityCommand>(synth);
}

}  // namespace adasplats::app
