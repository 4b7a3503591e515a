// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/jobs/pictures/render.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kRenderExamples =
    "  adasplats render street.ply -o street.png\n"
    "  adasplats render street.ply -o above.png --birds-eye --color semantic\n"
    "  adasplats render basic.ply adaptive.ply -o both.png --trajectory poses.txt --pose 12\n"
    "  adasplats render street.ply -o around.webp --turntable\n"
    "  adasplats render street.ply -o drive.mp4 --drive --trajectory poses.txt\n"
    "  adasplats render basic.ply adaptive.ply -o changes.png --difference\n"
    "  adasplats render street.ply -o pole.png --eye 3,-2,1.7 --target 8,4,2 --color normal\n"
    "  adasplats render street.ply street/mapping.ply -o measured.png --labels semantickitti\n";

class RenderCommand final : public Command {
 public:
  explicit RenderCommand(CLI::App& program)
      : Command(program, "render",
                "Draw splat models, meshes and point clouds, side by side, from above a corner or "
                "as told",
                kRenderExamples) {
    OptionSet& app = options();
    require(app.add_option_function<std::vector<std::string>>(
                   "MODEL",
                   [this](const std::vector<std::string>& names) {
                     job_.models.assign(names.begin(), names.end());
                   },
                   "Splat models, triangle meshes (PLY, OBJ), point files, sequence folders")
                ->type_name("PATH"));
    require(writes(
        add_path(app, "-o,--output", job_.output, "Picture to write, PNG; a film: WebP or MP4"),
        {".png", ".webp", ".mp4"}));
    app.add_option(
           "--labels", job_.labels,
           "What classes mean: semantickitti, paris-carla-3d, pandaset, nuscenes, asprs or a TOML "
           "file; the default is "
           "what the model says")
        ->type_name("SCHEME");
    add_choice<std::optional<ImageColor>>(
        app, "--color", job_.look.color,
        {{"shading", ImageColor::shading},
         {"semantic", ImageColor::semantic},
         {"normal", ImageColor::normal},
         {"intensity", ImageColor::intensity},
         {"range", ImageColor::range},
         {"height", ImageColor::height}},
        "What colours show; without it classes where most have one, else intensity, else height");
    app.add_option("--width", job_.view.width, "Pixels, of one model's part")
        ->capture_default_str();
    app.add_option("--height", job_.view.height, "Pixels")->capture_default_str();
    app.add_flag("--turntable", turntable_, "A film once around the place");
    app.add_flag("--drive", drive_, "A film along --trajectory");
    add_settings(app, job_);
    app.add_option("--fov", job_.view.horizontal_fov_deg,
                   "Horizontal field of view, degrees; 45 from afar, else 70");
    add_vector(app, "--eye", job_.view.eye, "Where the camera is, world coordinates");
    add_vector(app, "--target", job_.view.target, "What it looks at; the middle of the model");
    app.add_flag("--birds-eye", job_.view.birds_eye, "From straight above, north up");
    add_path(app, "--trajectory", job_.view.trajectory,
             "Look ahead from a pose: a pose file or a sequence folder");
    app.add_option("--pose", job_.view.pose, "Number of that pose, from 0")->capture_default_str();
    add_path(app, "--errors", job_.errors,
             "Colour the splats of one model by held-out beams: a file of 'evaluate resimulate "
             "--errors'");
    add_device_options();
  }

  void run(Session& session) override {
    if (job_.view.trajectory.empty()) refuse({"--pose"}, "without --trajectory");
    if (turntable_ && drive_) refuse({"--drive"}, "with --turntable");
    if (turntable_ || drive_) {
      refuse({"--pose", "--repeat"}, "with a film");
      job_.film = turntable_ ? Film::turntable : Film::drive;
      if (!is_given("--width") && !is_given("--height"))
        job_.view.width = 1280, job_.view.height = 720;
    } else {
      refuse({"--seconds", "--frames-per-s"}, "without --turntable or --drive");
    }
    if (job_.view.birds_eye) refuse({"--fov"}, "with --birds-eye");
    if (!draws_a_model(job_)) refuse({"--samples"}, "on points; it is for models and meshes");
    const RenderResult result = run_render(job_, session);
    const double rate = static_cast<double>(result.images) / result.seconds_rendered;
    session.report["images_per_second"] = rate;
    session.report["seconds_rendered"] = result.seconds_rendered;
    print(job_.output.string() + ": " + fixed(result.seconds_rendered, 2) + " s, " +
          fixed(rate, 1) + " images/s\n");
  }

 private:
  RenderJob job_;
  bool turntable_ = false, drive_ = false;
};

}  // namespace

std::unique_ptr<Command> make_render_command(CLI::App& program) {
  return std::make_unique<RenderCommand>(program);
}

}  // namespace adasplats::app
