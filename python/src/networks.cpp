// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <memory>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/segment/network/run_network.h"
#include "arrays.h"
#include "bindings.h"
#include "clouds.h"
#include "work.h"

namespace adasplats::python {
namespace {

std::vector<Vec3f> points_of(const Rows& rows) {
  rows.require_finite();
  std::vector<Vec3f> points;
  points.reserve(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) points.push_back(vec_cast<float>(rows.vector(i)));
  return points;
}

std::vector<float> numbers_of(const Rows& rows, std::size_t columns) {
  std::vector<float> numbers;
  numbers.reserve(rows.size() * columns);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t c = 0; c < columns; ++c) numbers.push_back(static_cast<float>(rows.at(i, c)));
  return numbers;
}

py::array logits_of(const Network& network, py::handle points, py::handle features, int threads) {
  const Rows point_rows(points, 3, "points");
  const std::size_t width = network.features.size();
  const Rows feature_rows(features, static_cast<py::ssize_t>(width), "features");
  if (feature_rows.size() != point_rows.size())
    throw py::value_error("features: " + std::to_string(feature_rows.size()) + " rows, " +
                          std::to_string(point_rows.size()) + " points");
  std::vector<Vec3f> means = points_of(point_rows);
  std::vector<float> numbers = numbers_of(feature_rows, width);
  const auto rows = static_cast<py::ssize_t>(means.size());
  const Executor executor(checked_threads(threads));
  std::vector<float> logits;
  {
    const py::gil_scoped_release released;
    const auto levels = make_pyramid(std::move(means), network.shape, executor);
    logits = run_network(network, levels, std::move(numbers), executor);
  }
  return owned_array(std::move(logits), {rows, static_cast<py::ssize_t>(network.classes.size())});
}

}  // namespace

void bind_networks(py::module_& module) {
  py::class_<Network, std::shared_ptr<Network>> type(
      module, "Network",
      "A network that predicts semantic classes of points.\n\n"
      "file: written by tools/segmentation/export.py; None: the one that comes with adasplats.\n"
      "Raises TypeError, FileNotFoundError, DataError.");
  type.def(py::init([](const py::object& file) {
             return std::make_shared<Network>(file.is_none() ? default_network()
                                                             : read_network(path_of(file, "file")));
           }),
           py::arg("file") = py::none(),
           documented("__init__", "self, file=None", "See the class.").c_str());
  type.def_property_readonly(
          "classes", [](const Network& network) { return network.classes; },
          "Names of the classes that it distinguishes.")
      .def_property_readonly(
          "card", [](const Network& network) { return network.card; },
          "Model card: its training data and its purpose.")
      .def_property_readonly(
          "cell_m", [](const Network& network) { return network.shape.cell_m; },
          "Side of the cells; the input points are the means of cells, m.")
      .def("__repr__",
           [](const Network& network) {
             return "<adasplats.Network of " + std::to_string(network.classes.size()) + " classes>";
           })
      .def("logits", &logits_of, py::arg("points"), py::arg("features"), py::kw_only(),
           py::arg("threads") = 0,
           documented("logits", "self, points, features, *, threads=0",
                      "Output of the network before the softmax: (N, C) float32.\n\n"
                      "points: (N, 3), m, the means of cells of cell_m. features: (N, F), in the\n"
                      "order of the network file. To check networks against PyTorch. Raises\n"
                      "TypeError, ValueError, UnavailableError (built without OpenBLAS).")
               .c_str());
}

}  // namespace adasplats::python
