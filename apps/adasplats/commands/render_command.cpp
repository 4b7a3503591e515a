// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/jobs/pictures/render.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/options/shared_options.h"
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
    "  adasplats render place/world.toml -o traffic.mp4 --drive --trajectory poses.csv\n"
    "  adasplats render basic.ply adaptive.ply -o changes.png --difference\n"
    "  adasplats render street.ply -o pole.png --eye 3,-2,1.7 --target 8,4,2 --color normal\n"
    "  adasplats render street.ply street/mapping.ply -o measured.png --labels semantickitti\n";

class RenderCommand final : public Command {
 public:
  explicit RenderCommand(CLI::App& program)
      : Command(program, "render",
                "Draw splat models, meshes and point clouds, side by side, as a picture or film",
                kRenderExamples) {
    OptionSet& app = options();
    require(
        add_paths(app, "MODEL", job_.models,
                  "Splat models, meshes (PLY, OBJ), world files, point files, sequence folders"));
    require(writes(add_path(app, "-o,--output", job_.output,
                            "PNG, film (WebP, MP4) or folder (--each-pose) to write"),
                   {".png", ".webp", ".mp4", ""}));
    add_labels_option(app, job_.labels, "that of the model");
    add_choice<std::optional<ImageColor>>(app, "--color", job_.look.color,
                                          {{"shading", ImageColor::shading},
                                           {"semantic", ImageColor::semantic},
                                           {"normal", ImageColor::normal},
                                           {"intensity", ImageColor::intensity},
                                           {"range", ImageColor::range},
                                           {"height", ImageColor::height},
                                           {"rgb", ImageColor::rgb}},
                                          "Meaning of the colours (default: those in the file of "
                                          "points, else classes if most splats or points have "
                                          "one, else intensity, else height)")
        ->basic();
    app.add_option("--width", job_.view.width, "Width of the picture of one model, pixels")
        ->capture_default_str()
        ->basic();
    app.add_option("--height", job_.view.height, "Height, pixels")->capture_default_str()->basic();
    app.add_flag("--turntable", turntable_, "Make a film around the scene")->basic();
    app.add_flag("--drive", drive_, "Make a film along --trajectory")->basic();
    add_settings(app, job_);
    app.add_option("--fov", job_.view.horizontal_fov_deg,
                   "Horizontal field of view, degrees (default: 45 for an overview, else 70)");
    add_vector(app, "--eye", job_.view.eye, "Camera position, world coordinates")->basic();
    add_vector(app, "--target", job_.view.target,
               "Point that the camera looks at (default: the middle of the model)")
        ->basic();
    app.add_flag("--birds-eye", job_.view.birds_eye, "Look straight down, north up")->basic();
    add_path(app, "--trajectory", job_.view.trajectory,
             "Look ahead from a pose of this pose file or sequence folder")
        ->basic();
    app.add_option("--time", job_.time_s,
                   "Time at which objects of a world file are shown, s (default: that of the pose, "
                   "else when the first begins to move)");
    app.add_option("--pose", job_.view.pose, "Number of the pose, from 0")->capture_default_str();
    add_path(
        app, "--errors", job_.errors,
        "Colour the splats of one model by errors of held-out beams, from 'evaluate resimulate "
        "--errors'");
    app.add_flag("--overwrite", job_.overwrite, "Replace an existing output folder");
    add_device_options();
  }

  void run(Session& session) override {
    if (job_.view.trajectory.empty()) reject({"--pose"}, "without --trajectory");
    if (turntable_ && drive_) reject({"--drive"}, "with --turntable");
    if (turntable_ || drive_) {
      reject({"--pose", "--repeat"}, "with a film");
      job_.film = turntable_ ? Film::turntable : Film::drive;
      if (!is_given("--width") && !is_given("--height"))
        job_.view.width = 1280, job_.view.height = 720;
    } else {
      reject({"--seconds", "--frames-per-s"}, "without --turntable or --drive");
    }
    if (job_.view.birds_eye) reject({"--fov"}, "with --birds-eye");
    if (job_.each_pose)
      reject({"--pose", "--repeat"}, "with --each-pose");
    else
      reject({"--overwrite"}, "without --each-pose");
    if (!job_.camera.empty())
      reject({"--width", "--height", "--fov", "--birds-eye"}, "with --camera");
    if (!draws_a_model(job_)) reject({"--samples"}, "on points, only on models and meshes");
    const RenderResult result = run_render(job_, session);
    const double rate = static_cast<double>(result.images) / result.seconds_rendered;
    session.report["images_per_second"] = rate;
    session.report["seconds_rendered"] = result.seconds_rendered;
    std::string text = job_.output.string() + ": " + fixed(result.seconds_rendered, 2) + " s, " +
                       fixed(rate, 1) + " images/s";
    if (!job_.layers.empty()) text += report_layers(result, session);
    print(text + "\n");
  }

 private:
  static std::string report_layers(const RenderResult& result, Session& session) {
    session.report["seconds_of_layers"] = result.seconds_of_layers;
    session.report["clipped_values"] = result.clipped_values;
    session.report["unlit_pixels"] = result.unlit_pixels;
    std::string text = "; layers " + fixed(result.seconds_of_layers, 2) + " s";
    if (result.clipped_values > 0)
      text +=
          ", " + grouped(result.clipped_values) + " values outside the range of the PNG (65.535 m)";
    if (result.unlit_pixels > 0)
      text += ", " + grouped(result.unlit_pixels) + " pixels without a ray of the lens";
    return text;
  }

  RenderJob job_;
  bool turntable_ = false, drive_ = false;
};

}  // namespace

std::unique_ptr<Command> make_render_command(CLI::App& program) {
  return std::make_unique<RenderCommand>(program);
}

}  // namespace adasplats::app
