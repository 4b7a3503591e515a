// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/view_choice.h"
#include "clouds.h"
#include "scenes.h"

namespace adasplats::python {
namespace {

constexpr const char* kRenderingDoc =
    R"(Render a picture of the scene: (height, width, 3) uint8, RGB, top row first.

eye, target: (3,) world coordinates, m. target: None for the middle of the scene. eye: None for a
point above, on the side that shows most. birds_eye: look straight down, north up. trajectory (a
path) and pose (its index): look ahead from a pose. width, height: pixels. fov: horizontal, degrees;
None: 45 from outside the scene, else 70. color: 'semantic', 'shading', 'normal', 'intensity',
'range', 'height', 'rgb', or 'auto': rgb if the model has colours, else semantic if most of it has
classes, else intensity, else height. samples: rays per pixel and axis, 1 to 64. relief: darken corners and gaps and blend
splats; False: every sample has only its own colour. Raises TypeError, ValueError, OSError.)";

using Color = std::optional<ImageColor>;
constexpr std::pair<std::string_view, Color> kColors[] = {{"auto", std::nullopt},
                                                          {"semantic", ImageColor::semantic},
                                                          {"shading", ImageColor::shading},
                                                          {"normal", ImageColor::normal},
                                                          {"intensity", ImageColor::intensity},
                                                          {"range", ImageColor::range},
                                                          {"height", ImageColor::height},
                                                          {"rgb", ImageColor::rgb}};

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
  const auto arguments = arguments_of<RenderArguments>("render", kwargs);
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
  type.def("render", &render, documented<RenderArguments>("render", "self", kRenderingDoc).c_str());
}

}  // namespace adasplats::python
