// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/evaluate/evaluate_presence.h"
#include "adasplats/jobs/provenance/metrics_json.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kEvaluatePresenceExamples =
    "  adasplats evaluate presence model.ply sequences/00\n"
    "  adasplats evaluate presence model.ply street/mapping.ply --labels semantickitti\n";

class EvaluatePresenceCommand final : public Command {
 public:
  explicit EvaluatePresenceCommand(CLI::App& evaluate)
      : Command(evaluate, "presence", "Which measured points a model has a surface at",
                kEvaluatePresenceExamples) {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.model, "Splat model or triangle mesh"));
    require(
        add_path(app, "POINTS", job_.points, "Point file with sensor positions, or a sequence"));
    app.add_option(
           "--labels", job_.labels,
           "What labels mean: semantickitti, paris-carla-3d, pandaset, nuscenes, asprs or a TOML "
           "file; the default is "
           "semantickitti for sequence folders, else none")
        ->type_name("SCHEME");
    app.add_option("--within", job_.options.within_m,
                   "Of a point, along the ray that measured it, m")
        ->capture_default_str();
    app.add_option("--min-range", job_.options.min_range_m, "Nearer points are left out, m")
        ->capture_default_str();
    app.add_option("--max-range", job_.options.max_range_m, "Farther points are left out, m")
        ->capture_default_str();
    add_load_options(app, job_.load);
    add_device_options();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const PresenceResult result = evaluate_presence(job_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    print(table_of(result));
  }

 private:
  static std::string table_of(const PresenceResult& result) {
    TextTable table({"points", "count", "in the model"});
    const auto add = [&table](const std::string& name, const Presence& part) {
      if (part.points > 0) table.add_row({name, grouped(part.points), percent(part.share())});
    };
    add("all", result.all);
    add("still", result.still);
    add("moving", result.moving);
    if (!result.by_class.empty()) table.add_row({});
    for (const auto& [name, part] : result.by_class) add(name, part);
    return table.text();
  }

  PresenceJob job_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_presence_command(CLI::App& evaluate) {
  return std::make_unique<EvaluatePresenceCommand>(evaluate);
}

}  // namespace adasplats::app
