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
    "Give points semantic classes by a network (kernel point convolutions, KPConv).\n\n"
    "points: a PointCloud. network: a file; None: the one that comes with adasplats. tile: side\n"
    "of the squares that are looked at one after the other, m; margin: how much around each is\n"
    "looked at, too, m. intensity: the points' intensities are used, where they have some.\n"
    "device: 'auto', 'cpu', 'cuda'. Gives (N,) uint16, ids of the label scheme 'semantickitti',\n"
    "in the order of the points; with confidences a tuple of these and (N,) float32, 0 to 1.\n"
    "Both are new arrays. The same on any number of threads. Raises TypeError, ValueError (what\n"
    "is in the file), OSError, RuntimeError (built without OpenBLAS).";

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
  Keywords keywords("segment", kwargs);
  SegmentCall call;
  call.take(keywords);
  keywords.finish();
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
  const std::string doc = documented(
      "segment", "points", [](Keywords& keywords) { SegmentCall().take(keywords); }, kSegmentDoc);
  module.def("segment", &segment, py::arg("points"), doc.c_str());
}

}  // namespace adasplats::python
