// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/jobs/calibrate/calibrate.h"
#include "adasplats/jobs/compare/compare.h"
#include "adasplats/jobs/evaluate/fit_sensor.h"
#include "adasplats/jobs/export.h"
#include "adasplats/jobs/model/make_mesh.h"
#include "adasplats/jobs/scans/simkitti32.h"
#include "bindings.h"
#include "clouds.h"
#include "json.h"
#include "work.h"

namespace adasplats::python {
namespace {

constexpr const char* kMeshDoc =
    R"(Make a triangle mesh from points, as the paper does to compare meshes with splats.

points: a PointCloud, or a path or paths as in read(). labels: a name or a file as in
label_scheme(). method: 'imls' (implicit moving least squares) or 'poisson' (screened Poisson, run
by PoissonRecon from PATH or Open3D). neighbors: number of points per normal. imls: voxel (m), sigma
and truncation (voxels). poisson: depth, samples_per_node, trim and poisson_program. The other
keywords are those of read(). Raises TypeError, ValueError, OSError, RuntimeError (no program for
Poisson).)";

constexpr const char* kCalibrateDoc =
    R"(Estimate errors of poses and lasers from the points of a drive, and write the corrections.

inputs: SemanticKITTI sequence folders, and folders of scans with times (these need trajectory).
output: a folder to create; it receives report.html, report.json and, as far as estimated,
trajectory.csv, poses.txt, lasers.csv and sensor.toml (docs/formats.md). poses, ranges, elevations,
mount_correction: what to estimate. window_scans: length of the windows, scans. The other keywords
are those of read(). Returns report.json as a dict. Raises TypeError, ValueError (DataError if the
points show no clear error; the report is written nevertheless), OSError.)";

constexpr const char* kExportDoc =
    R"(Write a splat model, points or the scans of a sequence for other programs.

input: a splat model, a point file, a sequence folder or the output of simulate. format:
'gaussian-3d', 'gaussian-2d', 'glb', 'usd', 'ply', 'las', 'laz', 'pcd', 'csv' or 'mcap'; None: by the
extension of output; '3d-tiles', 'semantickitti', 'kitti-raw', 'nuscenes', 'pandaset' and 'argoverse2' create a
folder. color: 'class', 'intensity' or 'height'; None: the first of these that the input has. The
other keywords are those of read(). Returns a dict with the number of elements written,
points_dropped and bytes; of 3d-tiles also place, where they are on the Earth. Raises TypeError,
ValueError, OSError.)";

constexpr const char* kFitSensorDoc =
    R"(Calibrate one physical sensor from measured scans: intensities and missing returns.

model: path of a splat model of the same scene. scans: a sequence, or a folder with one file per
scan (this needs trajectory). output: the TOML file to write, for Sensor(). motion: poses of the
sensor during raw scans. Returns the report as a dict. Raises TypeError, ValueError (DataError if
the scans are of another scene), OSError.)";

constexpr const char* kSimKitti32Doc =
    R"(Make a labelled data set of another LiDAR from a SemanticKITTI sequence (paper section
"SimKITTI32").

sequence: a folder with labels. output: a folder to create; the same call resumes interrupted work.
offset: (3,) m, position of the sensor along the world axes. noise: of ranges, m. depth: number of
hits of a ray that are averaged. moving: also simulate moving objects. model: the static model;
None: made from the scans. rain, snow: mm/h. fog: visibility, m. Returns the report as a dict.
Raises TypeError, ValueError, OSError.)";

constexpr const char* kCompareDoc = R"(Compare all methods on the same data with the same rays.

data: the output of synth_street(), a SemanticKITTI folder or a point file. output: a folder for the
reports and intermediate files; the same call resumes interrupted work. methods: a list of names;
None: all that the data allow. meshes: existing meshes, {name: file}. Inputs that are None are
searched in data. time_limit (s) and memory_limit (GiB; 0: 90 % of the machine's) apply to each
step. program: the adasplats program that runs the steps; None: that of PATH. Returns compare.json
as a dict. Raises TypeError, ValueError, OSError (FileNotFoundError also if the program is missing).)";

struct MeshCall {
  MeshJob job;
  WorkOptions work;

  void take(Keywords& keywords) {
    keywords.take("labels", job.labels);
    take_settings(keywords, job);
    keywords.take<DynamicRemoval>("remove", job.remove, kDynamicRemovals);
    take_load_options(keywords, job.load);
    work.has_device = false;
    work.take(keywords);
  }
};

std::shared_ptr<MeshModel> mesh(py::handle points, const py::kwargs& kwargs) {
  auto call = arguments_of<MeshCall>("mesh", kwargs);
  reject_unused(unused_settings(call.job), kwargs);
  call.job.removal_is_asked = kwargs.contains("remove");
  const bool in_memory = py::isinstance<PointCloud>(points);
  if (!in_memory) call.job.inputs = paths_of(points, "points", "a PointCloud, ");
  const auto cloud =
      in_memory ? points.cast<std::shared_ptr<PointCloud>>() : std::shared_ptr<PointCloud>();
  Work work(call.work);
  return work.run([&](Session& session) {
    return std::make_shared<MeshModel>(
        (in_memory ? make_mesh(*cloud, call.job, session) : make_mesh(call.job, session)).first);
  });
}

struct CalibrateCall {
  CalibrateJob job;
  WorkOptions work;

  void take(Keywords& keywords) {
    take_settings(keywords, job.calibrate);
    take_settings(keywords, job.windows);
    take_load_options(keywords, job.load);
    keywords.take("overwrite", job.overwrite);
    work.take(keywords);
  }
};

py::object calibrate_drive(py::handle inputs, py::handle output, const py::kwargs& kwargs) {
  auto call = arguments_of<CalibrateCall>("calibrate", kwargs);
  call.job.inputs = paths_of(inputs, "inputs");
  call.job.output = path_of(output, "output");
  Work work(call.work);
  return python_of(
      work.run([&](Session& session) { return to_json(run_calibrate(call.job, session)); }));
}

struct ExportCall {
  ExportJob job;
  WorkOptions work;

  void take(Keywords& keywords) {
    keywords.take<ExportFormat>("format", job.format, kExportFormats);
    keywords.take("labels", job.labels);
    keywords.take<ExportColor>("color", job.color, kExportColors);
    take_load_options(keywords, job.load);
    work.has_device = false;
    work.take(keywords);
  }
};

/// The first given keyword for loading points or scans; empty: none.
std::string load_keyword(const py::kwargs& given) {
  for (const auto& [name, value] : given) {
    auto word = name.cast<std::string>();
    const bool is_other = word == "format" || word == "labels" || word == "color" ||
                          word == "threads" || word == "progress";
    if (!is_other) return word;
  }
  return "";
}

py::dict export_file(py::handle input, py::handle output, const py::kwargs& kwargs) {
  auto call = arguments_of<ExportCall>("export", kwargs);
  call.job.cloud_option = load_keyword(kwargs);
  call.job.input = path_of(input, "input");
  call.job.output = path_of(output, "output");
  Work work(call.work);
  const ExportResult result =
      work.run([&](Session& session) { return run_export(call.job, session); });
  py::dict report;
  report[result.unit] = result.count;
  report["points_dropped"] = result.dropped;
  report["bytes"] = result.written_bytes;
  if (!result.place.empty()) report["place"] = result.place;
  return report;
}

struct SimKitti32Call {
  SimKitti32Job job;
  WorkOptions work;

  void take(Keywords& keywords) {
    keywords.take("sensor", job.sensor);
    keywords.take("labels", job.labels);
    take_scan_range(keywords, job.scans);
    take_settings(keywords, job);
    keywords.take("model", job.model);
    keywords.take("ray_drop", job.ray_drop);
    keywords.take("overwrite", job.overwrite);
    work.has_seed = true;
    work.take(keywords);
  }
};

py::object simkitti32(py::handle sequence, py::handle output, const py::kwargs& kwargs) {
  auto call = arguments_of<SimKitti32Call>("simkitti32", kwargs);
  reject_unused(unused_settings(call.job), kwargs);
  call.job.sequence = path_of(sequence, "sequence");
  call.job.output = path_of(output, "output");
  Work work(call.work);
  return python_of(work.run([&](Session& session) {
    return to_json(run_simkitti32(call.job, session), load_label_scheme(call.job.labels));
  }));
}

struct FitSensorCall {
  FitSensorJob job;
  WorkOptions work;

  void take(Keywords& keywords) {
    take_scan_range(keywords, job.scans);
    keywords.take("motion", job.motion);
    keywords.take("trajectory", job.trajectory);
    work.take(keywords);
  }
};

py::object fit_one_sensor(py::handle model, py::handle scans, py::handle output,
                          const py::kwargs& kwargs) {
  auto call = arguments_of<FitSensorCall>("fit_sensor", kwargs);
  call.job.model = path_of(model, "model");
  call.job.scans_of = path_of(scans, "scans");
  const std::filesystem::path file = path_of(output, "output");
  Work work(call.work);
  return python_of(
      work.run([&](Session& session) { return to_json(run_fit_sensor(call.job, file, session)); }));
}

struct CompareCall {
  CompareJob job;
  py::object methods = py::none(), meshes = py::none();
  WorkOptions work;

  void take(Keywords& keywords) {
    keywords.take("methods", methods);
    keywords.take("meshes", meshes);
    keywords.take<Preset>("preset", job.preset, kPresets);
    keywords.take("labels", job.labels);
    take_scan_range(keywords, job.scans);
    keywords.take("trajectory", job.trajectory);
    keywords.take("offset", job.offset_m);
    keywords.take("held_out", job.held_out);
    take_scan_range(keywords, job.held_out_scans, "held_out_");
    keywords.take("truth", job.truth);
    keywords.take("sensor", job.sensor);
    keywords.take<DynamicRemoval>("remove", job.remove, kDynamicRemovals);
    take_settings(keywords, job);
    take_settings(keywords, job.limits);
    keywords.take("program", job.program);
    keywords.take<DeviceKind>("device", work.device.kind, device_words());
    work.has_device = false;  // compare() has device, but no gpus
    work.has_seed = true;
    work.take(keywords);
    work.has_device = true;
  }

  /// The job, including the arguments of types that Keywords does not convert.
  CompareJob finished() {
    if (!methods.is_none()) job.methods = list_of_words(methods);
    if (!meshes.is_none() && !py::isinstance<py::dict>(meshes))
      throw py::type_error("compare(): meshes must be None or a dict of names and paths");
    if (!meshes.is_none())
      for (const auto& [name, file] : meshes.cast<py::dict>())
        job.meshes.emplace_back(py::str(name), path_of(file, "meshes"));
    job.threads = work.threads;
    job.seed = work.seed;
    job.device = work.device.kind;
    return job;
  }

  static std::vector<std::string> list_of_words(const py::object& words) {
    std::vector<std::string> list;
    const bool is_list = py::isinstance<py::sequence>(words) && !PyUnicode_Check(words.ptr());
    for (const py::handle word : is_list ? words : py::make_tuple(py::none())) {
      if (!PyUnicode_Check(word.ptr()))
        throw py::type_error("compare(): methods must be None or a list of strings");
      list.push_back(word.cast<std::string>());
    }
    return list;
  }
};

py::object compare(py::handle data, py::handle output, const py::kwargs& kwargs) {
  auto call = arguments_of<CompareCall>("compare", kwargs);
  CompareJob job = call.finished();
  reject_unused(unused_settings(job), kwargs);
  job.data = path_of(data, "data");
  job.output = path_of(output, "output");
  Work work(call.work);
  return python_of(work.run([&](Session& session) { return run_compare(job, session); }));
}

}  // namespace

void bind_jobs(py::module_& module) {
  module.def("mesh", &mesh, py::arg("points"),
             documented<MeshCall>("mesh", "points", kMeshDoc).c_str());
  module.def("calibrate", &calibrate_drive, py::arg("inputs"), py::arg("output"),
             documented<CalibrateCall>("calibrate", "inputs, output", kCalibrateDoc).c_str());
  module.def("export", &export_file, py::arg("input"), py::arg("output"),
             documented<ExportCall>("export", "input, output", kExportDoc).c_str());
  module.def("compare", &compare, py::arg("data"), py::arg("output"),
             documented<CompareCall>("compare", "data, output", kCompareDoc).c_str());
  module.def(
      "fit_sensor", &fit_one_sensor, py::arg("model"), py::arg("scans"), py::arg("output"),
      documented<FitSensorCall>("fit_sensor", "model, scans, output", kFitSensorDoc).c_str());
  module.def("simkitti32", &simkitti32, py::arg("sequence"), py::arg("output"),
             documented<SimKitti32Call>("simkitti32", "sequence, output", kSimKitti32Doc).c_str());
}

}  // namespace adasplats::python
