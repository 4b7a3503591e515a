// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/io/point_format.h"
#include "adasplats/jobs/segment/segment.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kSegmentExamples =
    "  adasplats segment sequences/00 -o labelled\n"
    "  adasplats segment cloud.las -o labelled.las --network my.network --class-map my.txt\n"
    "  adasplats segment 000000.bin -o 000000.label\n";

class SegmentCommand final : public Command {
 public:
  explicit SegmentCommand(CLI::App& program)
      : Command(program, "segment", "Classify points with a neural network", kSegmentExamples) {
    OptionSet& app = options();
    require(add_paths(app, "INPUT", job_.inputs,
                      "Sequence folders, or point files (" + point_format_names() + ")"));
    require(add_path(
        app, "-o,--output", job_.output,
        "Folder to create for sequences; file to write for point files: PLY, LAS or LAZ, or "
        ".label for one .bin"));
    app.add_flag("--overwrite", job_.overwrite, "Replace an existing output folder");
    add_path(app, "--network", job_.network, "Network file (default: the included network)");
    add_path(app, "--class-map", job_.class_map,
             "File that maps the network's classes to your own numbers and names");
    app.add_flag("--confidences", job_.segment.confidences,
                 "Also write the probability of each point's label");
    app.add_flag("--probabilities", job_.segment.probabilities,
                 "Also write the probability of every class for each point");
    add_settings(app, job_.segment);
    add_settings(app, job_.window);
    add_load_options(app, job_.load);
    add_device_options();
  }

  void run(Session& session) override {
    // OptiX only casts rays; networks run on CUDA.
    if (session.device.kind == DeviceKind::optix) session.device.kind = DeviceKind::cuda;
    const SegmentResult result = run_segment(job_, session);
    session.report.update(to_json(result));
    TextTable table({"class", "points"});
    for (const SegmentResult::ClassCount& count : result.classes)
      if (count.points > 0) table.add_row({count.name, grouped(count.points)});
    print(table.text() + "\n" + job_.output.string() + ": " + grouped(result.points) +
          " points in " + grouped(result.cells) + " cells of " + grouped(result.tiles) +
          " tiles, " + fixed(result.segment_seconds, 1) + " s\n");
  }

 private:
  SegmentJob job_;
};

}  // namespace

std::unique_ptr<Command> make_segment_command(CLI::App& program) {
  return std::make_unique<SegmentCommand>(program);
}

}  // namespace adasplats::app
