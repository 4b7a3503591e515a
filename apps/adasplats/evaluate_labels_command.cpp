// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "adasplats/cloud/kitti_sequence.h"
#include "adasplats/evaluate/label_agreement.h"
#include "commands.h"
#include "inputs.h"
#include "option_types.h"
#include "stopwatch.h"
#include "terminal.h"
#include "text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kExamples =
    "  adasplats evaluate labels simkitti32/sequences/08 dataset/sequences/08\n"
    "  adasplats evaluate labels simkitti32/sequences/08 dataset/sequences/08 --every 50\n";

constexpr std::size_t kConfusionsShown = 8;

nlohmann::ordered_json to_json(const LabelAgreement& agreement) {
  nlohmann::ordered_json json = {{"points", agreement.points}, {"agree", agreement.agree}};
  if (agreement.points > 0) {
    json["share"] = agreement.share();
    json["distance_m"] = agreement.distance_m;
  }
  return json;
}

class EvaluateLabelsCommand final : public Command {
 public:
  explicit EvaluateLabelsCommand(CLI::App& evaluate)
      : Command(evaluate, "labels",
                "How many simulated points have the class of the nearest measured one", kExamples) {
    CLI::App& app = options();
    require(add_path(app, "SIMULATED", simulated_, "Sequence folder with labels"));
    require(add_path(app, "ORIGINAL", original_, "The sequence that it was made from"));
    app.add_option("--window", options_.window,
                   "Original scans before and after the one of the same time to look at")
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--every", options_.every, "Take every n-th simulated scan")
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--labels", labels_, "What labels mean: semantickitti or a TOML file")
        ->capture_default_str()
        ->type_name("SCHEME");
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const LabelScheme labels = load_label_scheme(labels_);
    const LabelAgreementResult result =
        compare_labels(open_kitti_sequence(resolve_cloud_input(simulated_)),
                       open_kitti_sequence(resolve_cloud_input(original_)), labels, options_,
                       session.executor, session.progress);
    session.report["all"] = to_json(result.all);
    session.report["labelled"] = to_json(result.labelled);
    session.report["by_class"] = nlohmann::ordered_json::object();
    for (const auto& [id, agreement] : result.by_class)
      session.report["by_class"][std::to_string(id)] = to_json(agreement);
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

  std::filesystem::path simulated_;
  std::filesystem::path original_;
  std::string labels_ = "semantickitti";
  LabelAgreementOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_labels_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateLabelsCommand>(evaluate);
}

}  // namespace adasplats::app
