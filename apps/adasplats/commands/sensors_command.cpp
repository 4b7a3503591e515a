// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "adasplats/io/arrays/png.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/sensors/lidar_library.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "commands/sensors_job.h"

namespace adasplats::app {
namespace {

constexpr const char* kSensorsExamples =
    "  adasplats sensors\n"
    "  adasplats sensors velodyne-vlp-16 -o pattern.png\n"
    "  adasplats sensors --show hesai-ot128 > mine.toml\n"
    "  adasplats sensors metadata.json\n";

class SensorsCommand final : public Command {
 public:
  explicit SensorsCommand(CLI::App& program)
      : Command(program, "sensors",
                "List the LiDAR sensors that are known, describe one, or draw its pattern",
                kSensorsExamples) {
    OptionSet& app = options();
    app.add_option("SENSOR", sensor_,
                   "A name of the list, or a file: TOML, Ouster metadata (JSON), Velodyne "
                   "calibration (YAML), Hesai angles or rays (CSV); without it: the list")
        ->type_name("NAME|FILE");
    app.add_flag("--show", show_,
                 "Print the TOML of a sensor of the list, to be copied and edited");
    writes(add_path(app, "-o,--output", picture_, "Picture of the pattern to write, PNG"),
           {".png"});
  }

  void run(Session& session) override {
    if (sensor_.empty()) {
      if (show_ || !picture_.empty())
        throw Error(ErrorKind::usage,
                    std::string(show_ ? "--show" : "--output") + " needs the name of a sensor");
      print(library_table(session));
      return;
    }
    if (!picture_.empty()) check_output_file(picture_);
    const LidarModel sensor = load_lidar_model(sensor_);
    const std::string text = describe(sensor, session);
    print(show_ ? toml_of(sensor_) : text);
    if (picture_.empty()) return;
    const Image image = draw_pattern(sensor);
    write_png(picture_, image.width, image.height, image.pixels);
  }

 private:
  static std::string toml_of(const std::string& name) {
    const auto library = lidar_library();
    const auto lidar = std::ranges::find(library, name, &LibraryLidar::name);
    if (lidar == library.end())
      throw Error(ErrorKind::usage, "--show needs a sensor of the list, not the file '" + name +
                                        "'; a TOML file can hold: like = \"" + name + "\"");
    return std::string(lidar->toml);
  }

  std::string sensor_;
  bool show_ = false;
  std::filesystem::path picture_;
};

}  // namespace

std::unique_ptr<Command> make_sensors_command(CLI::App& program) {
  return std::make_unique<SensorsCommand>(program);
}

}  // namespace adasplats::app
