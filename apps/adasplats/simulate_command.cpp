// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/lidar_model.h"
#include "commands.h"
#include "option_types.h"
#include "simulate_job.h"
#include "terminal.h"
#include "text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kExamples =
    "  adasplats simulate street.ply --trajectory street/sequences/00 -o scans\n"
    "  adasplats simulate street.ply --sensor hdl-32-paper --trajectory poses.csv \\\n"
    "      --offset 1,1,-0.5 -o scans --format npy\n"
    "  adasplats simulate street.ply --trajectory poses.csv -o scans --device cuda --gpus 0,1\n"
    "Rates: traced, in the tracer or in the kernels of all GPUs; returned, until the hits were in\n"
    "host memory; assembled, until they were points with noise, classes and times; written, until\n"
    "the scans were on disk. Each one holds those before it.\n";

std::string known_sensors() {
  std::string names;
  for (const std::string& name : lidar_model_names()) names += name + ", ";
  return names;
}

class SimulateCommand final : public Command {
 public:
  explicit SimulateCommand(CLI::App& program)
      : Command(program, "simulate", "Drive a LiDAR through a splat model or a mesh", kExamples) {
    CLI::App& app = options();
    require(add_path(app, "MODEL", job_.model, "Splat model or triangle mesh (PLY, OBJ)"));
    require(add_path(app, "-o,--output", job_.output, "Folder to create"));
    require(add_path(app, "--trajectory", job_.trajectory,
                     "Poses of the sensor: KITTI poses.txt, CSV, or a sequence folder"));
    app.add_option("--sensor", job_.sensor, "One of " + known_sensors() + "a TOML or a CSV file")
        ->capture_default_str()
        ->type_name("NAME|FILE");
    add_vector(app, "--offset", offset_, "Shift of the trajectory in world axes, m")
        ->default_str("0,0,0");
    app.add_option(
           "--labels", job_.labels,
           "What classes mean: semantickitti, paris-carla-3d or a TOML file; the default is "
           "what the model says")
        ->type_name("SCHEME");
    app.add_option("--every", job_.every, "Take every n-th pose")
        ->capture_default_str()
        ->type_name("N");
    add_switch(app, "--range-noise,!--no-range-noise", job_.range_noise,
               "Noise of the sensor on ranges");
    add_choice<ScanFormat>(app, "--format", job_.format,
                           {{"semantickitti", ScanFormat::semantickitti},
                            {"ply", ScanFormat::ply},
                            {"npy", ScanFormat::npy}},
                           "Of the scans; semantickitti writes OUTPUT/sequences/00");
    app.add_flag("--overwrite", job_.overwrite, "Replace an earlier output folder");
    add_device_options(GpuCount::several);
  }

  void run(Session& session) override {
    job_.offset_m = offset_.value_or(Vec3d{});
    const SimulateResult result = run_simulate(job_, session);
    const nlohmann::ordered_json json = to_json(result);
    session.report.update(json);
    TextTable table({"scans/s", job_.output.string()});
    for (const auto& [name, value] : json["scans_per_second"].items()) {
      table.add_row({name, fixed(value.get<double>(), 1)});
    }
    print(table.text() + "\n" + grouped(result.scans) + " scans, " + grouped(result.rays) +
          " rays, " + grouped(result.hits) + " returns in " + fixed(result.seconds, 2) + " s\n");
  }

 private:
  SimulateJob job_;
  std::optional<Vec3d> offset_;
};

}  // namespace

std::unique_ptr<Command> make_simulate_command(CLI::App& program) {
  return std::make_unique<SimulateCommand>(program);
}

}  // namespace adasplats::app
