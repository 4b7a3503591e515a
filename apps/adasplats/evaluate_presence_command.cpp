// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load_cloud.h"
#include "adasplats/evaluate/presence.h"
#include "commands.h"
#include "inputs.h"
#include "load_options.h"
#include "model_scene.h"
#include "option_types.h"
#include "stopwatch.h"
#include "terminal.h"
#include "text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kExamples =
    "  adasplats evaluate presence model.ply sequences/00\n"
    "  adasplats evaluate presence model.ply street/mapping.ply --labels semantickitti\n";

nlohmann::ordered_json to_json(const Presence& presence) {
  return {{"points", presence.points}, {"present", presence.present}};
}

class EvaluatePresenceCommand final : public Command {
 public:
  explicit EvaluatePresenceCommand(CLI::App& evaluate)
      : Command(evaluate, "presence", "Which measured points a model has a surface at", kExamples) {
    CLI::App& app = options();
    require(add_path(app, "MODEL", model_, "Splat model or triangle mesh"));
    require(add_path(app, "POINTS", points_, "Point file with sensor positions, or a sequence"));
    app.add_option("--labels", labels_,
                   "What labels mean: semantickitti, paris-carla-3d or a TOML file; the default is "
                   "semantickitti for sequence folders, else none")
        ->type_name("SCHEME");
    app.add_option("--within", options_.within_m, "Of a point, along the ray that measured it, m")
        ->capture_default_str();
    app.add_option("--min-range", options_.min_range_m, "Nearer points are left out, m")
        ->capture_default_str();
    app.add_option("--max-range", options_.max_range_m, "Farther points are left out, m")
        ->capture_default_str();
    add_load_options(app, load_);
    add_device_options();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    require_input(model_);
    const auto inputs = std::span(&points_, 1);
    const auto scheme = label_scheme_for(labels_, inputs);
    const PointCloud cloud = load_cloud(inputs, load_, session.executor, session.progress).first;
    const ModelScene scene(model_, "", session);
    session.progress.begin_step("cast", 0);
    const PresenceResult result = presence(scene.tracer(), scene.origin(), cloud,
                                           scheme ? &*scheme : nullptr, options_, session.executor);
    session.progress.end_step();
    session.report["all"] = to_json(result.all);
    session.report["moving"] = to_json(result.moving);
    session.report["still"] = to_json(result.still);
    session.report["by_class"] = nlohmann::ordered_json::object();
    for (const auto& [name, part] : result.by_class)
      session.report["by_class"][name] = to_json(part);
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

  std::filesystem::path model_;
  std::filesystem::path points_;
  std::string labels_;
  PresenceOptions options_;
  LoadOptions load_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_presence_command(CLI::App& evaluate) {
  return std::make_unique<EvaluatePresenceCommand>(evaluate);
}

}  // namespace adasplats::app
