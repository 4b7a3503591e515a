// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"
#include "cli/options/load_options.h"
#include "cli/options/option_types.h"
#include "commands/view_job.h"

namespace adasplats::app {
namespace {

constexpr const char* kViewExamples =
    "  adasplats view place.ply\n"
    "  adasplats view place.ply --sequence sequences/00 --sensor velodyne-vlp-16\n"
    "  adasplats view place.ply --cloud mapping.ply --errors distances.ply --port 8123\n"
    "  adasplats view sequences/00\n"
    "  adasplats view world.toml --poses drive.csv --layer other.ply\n"
    "Prints the address of a page to look at it, and to drive a LiDAR through it, with a browser "
    "on\n"
    "this machine. Ctrl-C ends it.\n";

class ViewCommand final : public Command {
 public:
  explicit ViewCommand(CLI::App& program)
      : Command(program, "view", "Look at a model in a browser and drive a LiDAR through it",
                kViewExamples) {
    OptionSet& app = options();
    require(
        add_path(app, "INPUT", job_.input,
                 "Splat model, mesh, world file, point cloud, sequence, or a folder with a model "
                 "and a sequence"));
    add_paths(app, "--cloud", job_.clouds, "Points to show beside the model: a file or a sequence");
    add_paths(app, "--layer", job_.layers,
              "Another model, mesh or cloud to show beside it; rays do not meet it");
    add_paths(app, "--errors", job_.errors, "Points with errors: what evaluate --errors wrote");
    add_paths(app, "--sequence", job_.sequences, "Recorded scans, and where they were taken");
    add_paths(app, "--poses", job_.trajectories,
              "A trajectory to show: KITTI poses.txt, CSV or TUM");
    app.add_option("--sensor", job_.sensor, "The LiDAR to begin with: one of 'adasplats sensors'")
        ->capture_default_str()
        ->type_name("NAME");
    app.add_option("--mount-height", job_.mount_height_m,
                   "Of the sensor above the ground where no pose tells, m")
        ->capture_default_str();
    app.add_option(
           "--labels", job_.labels,
           "What classes mean: semantickitti, paris-carla-3d, pandaset, nuscenes, asprs or a TOML "
           "file; the default is "
           "what the model says")
        ->type_name("SCHEME");
    app.add_option("--port", job_.port, "Of the page; 0: any free one")->capture_default_str();
    app.add_option("--address", job_.address,
                   "To listen at. Anything but this machine's own (127.0.0.1, ::1) lets others on "
                   "the network in who know the page's address")
        ->capture_default_str();
    app.add_option("--token", job_.token,
                   "Secret part of the page's address; the default is a new one every time")
        ->type_name("TEXT");
    add_switch(app, "--browser,!--no-browser", job_.browser, "Open the page in a browser");
    add_load_options(app, job_.load);
    add_device_options();
  }

  void run(Session& session) override {
    job_.cloud_option = given_load_option(options());
    job_.sensor_is_asked = is_given("--sensor");
    run_view(job_, session);
  }

 private:
  static void add_paths(OptionSet& app, const std::string& name,
                        std::vector<std::filesystem::path>& target, const std::string& help) {
    app.add_option(name, target, help)->type_name("PATH")->repeatable();
  }

  ViewJob job_;
};

}  // namespace

std::unique_ptr<Command> make_view_command(CLI::App& program) {
  return std::make_unique<ViewCommand>(program);
}

}  // namespace adasplats::app
