// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/evaluate/evaluate_labels.h"
#include "adasplats/jobs/provenance/metrics_json.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kEvaluateLabelsExamples =
    "  adasplats evaluate labels simkitti32/sequences/08 dataset/sequences/08\n"
    "  adasplats evaluate labels simkitti32/sequences/08 dataset/sequences/08 --every 50\n";

constexpr std::size_t kConfusionsShown = 8;

class EvaluateLabelsCommand final : public Command {
 public:
  explicit EvaluateLabelsCommand(CLI::App& evaluate)
      : Command(evaluate, "labels",
                "How many simulated points have the class of the nearest measured one",
                kEvaluateLabelsExamples) {
    OptionSet& app = options();
    require(add_path(app, "SIMULATED", job_.simulated, "Sequence folder with labels"));
    require(add_path(app, "ORIGINAL", job_.original, "The sequence that it was made from"));
    app.add_option("--window", job_.options.window,
                   "Original scans before and after the one of the same time to look at")
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--every", job_.options.every, "Take every n-th simulated scan")
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--labels", job_.labels, "What labels mean: semantickitti or a TOML file")
        ->capture_default_str()
        ->type_name("SCHEME");
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const LabelScheme labels = load_label_scheme(job_.labels);
    const LabelAgreementResult result = evaluate_labels(job_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    print(table_of(result, labels) + "\n" + confusions_of(result, labels));
  }

 private:
  static std::string name_of(std::uint16_t id, const LabelScheme& labels) {
    const SemanticClass* const known = labels.find(id);
    return std::to_string(id) + (known != nullptr ? " " + known->name : "");
  }

  static std::string table_of(const LabelAgreementResult& result, const LabelScheme& labels) {
    TextTable table({"simulated class", "points", "agree", "nearest original"});
    const auto add = [&table](const std::string& name, const LabelAgreement& part) {
      table.add_row(
          {name, grouped(part.points), percent(part.share()), centimetres(part.distance_m)});
    };
    for (const auto& [id, part] : result.by_class) add(name_of(id, labels), part);
    add("both labelled", result.labelled);
    add("all", result.all);
    return table.text();
  }

  static std::string confusions_of(const LabelAgreementResult& result, const LabelScheme& labels) {
    std::vector<std::pair<std::size_t, std::pair<std::uint16_t, std::uint16_t>>> largest;
    for (const auto& [classes, points] : result.confusions) largest.push_back({points, classes});
    std::ranges::sort(largest, std::greater<>());
    largest.resize(std::min(largest.size(), kConfusionsShown));
    TextTable table({"simulated, but nearest original", "points", "of all"});
    for (const auto& [points, classes] : largest) {
      table.add_row(
          {name_of(classes.first, labels) + ", " + name_of(classes.second, labels), grouped(points),
           percent(static_cast<double>(points) / static_cast<double>(result.all.points))});
    }
    return table.text();
  }

  LabelAgreementJob job_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_labels_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateLabelsCommand>(evaluate);
}

}  // namespace adasplats::app
