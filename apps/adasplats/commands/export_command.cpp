// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/jobs/export.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kExportExamples =
    "  adasplats export street.ply -o gaussians.ply --format gaussian-3d\n"
    "  adasplats export street.ply -o centers.glb --color intensity\n"
    "  adasplats export city -o tiles --format 3d-tiles\n"
    "  adasplats export sequences/08 -o drive.mcap --scans 0:100\n"
    "  adasplats export drive.bag -o tree --format semantickitti\n"
    "  adasplats export scans -o drive.mcap\n"
    "  adasplats export cloud.las -o cloud.glb --color height\n"
    "  adasplats export cloud.ply -o cloud.laz\n";

constexpr double kBytesPerMegabyte = 1e6;

class ExportCommand final : public Command {
 public:
  explicit ExportCommand(CLI::App& program)
      : Command(program, "export", "Export models, points and scans to formats of other tools",
                kExportExamples) {
    OptionSet& app = options();
    require(add_path(
        app, "INPUT", job_.input,
        "Splat model, city, point file, sequence folder, recording or output of 'simulate'"));
    require(add_path(app, "-o,--output", job_.output,
                     "File to write; folder to create for 3d-tiles and the layouts of data sets"));
    add_choice<std::optional<ExportFormat>>(app, "--format", job_.format,
                                            choices_of_optional(kExportFormats),
                                            "File format (default: by the file name)");
    add_labels_option(app, job_.labels, "that of the model");
    add_choice<std::optional<ExportColor>>(
        app, "--color", job_.color, choices_of_optional(kExportColors),
        "Meaning of the colours (default: rgb, else the first available of these)");
    add_load_options(app, job_.load);
  }

  void run(Session& session) override {
    job_.cloud_option = given_load_setting(options());
    const ExportResult result = run_export(job_, session);
    session.report[result.unit] = result.count;
    session.report["points_dropped"] = result.dropped;
    session.report["bytes"] = result.written_bytes;
    if (!result.place.empty()) session.report["place"] = result.place;
    const double megabytes = static_cast<double>(result.written_bytes) / kBytesPerMegabyte;
    std::string text = job_.output.string() + ": " + grouped(result.count) + " " + result.unit +
                       ", " + fixed(megabytes, 1) + " MB";
    if (result.dropped > 0) {
      text += ", " + grouped(result.dropped) + " points dropped as not finite or too far";
    }
    if (!result.place.empty()) text += "; " + result.place;
    print(text + "\n");
  }

 private:
  ExportJob job_;
};

}  // namespace

std::unique_ptr<Command> make_export_command(CLI::App& program) {
  return std::make_unique<ExportCommand>(program);
}

}  // namespace adasplats::app
