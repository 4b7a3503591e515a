// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/options/build_options.h"
#include "cli/options/load_options.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "commands/mesh_job.h"

namespace adasplats::app {
namespace {

constexpr const char* kMeshExamples =
    "  adasplats mesh street/mapping.ply -o imls.ply --method imls --labels semantickitti\n"
    "  adasplats mesh sequences/00 -o poisson.ply --method poisson --depth 11\n"
    "  adasplats render imls.ply street.ply -o both.png\n";

void add_imls_options(OptionSet& app, ImlsOptions& options) {
  constexpr const char* kGroup = "IMLS";
  app.add_option("--voxel", options.voxel_m, "Side of a voxel, m")
      ->capture_default_str()
      ->group(kGroup);
  app.add_option("--sigma", options.sigma_voxels, "Of the Gaussian weight, voxels")
      ->capture_default_str()
      ->group(kGroup);
  app.add_option("--truncation", options.truncation_voxels,
                 "Values only in voxels this near to a point, voxels")
      ->capture_default_str()
      ->group(kGroup);
}

void add_poisson_options(OptionSet& app, PoissonOptions& options) {
  constexpr const char* kGroup = "Screened Poisson";
  app.add_option("--depth", options.depth, "Depth of the octree, at most")
      ->capture_default_str()
      ->group(kGroup);
  app.add_option("--samples-per-node", options.samples_per_node,
                 "Least number of points in a node (PoissonRecon only)")
      ->capture_default_str()
      ->group(kGroup);
  app.add_option("--trim", options.trim,
                 "Cut away what was measured at a lesser depth; the default is the depth less 3")
      ->group(kGroup);
  add_choice<PoissonProvider>(app, "--poisson-program", options.provider,
                              {{"auto", PoissonProvider::automatic},
                               {"poissonrecon", PoissonProvider::poisson_recon},
                               {"open3d", PoissonProvider::open3d}},
                              "What reconstructs: PoissonRecon and SurfaceTrimmer on PATH, else "
                              "Open3D (adasplats-poisson)")
      ->group(kGroup);
}

class MeshCommand final : public Command {
 public:
  explicit MeshCommand(CLI::App& program)
      : Command(program, "mesh", "Turn point clouds into a triangle mesh, to compare with",
                kMeshExamples) {
    OptionSet& app = options();
    require(app.add_option_function<std::vector<std::string>>(
                   "INPUT",
                   [this](const std::vector<std::string>& names) {
                     job_.inputs.assign(names.begin(), names.end());
                   },
                   "Point files (PLY, PCD, LAS, LAZ, text, KITTI bin) and SemanticKITTI sequence "
                   "folders")
                ->type_name("PATH"));
    require(writes(add_path(app, "-o,--output", job_.output, "Mesh to write, PLY"), {".ply"}));
    add_choice<MeshMethod>(app, "--method", job_.method,
                           {{"imls", MeshMethod::imls}, {"poisson", MeshMethod::poisson}},
                           "Implicit moving least squares or screened Poisson");
    app.add_option("--labels", job_.labels,
                   "What labels mean: semantickitti, paris-carla-3d or a TOML file; the default is "
                   "semantickitti for sequence folders, else none")
        ->type_name("SCHEME");
    add_removal_option(app, job_.remove);
    app.add_option("--neighbors", job_.normals.neighbors, "K, points of a normal")
        ->capture_default_str();
    add_imls_options(app, job_.imls);
    add_poisson_options(app, job_.poisson);
    add_load_options(app, job_.load);
  }

  void run(Session& session) override {
    if (job_.method == MeshMethod::imls) {
      refuse({"--depth", "--samples-per-node", "--trim", "--poisson-program"},
             "with --method imls; it is for --method poisson");
    } else {
      refuse({"--voxel", "--sigma", "--truncation"},
             "with --method poisson; it is for --method imls");
    }
    job_.removal_is_asked = is_given("--remove");
    job_.samples_per_node_is_asked = is_given("--samples-per-node");
    const MeshResult result = run_mesh(job_, session);
    session.report.update(to_json(result));
    TextTable table({"step", "seconds"});
    for (const StepTime& step : result.steps) table.add_row({step.name, fixed(step.seconds, 2)});
    table.add_row({"total", fixed(result.seconds, 2)});
    const std::string by = result.program.empty() ? "" : ", by " + result.program;
    print(table.text() + "\n" + job_.output.string() + ": " + grouped(result.primitives) +
          " triangles from " + grouped(result.points_in) + " points (" +
          grouped(result.points_dynamic) + " dynamic removed" + text_of(result.removed_classes) +
          ")" + by + "\n");
  }

 private:
  MeshJob job_;
};

}  // namespace

std::unique_ptr<Command> make_mesh_command(CLI::App& program) {
  return std::make_unique<MeshCommand>(program);
}

}  // namespace adasplats::app
