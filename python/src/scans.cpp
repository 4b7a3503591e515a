// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "scans.h"

#include <pybind11/stl.h>

#include <algorithm>

#include "adasplats/core/error.h"
#include "adasplats/core/executor.h"
#include "adasplats/dataset/parallel_scan_writer.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/scan_writer.h"
#include "clouds.h"
#include "pickles.h"

namespace adasplats {

template <class Archive>
void fields(Archive& archive, Scan& scan) {
  archive("world_from_sensor", scan.world_from_sensor);
  archive("time_s", scan.time_s);
  archive("knots", scan.knots);
  archive("duration_s", scan.duration_s);
  archive("frame", scan.frame);
  archive("rays", scan.rays);
  archive("positions", scan.positions);
  for_each_scan_attribute(
      [&](const auto& attribute) { archive(attribute.name, attribute.of(scan)); });
}

}  // namespace adasplats

namespace adasplats::python {

/// The scans and the labels are Python objects, which pickle themselves.
static void fields(FieldWriter& archive, ScanList& list) {
  py::object scans = py::cast(list.scans);
  py::object labels = py::none();
  if (list.labels) labels = py::cast(std::make_shared<LabelScheme>(*list.labels));
  archive("scans", scans);
  archive("image_size", list.image_size);
  archive("labels", labels);
}

static void fields(FieldReader& archive, ScanList& list) {
  py::object scans;
  py::object labels;
  archive("scans", scans);
  archive("image_size", list.image_size);
  archive("labels", labels);
  list.scans = scans.cast<std::vector<std::shared_ptr<Scan>>>();
  if (!labels.is_none()) list.labels = labels.cast<std::shared_ptr<LabelScheme>>();
}

namespace {

constexpr const char* kScanDoc =
    R"(The returns of one revolution of a LiDAR, in firing order. Arrays are read-only views without a copy;
attributes that the scene lacks are None.)";

constexpr const char* kSaveDoc = R"(Write the scans into a folder, which is created if missing.

format: 'semantickitti' (FOLDER/sequences/00), 'ply', 'npy', 'npz', 'pcd', 'las', 'laz',
'range-image', 'mcap' (FOLDER/scans.mcap), 'kitti-raw', 'pandaset', 'nuscenes' or 'argoverse2':
docs/formats.md.
point_order (formats of data sets): 'kitti', as in their own files, or 'firing', as in Scan.
Raises TypeError, OSError, ValueError.)";

/// Adds a property for an attribute, None if a scan lacks it.
template <class Attribute>
void bind_attribute(py::class_<Scan, std::shared_ptr<Scan>>& type, const Attribute& attribute) {
  const auto of = attribute.of;
  const bool is_optional = attribute.is_optional;
  using Value = typename std::decay_t<decltype(of(std::declval<const Scan&>()))>::value_type;
  type.def_property_readonly(
      attribute.name,
      [of, is_optional](const py::object& self) -> py::object {
        const auto& scan = self.cast<const Scan&>();
        if (is_optional) return optional_view(of(scan), scan.size(), self);
        return array_view(of(scan), self);
      },
      (shape_and_type<Value>() + attribute.about + (is_optional ? "; or None." : ".")).c_str());
}

void bind_scan(py::module_& module) {
  py::class_<Scan, std::shared_ptr<Scan>> type(module, "Scan", kScanDoc);
  type.def("__len__", &Scan::size)
      .def("__repr__",
           [](const Scan& scan) {
             return "<adasplats.Scan of " + std::to_string(scan.size()) + " points>";
           })
      .def_property_readonly("positions", view_getter(&Scan::positions),
                             "(N, 3) float32, m, in the sensor's frame.")
      .def_property_readonly(
          "pose", [](const Scan& scan) { return matrix_of(scan.world_from_sensor); },
          "(4, 4) float64, world_from_sensor.")
      .def_readonly("time", &Scan::time_s,
                    "Time of the pose, s: the middle of the revolution if the sensor moves.")
      .def_property_readonly(
          "begin", [](const Scan& scan) { return ScanView(scan).begin_s(); },
          "Start of the revolution, s: the zero of times. The same as time if the sensor does\n"
          "not move.")
      .def_readonly("rays", &Scan::rays, "Number of firings in the revolution.");
  for_each_scan_attribute([&](const auto& attribute) { bind_attribute(type, attribute); });
  add_pickling<Scan>(type, "Scan");
}

std::shared_ptr<Scan> scan_at(const ScanList& list, py::ssize_t index) {
  const auto count = static_cast<py::ssize_t>(list.scans.size());
  if (index < 0) index += count;
  if (index < 0 || index >= count) throw py::index_error("scan index out of range");
  return list.scans[static_cast<std::size_t>(index)];
}

ScanList scans_of(const ScanList& list, const py::slice& slice) {
  std::size_t start = 0, stop = 0, step = 0, count = 0;
  if (!slice.compute(list.scans.size(), &start, &stop, &step, &count))
    throw py::error_already_set();
  ScanList part{{}, list.image_size, list.labels};
  for (std::size_t k = 0; k < count; ++k) part.scans.push_back(list.scans[start + k * step]);
  return part;
}

struct SaveArguments {
  ScanFormat format = ScanFormat::semantickitti;
  ScanWriterOptions writing;

  void take(Keywords& keywords) {
    keywords.take<ScanFormat>("format", format, kScanFormats);
    keywords.take<PointOrder>("point_order", writing.order, kPointOrders);
  }
};

void save_scans(const ScanList& list, py::handle folder, const py::kwargs& kwargs) {
  auto [format, writing] = arguments_of<SaveArguments>("save", kwargs);
  const std::filesystem::path path = path_of(folder, "folder");
  if (format == ScanFormat::pcap)
    throw Error(ErrorKind::usage,
                "packets need the sensor that measured the scans; use 'adasplats simulate --format "
                "pcap'");
  const py::gil_scoped_release released;
  std::filesystem::create_directories(path);
  writing.image_size = list.image_size;
  writing.labels = list.labels.get();
  writing.drive = {list.scans.size(), [&](std::size_t i) { return list.scans[i]->time_s; }};
  if (!list.scans.empty()) writing.drive.turn_s = list.scans.front()->duration_s;
  if (format == ScanFormat::argoverse2) {
    float highest = 0;
    for (const auto& scan : list.scans)
      for (const float value : scan->intensities) highest = std::max(highest, value);
    writing.full_intensity = intensity_scale_for(double{highest});
  }
  const auto writer = make_scan_writer(path, format, writing);
  const Executor executor;
  ParallelWriteOptions parallel;
  parallel.threads = executor.threads();
  ParallelScanWriter files(*writer, parallel);
  for (std::size_t i = 0; i < list.scans.size(); ++i)
    files.write(i, {*list.scans[i], list.scans[i]});
  files.finish();
}

}  // namespace

void bind_scans(py::module_& module) {
  bind_scan(module);
  py::class_<ScanList, std::shared_ptr<ScanList>> type(
      module, "Scans", "The scans of one drive: a sequence of Scan, made by Scene.simulate().");
  type.def("__len__", [](const ScanList& list) { return list.scans.size(); })
      .def("__getitem__", &scan_at, py::arg("index"), "One scan; a slice gives Scans.")
      .def("__getitem__", &scans_of, py::arg("slice"))
      .def(
          "__iter__",
          [](const py::object& self) {
            return py::reinterpret_steal<py::object>(PySeqIter_New(self.ptr()));
          },
          "Scan by scan.")
      .def("__repr__",
           [](const ScanList& list) {
             return "<adasplats.Scans: " + std::to_string(list.scans.size()) + ">";
           })
      .def("save", &save_scans, py::arg("folder"),
           documented<SaveArguments>("save", "self, folder", kSaveDoc).c_str());
  add_pickling<ScanList>(type, "Scans");
}

}  // namespace adasplats::python
