// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/point_classes.h"
#include "adasplats/jobs/segment/segment.h"
#include "arrays.h"
#include "bindings.h"
#include "work.h"

namespace adasplats::python {
namespace {

constexpr const char* kSegmentDoc =
    R"(Predict semantic classes of points with a network (kernel point convolutions, KPConv).

points: a PointCloud. network: a file; None: the one that comes with adasplats. tile: side of the
squares that are processed one by one, m. margin: width of the surroundings that the network also
sees, m. intensity: use the intensities of the points, if any. device: 'auto', 'cpu', 'cuda'.
Returns (N,) uint16, ids of the label scheme 'semantickitti' in the order of the points; with
confidences, a tuple of them and (N,) float32 from 0 to 1. Both are new arrays. The result does not
depend on the number of threads. Raises TypeError, ValueError (wrong content of the network file),
OSError, RuntimeError (built without OpenBLAS).)";

struct SegmentCall {
  std::filesystem::path network;
  SegmentOptions options;
  WorkOptions work;

  void take(Keywords& keywords) {
    keywords.take("network", network);
    take_settings(keywords, options);
    keywords.take("confidences", options.confidences);
    work.take(keywords);
  }
};

template <class T>
py::array array_of_points(std::vector<T>&& values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return owned_array(std::move(values), {count});
}

py::object segment(const std::shared_ptr<PointCloud>& points, const py::kwargs& kwargs) {
  const auto call = arguments_of<SegmentCall>("segment", kwargs);
  Work work(call.work);
  PointClasses found = work.run([&](Session& session) {
    check_settings(call.options);
    return PointClassifier(call.network).classes_of(*points, call.options, session);
  });
  py::object ids = array_of_points(std::move(found.ids));
  if (!call.options.confidences) return ids;
  return py::make_tuple(std::move(ids), array_of_points(std::move(found.confidences)));
}

}  // namespace

void bind_segmentation(py::module_& module) {
  module.def("segment", &segment, py::arg("points"),
             documented<SegmentCall>("segment", "points", kSegmentDoc).c_str());
}

}  // namespace adasplats::python
