// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/evaluate/evaluate_segmentation.h"
#include "adasplats/jobs/provenance/metrics_json.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kEvaluateSegmentationExamples =
    "  adasplats evaluate segmentation predicted/sequences/08 dataset/sequences/08\n"
    "  adasplats evaluate segmentation predicted dataset --scans 0:100 --report miou.json\n"
    "  adasplats evaluate segmentation predicted.ply true.las --labels classes.toml\n";

constexpr const char* kSegmentationDefinitions =
    "IoU: points of a class that are predicted, of those that are of it or are predicted to be.\n"
    "Only points that truly are of a class count; one that is predicted to be of none is wrong.\n";

std::string classes_table(const SegmentationResult& result) {
  const SegmentationConfusion& confusion = result.confusion;
  TextTable table({"class", "IoU", "precision", "recall", "share"});
  for (std::size_t c = 0; c < confusion.classes(); ++c) {
    if (confusion.of_truth(c) == 0) continue;
    const bool is_rare = confusion.is_rare(c, result.options.min_share);
    table.add_row({result.classes.classes()[c].name + (is_rare ? " (rare)" : ""),
                   percent(confusion.iou(c)), percent(confusion.precision(c)),
                   percent(confusion.recall(c)), percent(confusion.share(c))});
  }
  table.add_row({});
  table.add_row({"mean, but rare ones", percent(confusion.mean_iou(result.options.min_share))});
  return table.text();
}

std::string groups_table(const SegmentationResult& result) {
  const SegmentationConfusion groups = grouped(result.confusion, result.classes);
  const std::vector<std::string> names = segmentation_groups();
  TextTable table({"group", "IoU", "precision", "recall", "share"});
  for (std::size_t g = 0; g < names.size(); ++g) {
    if (groups.of_truth(g) == 0) continue;
    table.add_row({names[g], percent(groups.iou(g)), percent(groups.precision(g)),
                   percent(groups.recall(g)), percent(groups.share(g))});
  }
  table.add_row({});
  table.add_row({"mean", percent(groups.mean_iou())});
  return table.text();
}

class EvaluateSegmentationCommand final : public Command {
 public:
  explicit EvaluateSegmentationCommand(CLI::App& evaluate)
      : Command(evaluate, "segmentation", "How well predicted classes agree with the true ones",
                kEvaluateSegmentationExamples) {
    OptionSet& app = options();
    require(add_path(app, "PREDICTED", job_.predicted,
                     "Sequence folder or tree (its predictions, else its labels), .label file, or "
                     "points with classes"));
    require(add_path(app, "TRUE", job_.truth, "The true labels of the same points, likewise"));
    app.add_option("--labels", job_.labels,
                   "What labels mean: semantickitti (judged by the 19 classes of its benchmark), "
                   "paris-carla-3d or a TOML file")
        ->capture_default_str()
        ->type_name("SCHEME");
    add_scan_range(app, "--scans", job_.scans, "Which scans of each true sequence");
    app.add_option("--least-share", job_.options.min_share,
                   "Classes with a smaller share of the true points are left out of the mean")
        ->capture_default_str();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const SegmentationResult result = evaluate_segmentation(job_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    const SegmentationConfusion& confusion = result.confusion;
    print(classes_table(result) + "\n" + groups_table(result) + "\naccuracy " +
          percent(confusion.accuracy()) + " of " + grouped(confusion.points()) + " points; " +
          grouped(confusion.ignored()) + " are of no class\n\n" + kSegmentationDefinitions);
  }

 private:
  SegmentationJob job_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_segmentation_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateSegmentationCommand>(evaluate);
}

}  // namespace adasplats::app
