// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "adasplats/cloud/labels/label_scheme.h"
#include "arrays.h"
#include "bindings.h"
#include "clouds.h"
#include "pickles.h"

namespace adasplats::python {
namespace {

const char* word_of(Mobility mobility) {
  switch (mobility) {
    case Mobility::fixed: return "fixed";
    case Mobility::movable: return "movable";
    case Mobility::moving: return "moving";
  }
  return "";
}

/// One value per class.
template <class F>
py::list of_classes(const LabelScheme& scheme, F&& f) {
  py::list values;
  for (const SemanticClass& c : scheme.classes()) values.append(f(c));
  return values;
}

py::array ids(const LabelScheme& scheme) {
  std::vector<std::uint16_t> values;
  for (const SemanticClass& c : scheme.classes()) values.push_back(c.id);
  const auto count = static_cast<py::ssize_t>(values.size());
  return owned_array(std::move(values), {count});
}

py::array colors(const LabelScheme& scheme) {
  std::vector<std::uint8_t> values;
  for (const SemanticClass& c : scheme.classes())
    values.insert(values.end(), c.rgb.begin(), c.rgb.end());
  const auto count = static_cast<py::ssize_t>(values.size()) / 3;
  return owned_array(std::move(values), {count, 3});
}

const SemanticClass& class_of_name(const LabelScheme& scheme, const std::string& name) {
  const SemanticClass* const found = scheme.find(std::string_view(name));
  if (found == nullptr) throw py::key_error(scheme.name() + " has no class '" + name + "'");
  return *found;
}

using ClassFields =
    std::tuple<std::uint16_t, std::string, int, int, std::array<std::uint8_t, 3>, bool>;
constexpr const char* kPickled = "adasplats.LabelScheme";

/// A scheme cannot be empty, so all fields are read before it is made.
py::object pickle_of(const LabelScheme& scheme) {
  std::vector<ClassFields> classes;
  for (const SemanticClass& c : scheme.classes())
    classes.emplace_back(c.id, c.name, static_cast<int>(c.group), static_cast<int>(c.mobility),
                         c.rgb, c.is_noise);
  py::dict fields;
  fields["name"] = scheme.name();
  fields["classes"] = py::cast(classes);
  return py::make_tuple(kPickled, kPickleVersion, fields);
}

std::shared_ptr<LabelScheme> scheme_of_pickle(const py::object& pickle) {
  const py::dict fields = fields_of_pickle(kPickled, pickle);
  if (!fields.contains("name") || !fields.contains("classes"))
    wrong_pickle(kPickled, "lacks a field");
  std::vector<SemanticClass> classes;
  for (const auto& [id, name, group, mobility, rgb, is_noise] :
       fields["classes"].cast<std::vector<ClassFields>>())
    classes.push_back({id, name, static_cast<SemanticGroup>(group), static_cast<Mobility>(mobility),
                       rgb, is_noise});
  return std::make_shared<LabelScheme>(fields["name"].cast<std::string>(), std::move(classes));
}

}  // namespace

void bind_labels(py::module_& module) {
  py::class_<LabelScheme, std::shared_ptr<LabelScheme>> type(
      module, "LabelScheme", "Names and properties of semantic classes, made by label_scheme().");
  type.def_property_readonly("name", &LabelScheme::name, "Name of the scheme.")
      .def_property_readonly("ids", &ids, "(C,) uint16, ids of the classes, ascending.")
      .def_property_readonly(
          "names",
          [](const LabelScheme& s) {
            return of_classes(s, [](const SemanticClass& c) { return py::str(c.name); });
          },
          "Names of the classes, in the order of ids.")
      .def_property_readonly(
          "groups",
          [](const LabelScheme& s) {
            return of_classes(s, [](const SemanticClass& c) {
              return py::str(std::string(adasplats::name_of(c.group)));
            });
          },
          "'ground', 'surface', 'linear' or 'non-surface', in the order of ids.")
      .def_property_readonly(
          "mobilities",
          [](const LabelScheme& s) {
            return of_classes(s,
                              [](const SemanticClass& c) { return py::str(word_of(c.mobility)); });
          },
          "'fixed', 'movable' or 'moving', in the order of ids.")
      .def_property_readonly("colors", &colors, "(C, 3) uint8, RGB, in the order of ids.")
      .def("__len__", [](const LabelScheme& s) { return s.classes().size(); })
      .def("__repr__",
           [](const LabelScheme& s) {
             return "<adasplats.LabelScheme '" + s.name() + "' of " +
                    std::to_string(s.classes().size()) + " classes>";
           })
      .def(
          "id_of",
          [](const LabelScheme& s, const std::string& name) { return class_of_name(s, name).id; },
          py::arg("name"),
          documented("id_of", "self, name", "The id of a class. Raises KeyError.").c_str());
  type.def(py::pickle(&pickle_of, &scheme_of_pickle));
  module.def(
      "label_scheme",
      [](py::handle name_or_path) {
        return std::make_shared<LabelScheme>(
            load_label_scheme(path_of(name_or_path, "name_or_path").string()));
      },
      py::arg("name_or_path"),
      documented(
          "label_scheme", "name_or_path",
          "Load a label scheme: 'semantickitti', 'paris-carla-3d' or the path of a TOML file\n"
          "(docs/formats.md). Raises TypeError, FileNotFoundError, ValueError.")
          .c_str());
}

}  // namespace adasplats::python
