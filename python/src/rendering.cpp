// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/layer_files.h"
#include "adasplats/jobs/scene/view_choice.h"
#include "cameras.h"
#include "clouds.h"
#include "scenes.h"
#include "trajectories.h"

namespace adasplats::python {
namespace {

constexpr const char* kRenderingDoc =
    R"(Render a picture of the scene: (height, width, 3) uint8, RGB, top row first.

eye, target: (3,) world coordinates, m. target: None for the middle of the scene. eye: None for a
point above, on the side that shows most. birds_eye: look straight down, north up. trajectory (a
path, a Trajectory or an array) and pose (its index): look ahead from a pose. camera: a Camera or a
path, mounted on what the trajectory is of; it has its own width, height and fov, and with eye it is
there. width, height: pixels. fov: horizontal, degrees; None: 45 from outside the scene, else 70.
color: 'semantic', 'shading', 'normal', 'intensity',
'range', 'height', 'rgb', or 'auto': rgb if the model has colours, else semantic if most of it has
classes, else intensity, else height. samples: rays per pixel and axis, 1 to 64. relief: darken corners and gaps and blend
splats; False: every sample has only its own colour. Raises TypeError, ValueError, OSError.)";

constexpr const char* kLayersDoc =
    R"(Quantities of the surface that each pixel shows, through the centre of the pixel.

layers: names, or None for all that the scene has: 'depth' along the axis of the camera and 'range'
along the ray, m, (height, width) float32; 'class', (height, width) int32; 'normal' in world axes,
towards the camera, (height, width, 3) float32; 'splat', index of the splat or triangle, (height,
width) int32. Pixels without a hit are NaN or -1. The others are arguments of render(). Returns a
dict of new arrays, top row first. Raises TypeError, ValueError, OSError.)";

using Color = std::optional<ImageColor>;
constexpr std::pair<std::string_view, Color> kColors[] = {{"auto", std::nullopt},
                                                          {"semantic", ImageColor::semantic},
                                                          {"shading", ImageColor::shading},
                                                          {"normal", ImageColor::normal},
                                                          {"intensity", ImageColor::intensity},
                                                          {"range", ImageColor::range},
                                                          {"height", ImageColor::height},
                                                          {"rgb", ImageColor::rgb}};

/// The view of a call.
struct ViewArguments {
  ViewChoice view;
  py::object trajectory = py::none();
  py::object camera = py::none();
  std::uint64_t pose = 0;

  void take(Keywords& keywords) {
    keywords.take("eye", view.eye);
    keywords.take("target", view.target);
    keywords.take("birds_eye", view.birds_eye);
    keywords.take("trajectory", trajectory);
    keywords.take("pose", pose);
    keywords.take("camera", camera);
    keywords.take("width", view.width);
    keywords.take("height", view.height);
    keywords.take("fov", view.horizontal_fov_deg);
  }

  /// Errors: TypeError, ValueError, those of the files.
  void resolve(const py::kwargs& given) {
    view.pose = pose;
    if (is_path(trajectory)) {
      view.trajectory = path_of(trajectory, "trajectory");
    } else if (!trajectory.is_none()) {
      const Trajectory poses = trajectory_of(trajectory, "trajectory");
      if (pose >= poses.size())
        throw py::value_error("pose is " + std::to_string(pose) + ": the trajectory has " +
                              std::to_string(poses.size()) + " poses");
      view.at = poses[pose].world_from_sensor;
    }
    if (!camera.is_none()) {
      for (const char* name : {"width", "height"})
        if (given.contains(name))
          throw py::value_error(std::string(name) +
                                " has no effect with camera, which has its own");
      view.use(camera_of(camera));
    }
    check(view);
  }
};

struct RenderArguments {
  ViewArguments view;
  Color color;
  int samples = 2;
  bool relief = true;

  void take(Keywords& keywords) {
    view.take(keywords);
    keywords.take<Color>("color", color, kColors);
    keywords.take("samples", samples);
    keywords.take("relief", relief);
  }
};

struct LayerArguments {
  py::object layers = py::none();
  ViewArguments view;

  void take(Keywords& keywords) {
    keywords.take("layers", layers);
    view.take(keywords);
  }

  /// Errors: TypeError, ValueError.
  std::vector<ImageLayer> wanted(const ModelScene& scene) const {
    if (!layers.is_none()) {
      if (py::isinstance<py::str>(layers))
        throw py::type_error("layers: expected a list of names, got str");
      std::string list;
      for (const py::handle name : layers)
        list += (list.empty() ? "" : ",") + name.cast<std::string>();
      return layers_of(list);
    }
    std::vector<ImageLayer> all;
    for (const auto& [word, layer] : kImageLayers)
      if (layer != ImageLayer::class_id || !scene.attributes().classes.empty())
        all.push_back(layer);
    return all;
  }
};

py::array render(SceneObject& object, const py::kwargs& kwargs) {
  auto arguments = arguments_of<RenderArguments>("render", kwargs);
  if (arguments.samples < 1 || arguments.samples > 64)
    throw py::value_error("samples must be 1 to 64");
  arguments.view.resolve(kwargs);
  Image image;
  {
    const py::gil_scoped_release released;
    const auto lock = object.lock();
    const ModelScene& scene = *object.scene;
    ImageOptions options;
    options.color = arguments.color.value_or(scene.default_color());
    options.samples_per_axis = arguments.samples;
    options.relief = arguments.relief;
    image = scene.render(camera_of(arguments.view.view, scene.shown_part()), options);
  }
  return owned_array(std::move(image.pixels), {image.height, image.width, 3});
}

template <class T>
void put(py::dict& dict, const char* name, std::vector<T>& values, const LayerImages& images,
         std::vector<py::ssize_t> last = {}) {
  if (values.empty()) return;
  std::vector<py::ssize_t> shape = {images.height, images.width};
  shape.insert(shape.end(), last.begin(), last.end());
  dict[name] = owned_array(std::move(values), std::move(shape));
}

py::dict layers(SceneObject& object, const py::kwargs& kwargs) {
  auto arguments = arguments_of<LayerArguments>("layers", kwargs);
  arguments.view.resolve(kwargs);
  const std::vector<ImageLayer> wanted = arguments.wanted(*object.scene);
  LayerImages images;
  {
    const py::gil_scoped_release released;
    const auto lock = object.lock();
    const ModelScene& scene = *object.scene;
    images =
        cast_layers(scene.tracer(), scene.image_scene(),
                    camera_of(arguments.view.view, scene.shown_part()), wanted, scene.executor());
  }
  py::dict dict;
  put(dict, "depth", images.depth_m, images);
  put(dict, "range", images.range_m, images);
  put(dict, "class", images.classes, images);
  put(dict, "normal", images.normals, images, {3});
  put(dict, "splat", images.primitives, images);
  return dict;
}

}  // namespace

void add_rendering(SceneClass& type) {
  type.def("render", &render, documented<RenderArguments>("render", "self", kRenderingDoc).c_str());
  type.def("layers", &layers, documented<LayerArguments>("layers", "self", kLayersDoc).c_str());
}

}  // namespace adasplats::python
