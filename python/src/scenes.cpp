// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"

#include "adasplats/cloud/labels/label_scheme.h"
#include "clouds.h"
#include "device_arrays.h"
#include "models.h"

namespace adasplats::python {
namespace {

constexpr const char* kScenesDoc = R"(A scene that rays are cast into, on the CPU or on GPUs.

model: a Model, a Mesh, or the path of a model, of a mesh (PLY, OBJ, glTF) or of a world file. A
Model or Mesh is copied. device: 'auto' (a GPU if there is one), 'cpu', 'cuda', 'optix'. gpus: GPU
indices. threads: 0 for all that the process may use. labels: the label scheme, a name or a file;
None: that of the model. Several threads may use a scene at the same time; methods release the GIL
while they work. Raises TypeError, ValueError, OSError, RuntimeError (the GPU is missing).)";

struct SceneArguments {
  std::string labels;
  WorkOptions work;

  void take(Keywords& keywords) {
    work.take(keywords);
    keywords.take("labels", labels);
  }
};

std::unique_ptr<ModelScene> scene_of(py::handle model, const std::string& labels,
                                     SceneObject& object, PythonProgress& progress) {
  std::optional<AnyModel> in_memory;
  std::filesystem::path file;
  if (py::isinstance<ModelObject>(model)) {
    in_memory = model.cast<const ModelObject&>().model;
  } else if (py::isinstance<MeshModel>(model)) {
    in_memory = model.cast<const MeshModel&>();
  } else {
    file = path_of(model, "model");
  }
  const py::gil_scoped_release released;
  std::optional<LabelScheme> scheme;
  if (!labels.empty() && file.empty()) scheme = load_label_scheme(labels);
  Session session{object.executor, progress, 1, object.device};
  if (in_memory)
    return std::make_unique<ModelScene>(*std::move(in_memory), std::move(scheme), session);
  return std::make_unique<ModelScene>(file, labels, session, WorldFiles::taken);
}

std::shared_ptr<SceneObject> make_scene(py::handle model, const py::kwargs& kwargs) {
  const auto arguments = arguments_of<SceneArguments>("Scene", kwargs);
  PythonProgress progress(arguments.work.progress);
  auto object = std::make_shared<SceneObject>(checked_threads(arguments.work.threads));
  object->device = choose_device(arguments.work.device);
  object->scene = scene_of(model, arguments.labels, *object, progress);
  progress.issue_warnings();
  return object;
}

py::object labels_of(const SceneObject& object) {
  const LabelScheme* const labels = object.scene->labels();
  return labels == nullptr ? py::object(py::none())
                           : py::cast(std::make_shared<LabelScheme>(*labels));
}

}  // namespace

void bind_scenes(py::module_& module) {
  SceneClass type(module, "Scene", kScenesDoc);
  type.def(py::init(&make_scene), py::arg("model"),
           documented<SceneArguments>("__init__", "self, model", "See the class.").c_str())
      .def("__len__", [](const SceneObject& o) { return o.scene->view().primitive_count(); })
      .def("__repr__",
           [](const SceneObject& o) {
             return "<adasplats.Scene of " + std::to_string(o.scene->view().primitive_count()) +
                    " primitives on " + device_key(o.device) + ">";
           })
      .def_property_readonly(
          "origin", [](const SceneObject& o) { return array_of(o.scene->origin()); },
          "(3,) float64, world coordinates of the local origin, m.")
      .def_property_readonly(
          "device", [](const SceneObject& o) { return device_key(o.device); },
          "The device that casts rays: 'cpu', or 'cuda' or 'optix' and the names of GPUs.")
      .def_property_readonly(
          "threads", [](const SceneObject& o) { return o.executor.threads(); },
          "Number of CPU threads.")
      .def_property_readonly("labels", &labels_of, "The LabelScheme of its classes, or None.");
  add_casting(type);
  add_simulation(type);
  add_placed_poses(type);
  add_rendering(type);
  add_device_arrays(type);
  add_device_results(type);
  add_scan_batches(type);
}

}  // namespace adasplats::python
