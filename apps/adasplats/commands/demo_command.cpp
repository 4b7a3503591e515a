// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/demo.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kDemoExamples =
    "  adasplats demo\n"
    "  adasplats demo -o /tmp/demo --points 1000000 --report /tmp/demo.json\n";

std::string table_of(const DemoResult& result) {
  TextTable table(
      {"method", "splats", "seconds", "C2C", "thin C2C", "within 10 cm", "early", "scans/s"});
  for (const DemoRow& row : result.rows) {
    table.add_row(
        {row.method, grouped(row.model.built.primitives), fixed(row.model.seconds, 2),
         centimetres(row.comparison.distance.c2c_m), centimetres(row.thin_c2c_m),
         percent(row.held_out.all.within.at(0.10)), percent(row.held_out.all.early_50cm),
         fixed(to_json(row.simulation)["scans_per_second"]["assembled"].get<double>(), 1)});
  }
  return table.text();
}

class DemoCommand final : public Command {
 public:
  explicit DemoCommand(CLI::App& program)
      : Command(program, "demo", "Run all steps on a synthetic street and write a report",
                kDemoExamples) {
    OptionSet& app = options();
    writes_folder(add_path(app, "-o,--output", job_.output, "Folder to create"));
    app.add_flag("--overwrite", job_.overwrite, "Replace an earlier output folder");
    app.add_option("--points", job_.points, "Approximate number of points in the mapping cloud")
        ->capture_default_str();
    app.add_option("--driving-spacing", job_.driving_spacing_m,
                   "Distance between held-out scans, m")
        ->capture_default_str();
    add_device_options();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const DemoResult result = run_demo(job_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    std::string text =
        "A street of " + fixed(result.street.length_m, 0) + " m, " +
        grouped(result.street.mapping_points) + " points, " + grouped(result.street.driving_scans) +
        " held-out scans; " + fixed(watch.seconds(), 1) + " s in all.\n\n" + table_of(result) +
        "\nC2C is simulated to original; within 10 cm and early (by more than "
        "50 cm) are shares of the held-out beams.\n\n  " +
        (job_.output / result.picture).string() +
        "  all methods, with the errors of held-out beams\n  " +
        (job_.output / result.page).string() +
        "  the results with all pictures\n\nView the scene:\n  " + view_command(job_.output) + "\n";
    print(text);
  }

 private:
  DemoJob job_;
};

}  // namespace

std::unique_ptr<Command> make_demo_command(CLI::App& program) {
  return std::make_unique<DemoCommand>(program);
}

}  // namespace adasplats::app
