// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/cloud/poses/mount.h"
#include "adasplats/live/live_job.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
#include "cli/stop_on_signal.h"
#include "cli/terminal.h"

namespace adasplats::app {
namespace {

constexpr const char* kServeSensorExamples =
    "  adasplats serve-sensor model.ply\n"
    "  adasplats serve-sensor world.toml --trajectory drive.csv --sensor velodyne-hdl-64e-s3 \\\n"
    "      --no-noise --rotation-rate 20 --packets 127.0.0.1\n"
    "  adasplats serve-sensor world.toml --rig car.toml --trajectory drive.csv --paused \\\n"
    "      --port 8765 --token bench\n"
    "Prints the address of the HTTP API, of a page that shows the scans, and of the Foxglove\n"
    "WebSocket with messages of ROS 2 (docs/live.md). Ctrl-C ends it.\n";

class ServeSensorCommand final : public Command {
 public:
  explicit ServeSensorCommand(CLI::App& program)
      : Command(program, "serve-sensor",
                "Simulate a LiDAR, or those of a car, in real time for other programs",
                kServeSensorExamples) {
    OptionSet& app = options();
    require(add_path(app, "MODEL", job_.model,
                     "Splat model, city, triangle mesh (PLY, OBJ, glTF) or world file (TOML)"));
    add_sensor_option(app, job_.scan.sensor)->basic();
    add_path(app, "--rig", job_.rig,
             "Instead of --sensor: rig file with the sensors and cameras of a car (TOML)")
        ->basic();
    add_labels_option(app, job_.labels, "that of the model");
    add_path(app, "--trajectory", job_.drive.trajectory,
             "Poses of sensor or car: KITTI, CSV, TUM, sequence folder or recording "
             "(default: at rest on open ground)")
        ->basic();
    add_places(app, "--at", job_.drive.at,
               "Instead of --trajectory: where sensor or car begins (without Z: above the ground)")
        ->basic();
    add_settings(app, mount_);
    app.add_option("--packets", job_.packets_to,
                   "Send the packets of the sensors over UDP to this host; port: that of the "
                   "sensor, of a rig 2368 and following")
        ->type_name("HOST[:PORT]")
        ->basic();
    add_choice<CloudDriver>(app, "--driver", job_.driver, choices_of<CloudDriver>(kCloudDrivers),
                            "Send point clouds in the layout of this ROS 2 driver; 'adasplats' "
                            "also has classes and instances");
    add_switch(app, "--paused", job_.is_paused, "Wait for requests to run or step")->basic();
    app.add_option("--port", job_.port, "Port of the server; 0: any free one")
        ->capture_default_str()
        ->basic();
    app.add_option("--address", job_.address,
                   "Address to listen on. All but 127.0.0.1 and ::1 give access to anyone on the "
                   "network who has the token")
        ->capture_default_str();
    app.add_option("--token", job_.token,
                   "Secret part of the address (default: a new one every time)")
        ->type_name("TEXT")
        ->basic();
    app.add_option("--allow-origin", job_.allowed_origins,
                   "Web page that may connect, such as https://app.foxglove.dev")
        ->type_name("URL")
        ->repeatable();
    add_settings(app, job_.scan);
    add_device_options();
  }

  void run(Session& session) override {
    if (!job_.rig.empty())
      reject({"--sensor", "--mount", "--mount-rotation"},
             "with --rig, whose file has the sensors and their mounts");
    job_.drive.mount = mount_.transform();
    session.report.update(run_live(job_, session, [](const LiveAddress& address) {
      std::string text = address.server.url() + "\n";
      for (const LiveAddress::Sensor& sensor : address.sensors)
        if (sensor.port != 0)
          text += sensor.name + ": packets to port " + std::to_string(sensor.port) + "\n";
      print(text);
      const StopOnSignal stop(address.server);
      address.server.run();
    }));
    throw_if_interrupted();
  }

 private:
  LiveJob job_;
  MountSettings mount_;
};

}  // namespace

std::unique_ptr<Command> make_serve_sensor_command(CLI::App& program) {
  return std::make_unique<ServeSensorCommand>(program);
}

}  // namespace adasplats::app
