// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/view_choice.h"
#include "clouds.h"
#include "scenes.h"

namespace adasplats::python {
namespace {

constexpr const char* kRenderingDoc =
    "A picture of the scene: (height, width, 3) uint8, RGB, rows from the top.\n\n"
    "eye, target: (3,) world coordinates, m; without target the middle of the scene, without eye\n"
    "from above, from the side that shows most. birds_eye: straight down, north up. trajectory (a "
    "path) and pose:\n"
    "ahead from a pose of it. fov: horizontal, degrees; None: 45 from afar, else 70. color:\n"
    "'semantic', 'shading', 'normal', 'intensity', 'range', 'height', or 'auto' for semantic "
    "where\n"
    "most of the model has it, else intensity, else height. samples: rays a pixel, the square of\n"
    "this. relief: corners and gaps are dark, splats run into each other; without it every sample\n"
    "has its own colour alone. Raises TypeError, ValueError, OSError.";

using Color = std::optional<ImageColor>;
constexpr std::pair<std::string_view, Color> kColors[] = {{"auto", std::nullopt},
                                                          {"semantic", ImageColor::semantic},
                                                          {"shading", ImageColor::shading},
                                                          {"normal", ImageColor::normal},
                                                          {"intensity", ImageColor::intensity},
                                                          {"range", ImageColor::range},
                                                          {"height", ImageColor::height}};

struct RenderArguments {
  ViewChoice view;
  Color color;
  int samples = 2;
  bool relief = true;

  void take(Keywords& keywords) {
    keywords.take("eye", view.eye);
    keywords.take("target", view.target);
    keywords.take("birds_eye", view.birds_eye);
    keywords.take("trajectory", view.trajectory);
    std::uint64_t pose = view.pose;
    keywords.take("pose", pose);
    view.pose = pose;
    keywords.take("width", view.width);
    keywords.take("height", view.height);
    keywords.take("fov", view.horizontal_fov_deg);
    keywords.take<Color>("color", color, kColors);
    keywords.take("samples", samples);
    keywords.take("relief", relief);
  }
};

py::array render(SceneObject& object, const py::kwargs& kwargs) {
  Keywords keywords("render", kwargs);
  RenderArguments arguments;
  arguments.take(keywords);
  keywords.finish();
  if (arguments.samples < 1 || arguments.samples > 64)
    throw py::value_error("samples must be 1 to 64");
  check(arguments.view);
  Image image;
  {
    const py::gil_scoped_release released;
    const auto lock = object.lock();
    const ModelScene& scene = *object.scene;
    ImageOptions options;
    options.color = arguments.color.value_or(scene.default_color());
    options.samples_per_axis = arguments.samples;
    options.relief = arguments.relief;
    image = scene.render(camera_of(arguments.view, scene.shown_part()), options);
  }
  return owned_array(std::move(image.pixels), {image.height, image.width, 3});
}

}  // namespace

void add_rendering(SceneClass& type) {
  const std::string doc = documented(
      "render", "self",
      [](Keywords& keywords) {
        RenderArguments arguments;
        arguments.take(keywords);
      },
      kRenderingDoc);
  type.def("render", &render, doc.c_str());
}

}  // namespace adasplats::python
