// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "adasplats/jobs/provenance/provenance.h"
#include "adasplats/jobs/scans/simulate.h"
#include "adasplats/jobs/session/scan_range.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "commands/task_lines.h"

namespace adasplats::app {
namespace {

constexpr const char* kSimulateExamples =
    "  adasplats simulate street.ply --trajectory street/sequences/00 -o scans\n"
    "  adasplats simulate street.ply --sensor hdl-32-paper --trajectory poses.csv \\\n"
    "      --offset 1,1,-0.5 -o scans --format npy\n"
    "  adasplats simulate street.ply --sensor ouster-os1-64 --trajectory poses.csv \\\n"
    "      --rolling-shutter --sub-rays 7 --returns 2 --fog 200 -o scans\n"
    "  adasplats simulate street.ply --rig car.toml --trajectory poses.csv -o scans --format mcap\n"
    "  adasplats simulate street.ply --trajectory poses.csv -o scans --device cuda --gpus 0,1\n"
    "  adasplats simulate street.ply --at 12,3 --at 20,3,,90 -o scans\n"
    "  adasplats simulate street.ply --path '0,0;50,0;50,30' --speed 8 -o scans\n"
    "Rates in the output: traced (the tracer alone, or the kernels of all GPUs), assembled (until\n"
    "scans with all attributes were in host memory), written (until the last file was on disk).\n"
    "Each includes the ones before it. The same command resumes an interrupted run.\n";

class SimulateCommand final : public Command {
 public:
  explicit SimulateCommand(CLI::App& program)
      : Command(program, "simulate", "Simulate a LiDAR that drives through a splat model or a mesh",
                kSimulateExamples) {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.model,
                     "Splat model, city, triangle mesh (PLY, OBJ, glTF) or world file (TOML)"));
    require(writes_folder(add_path(app, "-o,--output", job_.output, "Folder to create")));
    add_sensor_option(app, job_.scan.sensor)->basic();
    add_path(app, "--rig", job_.rig,
             "Instead of --sensor: rig file with the sensors of a car (TOML)")
        ->basic();
    add_labels_option(app, job_.labels, "that of the model");
    add_drive_options(app);
    add_settings(app, job_.scan);
    add_choice<ScanFormat>(app, "--format", job_.format, choices_of<ScanFormat>(kScanFormats),
                           "Format of the scans, or the data set whose folders and files to write")
        ->basic();
    add_choice<PointOrder>(
        app, "--point-order", job_.point_order, choices_of<PointOrder>(kPointOrders),
        "Point order in trees of data sets: that of the data set (KITTI: ring by ring, "
        "counter-clockwise from straight ahead), or the firing order");
    add_memory(app,
               {.name = "tile_memory",
                .help = "Memory limit for tiles of a city along a trajectory, GB or with a unit "
                        "(500M) (default: 1; on a GPU 6)",
                .value = "GB",
                .min = 0,
                .exclusive_min = true},
               job_.tile_memory_gb);
    app.add_flag(
        "--velocities", job_.velocities,
        "Add the velocity of the surface at every point (vx, vy, vz; m/s, relative to the "
        "ground, along the axes of the scan's pose); formats ply, npz, pcd, las, laz, mcap");
    add_choice<CloudDriver>(
        app, "--driver", job_.driver, choices_of<CloudDriver>(kCloudDrivers),
        "Format mcap: write the messages of this ROS 2 driver (topic, frame, fields, order), for "
        "programs that expect a real sensor; 'adasplats' also has classes and instances");
    app.add_flag("--overwrite", job_.overwrite, "Replace an existing output folder");
    constexpr int kMaxScans = 1'000'000'000;
    app.add_option("--plan", scans_a_task_,
                   "Only print commands that simulate N scans each, one per line, to be run by "
                   "many processes "
                   "or machines; the same command without --plan finishes the drive")
        ->range(1, kMaxScans)
        ->type_name("N");
    app.add_option_function<std::string>(
           "--only-scans",
           [this](const std::string& text) { span_ = parse_scan_range("--only-scans", text); },
           "Simulate only these scans of a planned drive")
        ->type_name("FIRST:COUNT");
    add_device_options(GpuCount::several);
  }

  void run(Session& session) override {
    check_options();
    job_.drive.mount = mount_.transform();
    if (span_)
      run_span(session);
    else if (scans_a_task_ > 0)
      run_plan(session);
    else
      run_drive(session);
  }

 private:
  void run_plan(Session& session) {
    const TaskLines lines(own_arguments(), true);
    std::string text;
    session.report["tasks"] = nlohmann::ordered_json::array();
    for (const ScanTask& span :
         plan_simulation(job_, static_cast<std::size_t>(scans_a_task_), session)) {
      const std::string name = std::to_string(span.first) + ":" + std::to_string(span.count);
      text += lines.task("--only-scans", name);
      session.report["tasks"].push_back(name);
    }
    print(text + lines.last());
  }

  void run_span(Session& session) {
    reject({"--plan"}, "with --only-scans");
    if (span_->stride != 1) reject_value("--only-scans", "expected FIRST:COUNT");
    const SpanResult result = simulate_span(job_, {span_->first, span_->count}, session);
    session.report["rays"] = result.rays;
    session.report["hits"] = result.hits;
    session.report["was_done"] = result.was_done;
    print(job_.output.string() + ": " + grouped(span_->count) + " scans from number " +
          std::to_string(span_->first) +
          (result.was_done ? ": already done\n" : ": " + grouped(result.hits) + " returns\n"));
  }

  void run_drive(Session& session) {
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

  void check_options() const {
    if (!job_.scan.noise) reject({"--range-noise"}, "with --no-noise");
    if (!job_.rig.empty())
      reject({"--sensor", "--mount", "--mount-rotation"},
             "with --rig, whose file has the sensors and their mounts");
    if (!job_.drive.rolling_shutter) reject({"--points"}, "without --rolling-shutter");
    if (job_.format != ScanFormat::mcap) reject({"--driver"}, "without --format mcap");
    if (!is_tree(job_.format))
      reject({"--point-order"}, "with formats that are not trees of a data set");
    const auto require_positive = [this](const char* name, double value) {
      if (is_given(name) && !(value > 0)) {
        throw Error(ErrorKind::usage, std::string(name) + " must be greater than 0");
      }
    };
    require_positive("--fog", job_.scan.weather.fog_visibility_m);
  }

  void add_drive_options(OptionSet& app) {
    constexpr const char* kGroup = "Trajectory";
    add_path(app, "--trajectory", job_.drive.trajectory,
             "Poses of sensor or car: KITTI, CSV, TUM, sequence folder or recording")
        ->group(kGroup)
        ->basic();
    add_places(app, "--at", job_.drive.at,
               "Instead of --trajectory: a stationary sensor (without Z: above the ground)")
        ->group(kGroup)
        ->basic();
    add_corners(app, "--path", job_.drive.path,
                "Instead of --trajectory: a polyline above the ground")
        ->group(kGroup);
    add_settings(app, job_.drive);
    add_settings(app, mount_);
  }

  SimulateJob job_;
  MountSettings mount_;
  int scans_a_task_ = 0;
  std::optional<ScanRange> span_;
};

}  // namespace

std::unique_ptr<Command> make_simulate_command(CLI::App& program) {
  return std::make_unique<SimulateCommand>(program);
}

}  // namespace adasplats::app
