// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"

#include "adasplats/cloud/labels/label_scheme.h"
#include "clouds.h"
#include "device_arrays.h"
#include "models.h"

namespace adasplats::python {
namespace {

constexpr const char* kScenesDoc =
    "A place that rays are cast into, on the CPU or on GPUs.\n\n"
    "model: a Model, a Mesh, or the path of a model, of a mesh (PLY, OBJ, glTF) or of a world "
    "file.\n"
    "A Model or Mesh is copied. device: 'auto' (a GPU where there is one), 'cpu', 'cuda', "
    "'optix';\n"
    "gpus: their numbers. threads: 0 for all that the process may use. labels: what the classes\n"
    "mean; what the model says where it is None. May be used by several threads at a time; the "
    "work\n"
    "is done without the GIL. Raises ValueError, OSError, RuntimeError (a GPU that is not there).";

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
  std::optional<AnyModel> place;
  std::filesystem::path file;
  if (py::isinstance<ModelObject>(model)) {
    place = model.cast<const ModelObject&>().model;
  } else if (py::isinstance<MeshModel>(model)) {
    place = model.cast<const MeshModel&>();
  } else {
    file = path_of(model, "model");
  }
  const py::gil_scoped_release released;
  std::optional<LabelScheme> scheme;
  if (!labels.empty() && file.empty()) scheme = load_label_scheme(labels);
  Session session{object.executor, progress, 1, object.device};
  if (place) return std::make_unique<ModelScene>(*std::move(place), std::move(scheme), session);
  return std::make_unique<ModelScene>(file, labels, session, WorldFiles::taken);
}

std::shared_ptr<SceneObject> make_scene(py::handle model, const py::kwargs& kwargs) {
  Keywords keywords("Scene", kwargs);
  SceneArguments arguments;
  arguments.take(keywords);
  keywords.finish();
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
  const std::string doc = documented(
      "__init__", "self, model",
      [](Keywords& keywords) {
        SceneArguments arguments;
        arguments.take(keywords);
      },
      "See the class.");
  SceneClass type(module, "Scene", kScenesDoc);
  type.def(py::init(&make_scene), py::arg("model"), doc.c_str())
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
          "What casts: 'cpu', or 'cuda' or 'optix' and the names of GPUs.")
      .def_property_readonly(
          "threads", [](const SceneObject& o) { return o.executor.threads(); }, "Of the CPU.")
      .def_property_readonly("labels", &labels_of, "The LabelScheme of its classes, or None.");
  add_casting(type);
  add_simulation(type);
  add_places(type);
  add_rendering(type);
  add_device_arrays(type);
  add_device_results(type);
  add_scan_batches(type);
}

}  // namespace adasplats::python
