// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <thread>

#include "adasplats/core/error.h"
#include "adasplats/view/live_message.h"
#include "adasplats/view/live_scans.h"
#include "adasplats/view/page_files.h"
#include "adasplats/view/view_pages.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/options/option_types.h"
#include "cli/options/shared_options.h"
#include "cli/stop_on_signal.h"
#include "cli/terminal.h"
#include "commands/view_inputs.h"

namespace adasplats::app {
namespace {

constexpr const char* kViewExamples =
    "  adasplats view model.ply\n"
    "  adasplats view model.ply --sequence sequences/00 --sensor velodyne-vlp-16\n"
    "  adasplats view model.ply --cloud mapping.ply --errors distances.ply --port 8123\n"
    "  adasplats view sequences/00\n"
    "  adasplats view world.toml --poses drive.csv --layer other.ply\n"
    "Prints the address of a page that shows the input, for a browser on this machine. Ctrl-C "
    "ends\n"
    "it.\n";

void check_page() {
  if (!page_files().empty()) return;
  throw Error(ErrorKind::unavailable,
              "this program was built without the viewer; install Node.js 18 or newer with npm and "
              "build it again (the build prints what it found)");
}

/// Opens an address in the desktop's browser; does nothing without a desktop.
void open_browser(const std::string& url) {
  const bool has_desktop =
      std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
  if (!has_desktop) return;
  std::string program = "xdg-open";
  std::string address = url;
  char* const words[] = {program.data(), address.data(), nullptr};
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_RDWR, 0);
  pid_t child = 0;
  const int failure = posix_spawnp(&child, words[0], &quiet, nullptr, words, environ);
  posix_spawn_file_actions_destroy(&quiet);
  // Without xdg-open, the address is still on the terminal.
  if (failure == 0) std::thread([child] { waitpid(child, nullptr, 0); }).detach();
}

/// Serves until Ctrl-C. Errors: unavailable (no viewer in this build, port taken), those of
/// loading.
void run_view(const ViewJob& job, Session& session) {
  check_page();
  live_sensor(job.sensor);  // rejects an unknown name before anything is loaded
  const LoadedView view = load_view(job, session);
  const ViewPages pages(view.scene);
  LiveScans live(view.scene, session.executor);
  HttpServerOptions options;
  options.address = job.address;
  options.port = job.port;
  options.token = job.token.empty() ? random_token() : job.token;
  HttpServer server(
      options, [&pages](std::string_view path) { return pages.get(path); }, live);
  print(server.url() + "\n");
  if (job.browser) open_browser(server.url());
  {
    const StopOnSignal stop(server);
    server.run();
  }
  throw_if_interrupted();
}

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
    add_each(app, "--cloud", job_.clouds, "Points to show with the model: a file or a sequence");
    add_each(app, "--layer", job_.layers,
             "Another model, mesh or cloud to show; simulated rays ignore it");
    add_each(app, "--errors", job_.errors, "Points with errors, written by evaluate --errors");
    add_each(app, "--sequence", job_.sequences, "Recorded scans with their poses");
    add_each(app, "--poses", job_.trajectories, "Trajectory to show: KITTI poses.txt, CSV or TUM");
    app.add_option("--sensor", job_.sensor, "Initial LiDAR: a name from 'adasplats sensors'")
        ->capture_default_str()
        ->type_name("NAME");
    app.add_option("--mount-height", job_.mount_height_m,
                   "Sensor height above the ground without poses, m")
        ->capture_default_str();
    add_labels_option(app, job_.labels, "that of the model");
    app.add_option("--port", job_.port, "Port of the page; 0: any free one")->capture_default_str();
    app.add_option("--address", job_.address,
                   "Address to listen on. All but 127.0.0.1 and ::1 give access to anyone on the "
                   "network who has the address of the page")
        ->capture_default_str();
    app.add_option("--token", job_.token,
                   "Secret part of the page's address (default: a new one every time)")
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
  static void add_each(OptionSet& app, const std::string& name,
                       std::vector<std::filesystem::path>& target, const std::string& help) {
    add_paths(app, name, target, help)->repeatable();
  }

  ViewJob job_;
};

}  // namespace

std::unique_ptr<Command> make_view_command(CLI::App& program) {
  return std::make_unique<ViewCommand>(program);
}

}  // namespace adasplats::app
