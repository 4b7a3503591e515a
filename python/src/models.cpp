// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "models.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "adasplats/city/city_manifest.h"
#include "adasplats/jobs/model/make_model.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/output/output_check.h"
#include "clouds.h"
#include "crs.h"
#include "json.h"
#include "pickles.h"
#include "work.h"

namespace adasplats {

template <class Archive>
void fields(Archive& archive, IntensityResponse& response) {
  archive("ranges_m", response.ranges_m);
  archive("range_gains", response.range_gains);
  archive("cos_incidences", response.cos_incidences);
  archive("incidence_gains", response.incidence_gains);
}

template <class Archive>
void fields(Archive& archive, LaserOffsets& lasers) {
  archive("range_m", lasers.range_m);
  archive("elevation_rad", lasers.elevation_rad);
  archive("azimuth_rad", lasers.azimuth_rad);
  archive("cells", lasers.cells);
}

template <class Archive>
void fields(Archive& archive, Calibration& calibration) {
  archive("mount", calibration.mount);
  archive("poses", calibration.poses);
  archive("lasers", calibration.lasers);
  archive("smooth_s", calibration.smooth_s);
  archive("sensor", calibration.sensor);
  archive("others", calibration.others);
}

template <class Archive>
void fields(Archive& archive, SplatModel& model) {
  archive("origin", model.origin);
  archive("crs", model.crs);
  archive("disks", model.disks);
  archive("opacities", model.opacities);
  archive("classes", model.classes);
  archive("groups", model.groups);
  archive("intensities", model.intensities);
  archive("drop_log_odds", model.drop_log_odds);
  archive("colors", model.colors);
  archive("response", model.response);
  archive("label_scheme", model.label_scheme);
  archive("network_sha256", model.network_sha256);
  archive("method", model.method);
  archive("calibration", model.calibration);
}

}  // namespace adasplats

namespace adasplats::python {

template <class Archive>
void fields(Archive& archive, ModelObject& object) {
  archive("model", object.model);
  archive("report", object.report);
}

namespace {

constexpr const char* kModelDoc = R"(Make a splat model from points.

points: a PointCloud, or a path or paths as in read() (these need less memory). labels: a name or a
file as in label_scheme(), for the method 'semantic' and for removing movable objects; sequence
folders have 'semantickitti' by default. segment: a network predicts classes of SemanticKITTI and
replaces existing labels; network: its file; None: the one that comes with adasplats. The other
keywords are the options of 'adasplats model'; lengths are in metres. Scales: (3,) factors of
neighbours, radius and error bound. device: 'auto', 'cpu', 'cuda'. progress: a function of (step:
str, done: int, total: int); total is 0 if unknown. The result depends only on the set of points,
not on their order or the number of threads. Model.report holds the report. Raises TypeError,
ValueError, OSError, RuntimeError (the GPU is missing; segment without OpenBLAS).)";

constexpr const char* kModelsClassDoc = R"(A scene as oriented disks (splats).

centers: (N, 3), world coordinates, m. normals: (N, 3), unit vectors. radii: (N,), m, > 0. classes:
(N,) integers from 0 to 65535. intensities: (N,), NaN if unknown. labels: a name or file as in
label_scheme(). origin: as in PointCloud. Arrays are read-only views without a copy (centers,
normals and radii are strided). Raises TypeError, ValueError.)";

struct ModelArguments {
  ModelJob job;
  MethodChoice method;
  WorkOptions work{.has_seed = true};

  void take(Keywords& keywords) {
    keywords.take("labels", job.labels);
    take_settings(keywords, job.segment);
    take_settings(keywords, job.draft);
    take_settings(keywords, method);
    keywords.take<DynamicRemoval>("remove", job.build.remove, kDynamicRemovals);
    keywords.take("reflectance", job.build.reflectances);
    take_settings(keywords, job.calibration);
    take_load_options(keywords, job.load);
    work.take(keywords);
  }
};

std::shared_ptr<ModelObject> finished(std::pair<SplatModel, ModelResult>&& made) {
  auto object = std::make_shared<ModelObject>();
  object->model = std::move(made.first);
  object->report = python_of(to_json(made.second));
  return object;
}

std::shared_ptr<ModelObject> model(py::handle points, const py::kwargs& kwargs) {
  auto arguments = arguments_of<ModelArguments>("model", kwargs);
  ModelJob& job = arguments.job;
  reject_unused(unused_settings(job.draft, arguments.method), kwargs);
  reject_unused(unused_settings(arguments.method), kwargs);
  reject_unused(unused_settings(job.segment), kwargs);
  job.build.recipe = arguments.method.recipe();
  job.removal_is_asked = kwargs.contains("remove");
  job.build.trust_origins = job.load.trust_origins;
  const bool in_memory = py::isinstance<PointCloud>(points);
  if (!in_memory) job.inputs = paths_of(points, "points", "a PointCloud, ");
  const auto cloud =
      in_memory ? points.cast<std::shared_ptr<PointCloud>>() : std::shared_ptr<PointCloud>();
  Work work(arguments.work);
  return finished(work.run([&](Session& session) {
    return in_memory ? make_model(*cloud, job, session) : make_model(job, session);
  }));
}

void add_disks(SplatModel& model, LocalVectors&& centers, const Rows& normals,
               const std::vector<double>& radii) {
  model.origin = centers.origin;
  model.disks.resize(radii.size());
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const Vec3d normal = normals.vector(i);
    if (!(std::fabs(length(normal) - 1) <= 1e-3))
      throw py::value_error("normals: row " + std::to_string(i) + " is not of unit length");
    const auto radius = static_cast<float>(radii[i]);
    if (!(radius > 0))
      throw py::value_error("radii[" + std::to_string(i) + "] is not greater than 0");
    model.disks[i] = {centers.vectors[i], radius, vec_cast<float>(normal)};
  }
}

std::shared_ptr<ModelObject> make_object(py::handle centers, py::handle normals, py::handle radii,
                                         py::handle classes, py::handle intensities,
                                         const std::optional<std::string>& labels,
                                         py::handle origin) {
  auto object = std::make_shared<ModelObject>();
  LocalVectors local = local_vectors(Rows(centers, 3, "centers"), origin);
  const std::size_t count = local.vectors.size();
  const Rows normal_rows(normals, 3, "normals");
  if (normal_rows.size() != count)
    throw py::value_error("normals: expected shape (" + std::to_string(count) + ", 3)");
  normal_rows.require_finite();
  if (radii.is_none()) throw py::type_error("radii: expected an array of numbers, got None");
  SplatModel& model = object->model;
  add_disks(model, std::move(local), normal_rows, numbers_of(radii, count, "radii"));
  model.classes = whole_numbers_of<std::uint16_t>(classes, count, "classes");
  const std::vector<double> measured =
      numbers_of(intensities, count, "intensities", NotANumber::is_unknown);
  model.intensities.assign(measured.begin(), measured.end());
  model.label_scheme = labels.value_or("");
  model.method = "arrays";
  return object;
}

std::shared_ptr<ModelObject> load_model_object(py::handle path) {
  const std::filesystem::path file = path_of(path, "path");
  auto object = std::make_shared<ModelObject>();
  const py::gil_scoped_release released;
  object->model = load_splats(file);
  return object;
}

void save_model(const ModelObject& object, py::handle path) {
  const std::filesystem::path file = path_of(path, "path");
  require_ending(file, ".ply");
  const py::gil_scoped_release released;
  save_model(file, object.model);
}

const SplatModel& model_of(const py::object& self) { return self.cast<const ModelObject&>().model; }

constexpr auto kDiskStride = static_cast<py::ssize_t>(sizeof(Disk));
const Disk kNoDisk;

const Disk* first_disk(const SplatModel& model) {
  return model.disks.empty() ? &kNoDisk : model.disks.data();
}

py::object groups(const py::object& self) {
  const SplatModel& model = model_of(self);
  if (model.groups.empty()) return py::none();
  static_assert(sizeof(SemanticGroup) == 1);
  return array_view(py::dtype::of<std::uint8_t>(), model.groups.data(),
                    {static_cast<py::ssize_t>(model.groups.size())}, {1}, self);
}

py::object colors_of_splats(const py::object& self) {
  const SplatModel& model = model_of(self);
  if (model.colors.empty()) return py::none();
  return array_view(py::dtype::of<std::uint8_t>(), model.colors.data(),
                    {static_cast<py::ssize_t>(model.colors.size()), 3}, {3, 1}, self);
}

py::object response(const py::object& self) {
  const IntensityResponse& response = model_of(self).response;
  if (response.empty()) return py::none();
  py::dict tables;
  tables["ranges_m"] = array_view(response.ranges_m, self);
  tables["range_gains"] = array_view(response.range_gains, self);
  tables["cos_incidences"] = array_view(response.cos_incidences, self);
  tables["incidence_gains"] = array_view(response.incidence_gains, self);
  return tables;
}

py::array world_bounds(const ModelObject& object) {
  const auto [low, high] = bounds(object.model);
  py::array_t<double> box({2, 3});
  for (int axis = 0; axis < 3; ++axis) {
    box.mutable_at(0, axis) = object.model.origin[axis] + static_cast<double>(low[axis]);
    box.mutable_at(1, axis) = object.model.origin[axis] + static_cast<double>(high[axis]);
  }
  return box;
}

using ModelClass = py::class_<ModelObject, std::shared_ptr<ModelObject>>;

void add_arrays(ModelClass& type) {
  type.def_property_readonly(
          "centers",
          [](const py::object& self) {
            const SplatModel& model = model_of(self);
            return vectors_view(&first_disk(model)->center, model.size(), sizeof(Disk), self);
          },
          "(N, 3) float32, m, relative to origin.")
      .def_property_readonly(
          "normals",
          [](const py::object& self) {
            const SplatModel& model = model_of(self);
            return vectors_view(&first_disk(model)->normal, model.size(), sizeof(Disk), self);
          },
          "(N, 3) float32, unit vectors.")
      .def_property_readonly(
          "radii",
          [](const py::object& self) {
            const SplatModel& model = model_of(self);
            return array_view(py::dtype::of<float>(), &first_disk(model)->radius,
                              {static_cast<py::ssize_t>(model.size())}, {kDiskStride}, self);
          },
          "(N,) float32, m.")
      .def_property_readonly(
          "opacities",
          [](const py::object& self) {
            return optional_view(model_of(self).opacities, model_of(self).size(), self);
          },
          "(N,) float32: probability that a ray through the centre stops; None: opaque disks.")
      .def_property_readonly(
          "drop_log_odds",
          [](const py::object& self) {
            return optional_view(model_of(self).drop_log_odds, model_of(self).size(), self);
          },
          "(N,) float32: by how much the log odds of losing a return exceed those of other splats "
          "at "
          "the same range and incidence; None: not measured.")
      .def_property_readonly(
          "classes",
          [](const py::object& self) {
            return optional_view(model_of(self).classes, model_of(self).size(), self);
          },
          "(N,) uint16, ids of the label scheme, or None.")
      .def_property_readonly(
          "groups", &groups,
          "(N,) uint8: 0 ground, 1 surface, 2 linear, 3 non-surface; None for basic splats.")
      .def_property_readonly(
          "intensities",
          [](const py::object& self) {
            return optional_view(model_of(self).intensities, model_of(self).size(), self);
          },
          "(N,) float32: reflectances if there is a response, else as measured; or None.")
      .def_property_readonly("colors", &colors_of_splats,
                             "(N, 3) uint8, sRGB of the points, or None.");
}

void add_properties(ModelClass& type) {
  type.def_property_readonly(
          "origin", [](const ModelObject& o) { return array_of(o.model.origin); },
          "(3,) float64, world coordinates of the local origin, m.")
      .def_property_readonly(
          "bounds", &world_bounds,
          "(2, 3) float64: minimum and maximum world coordinates of the disks, m.")
      .def_property_readonly(
          "labels", [](const ModelObject& o) { return o.model.label_scheme; },
          "Name or path of the label scheme; empty: none.")
      .def_property_readonly(
          "network_sha256", [](const ModelObject& o) { return o.model.network_sha256; },
          "SHA-256 of the file of the network that predicted the classes; empty: none.")
      .def_property_readonly(
          "method", [](const ModelObject& o) { return o.model.method; },
          "The method that made the model.")
      .def_property_readonly(
          "response", &response,
          "Intensity as a function of range and incidence: a dict of float32 arrays "
          "ranges_m, range_gains, cos_incidences, incidence_gains; or None.")
      .def_property_readonly(
          "report", [](const ModelObject& o) { return o.report; },
          "Report of model(), with the keys of 'adasplats model --report'; None if loaded.");
}

}  // namespace

void bind_models(py::module_& module) {
  ModelClass type(module, "Model", kModelsClassDoc);
  type.def(py::init(&make_object), py::arg("centers"), py::arg("normals"), py::arg("radii"),
           py::kw_only(), py::arg("classes") = py::none(), py::arg("intensities") = py::none(),
           py::arg("labels") = py::none(), py::arg("origin") = py::none(),
           documented("__init__",
                      "self, centers, normals, radii, *, classes=None, intensities=None, "
                      "labels=None, origin=None",
                      "See the class.")
               .c_str());
  type.def("__len__", [](const ModelObject& o) { return o.model.size(); });
  type.def("__repr__", [](const ModelObject& o) {
    return "<adasplats.Model of " + std::to_string(o.model.size()) + " splats>";
  });
  type.def_static("load", &load_model_object, py::arg("path"),
                  documented("load", "path",
                             "Read a PLY of splats: x y z nx ny nz radius and optional columns.\n"
                             "Raises TypeError, FileNotFoundError, ValueError.")
                      .c_str());
  type.def("save", &save_model, py::arg("path"),
           documented("save", "self, path",
                      "Write a .ply; no partial file remains after an error.\n"
                      "Raises TypeError, OSError, ValueError (another extension).")
               .c_str());
  add_arrays(type);
  add_properties(type);
  add_crs(type, [](const ModelObject& o) -> const Crs& { return o.model.crs; });
  add_pickling<ModelObject>(type, "Model");
  module.def("model", &model, py::arg("points"),
             documented<ModelArguments>("model", "points", kModelDoc).c_str());
}

}  // namespace adasplats::python
