// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <memory>

#include "adasplats/jobs/output/output_check.h"
#include "adasplats/splats/model/mesh_model.h"
#include "bindings.h"
#include "clouds.h"
#include "crs.h"
#include "pickles.h"

namespace adasplats {

template <class Archive>
void fields(Archive& archive, MeshModel& model) {
  archive("origin", model.origin);
  archive("crs", model.crs);
  archive("vertices", model.mesh.vertices);
  archive("triangles", model.mesh.triangles);
  archive("classes", model.mesh.classes);
  archive("label_scheme", model.label_scheme);
  archive("method", model.method);
}

}  // namespace adasplats

namespace adasplats::python {
namespace {

constexpr const char* kMeshesDoc = R"(A scene as triangles.

vertices: (V, 3), world coordinates, m. triangles: (T, 3) integers, vertex indices. classes: (T,)
integers from 0 to 65535. labels: a name or file as in label_scheme(). origin: as in PointCloud.
Arrays are read-only views without a copy. Raises TypeError, ValueError.)";

std::vector<std::array<std::uint32_t, 3>> triangles_of(py::handle value, std::size_t vertices) {
  const py::array flat = py::array::ensure(value);
  if (!flat) throw py::type_error("triangles: expected an array of integers");
  if (flat.size() > 0 && (flat.ndim() != 2 || flat.shape(1) != 3))
    throw py::value_error("triangles: expected shape (T, 3)");
  const auto count = static_cast<std::size_t>(flat.size());
  const std::uint64_t last = vertices == 0 ? 0 : vertices - 1;
  const auto corners =
      whole_numbers_of(flat.attr("reshape")(-1), count, last, "triangles (row by row)");
  std::vector<std::array<std::uint32_t, 3>> triangles(count / 3);
  for (std::size_t i = 0; i < count; ++i)
    triangles[i / 3][i % 3] = static_cast<std::uint32_t>(corners[i]);
  return triangles;
}

std::shared_ptr<MeshModel> make_mesh(py::handle vertices, py::handle triangles, py::handle classes,
                                     const std::optional<std::string>& labels, py::handle origin) {
  auto model = std::make_shared<MeshModel>();
  LocalVectors local = local_vectors(Rows(vertices, 3, "vertices"), origin);
  model->origin = local.origin;
  model->mesh.vertices = std::move(local.vectors);
  model->mesh.triangles = triangles_of(triangles, model->mesh.vertices.size());
  if (model->mesh.vertices.empty() && model->size() > 0)
    throw py::value_error("triangles: there are no vertices");
  model->mesh.classes = whole_numbers_of<std::uint16_t>(classes, model->size(), "classes");
  model->label_scheme = labels.value_or("");
  model->method = "arrays";
  return model;
}

std::shared_ptr<MeshModel> load_mesh_object(py::handle path) {
  const std::filesystem::path file = path_of(path, "path");
  const py::gil_scoped_release released;
  return std::make_shared<MeshModel>(load_mesh(file));
}

void save_mesh(const MeshModel& model, py::handle path) {
  const std::filesystem::path file = path_of(path, "path");
  require_ending(file, ".ply");
  const py::gil_scoped_release released;
  save_mesh(file, model);
}

py::array triangle_view(const py::object& self) {
  const auto& triangles = self.cast<const MeshModel&>().mesh.triangles;
  return array_view(py::dtype::of<std::uint32_t>(), triangles.data(),
                    {static_cast<py::ssize_t>(triangles.size()), 3}, {12, 4}, self);
}

}  // namespace

void bind_meshes(py::module_& module) {
  const std::string init_doc =
      documented("__init__", "self, vertices, triangles, *, classes=None, labels=None, origin=None",
                 "See the class.");
  py::class_<MeshModel, std::shared_ptr<MeshModel>> type(module, "Mesh", kMeshesDoc);
  type.def(py::init(&make_mesh), py::arg("vertices"), py::arg("triangles"), py::kw_only(),
           py::arg("classes") = py::none(), py::arg("labels") = py::none(),
           py::arg("origin") = py::none(), init_doc.c_str())
      .def_static(
          "load", &load_mesh_object, py::arg("path"),
          documented(
              "load", "path",
              "Read a PLY, OBJ or glTF 2.0. Raises TypeError, FileNotFoundError,\nValueError.")
              .c_str())
      .def("save", &save_mesh, py::arg("path"),
           documented("save", "self, path",
                      "Write a .ply; no partial file remains after an error.\n"
                      "Raises TypeError, OSError, ValueError (another extension).")
               .c_str())
      .def("__len__", &MeshModel::size)
      .def("__repr__",
           [](const MeshModel& m) {
             return "<adasplats.Mesh of " + std::to_string(m.size()) + " triangles>";
           })
      .def_property_readonly(
          "vertices",
          [](const py::object& self) {
            return array_view(self.cast<const MeshModel&>().mesh.vertices, self);
          },
          "(V, 3) float32, m, relative to origin.")
      .def_property_readonly("triangles", &triangle_view, "(T, 3) uint32, vertex indices.")
      .def_property_readonly(
          "classes",
          [](const py::object& self) {
            const auto& model = self.cast<const MeshModel&>();
            return optional_view(model.mesh.classes, model.size(), self);
          },
          "(T,) uint16, ids of the label scheme, or None.")
      .def_property_readonly(
          "origin", [](const MeshModel& m) { return array_of(m.origin); },
          "(3,) float64, world coordinates of the local origin, m.")
      .def_readonly("labels", &MeshModel::label_scheme,
                    "Name or path of the label scheme; empty: none.");
  add_crs(type, [](const MeshModel& m) -> const Crs& { return m.crs; });
  add_pickling<MeshModel>(type, "Mesh");
}

}  // namespace adasplats::python
