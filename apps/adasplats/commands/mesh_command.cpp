// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/io/bags/recording.h"
#include "adasplats/io/point_format.h"
#include "adasplats/jobs/model/make_mesh.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kMeshExamples =
    "  adasplats mesh street/mapping.ply -o imls.ply --method imls --labels semantickitti\n"
    "  adasplats mesh sequences/00 -o poisson.ply --method poisson --depth 11\n"
    "  adasplats render imls.ply street.ply -o both.png\n";

class MeshCommand final : public Command {
 public:
  explicit MeshCommand(CLI::App& program)
      : Command(program, "mesh", "Turn point clouds into a triangle mesh, for comparison",
                kMeshExamples) {
    OptionSet& app = options();
    require(add_paths(app, "INPUT", job_.inputs,
                      "Point files (" + point_format_names() +
                          "), SemanticKITTI sequence folders and recordings (" +
                          recording_format_names() + ", PCAP)"));
    require(writes(add_path(app, "-o,--output", output_, "Mesh to write, PLY"), {".ply"}));
    add_labels_option(app, job_.labels, "semantickitti for sequence folders, else none");
    add_removal_option(app, job_.remove);
    add_settings(app, job_);
    add_load_options(app, job_.load);
  }

  void run(Session& session) override {
    for (const UnusedSetting& unused : unused_settings(job_)) {
      reject({option_of(unused.setting).c_str()}, unused.why);
    }
    job_.removal_is_asked = is_given("--remove");
    const MeshResult result = run_mesh(job_, output_, session);
    session.report.update(to_json(result));
    TextTable table({"step", "seconds"});
    for (const StepTime& step : result.steps) table.add_row({step.name, fixed(step.seconds, 2)});
    table.add_row({"total", fixed(result.seconds, 2)});
    const std::string by = result.program.empty() ? "" : ", by " + result.program;
    print(table.text() + "\n" + output_.string() + ": " + grouped(result.primitives) +
          " triangles from " + grouped(result.points_in) + " points (" +
          grouped(result.points_dynamic) + " removed by class" + text_of(result.removed_classes) +
          ")" + by + "\n");
  }

 private:
  MeshJob job_;
  std::filesystem::path output_;
};

}  // namespace

std::unique_ptr<Command> make_mesh_command(CLI::App& program) {
  return std::make_unique<MeshCommand>(program);
}

}  // namespace adasplats::app
