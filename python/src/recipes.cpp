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
    "Make a triangle mesh of points, as the paper compares splats with.\n\n"
    "points: a PointCloud, or a path or paths as read() takes them. method: 'imls' (implicit "
    "moving\n"
    "least squares) or 'poisson' (screened Poisson, by PoissonRecon on PATH or Open3D). labels: a\n"
    "name or a file as label_scheme() takes them. neighbors: points of a normal. voxel (m), sigma "
    "and\n"
    "truncation (voxels) are for imls, depth, samples_per_node, trim and poisson_program for "
    "poisson.\n"
    "Raises ValueError, OSError, RuntimeError (no program for Poisson).";

constexpr const char* kCalibrateDoc =
    "Estimate from a drive's points what its poses and lasers get wrong, and write it.\n\n"
    "inputs: SemanticKITTI sequence folders, and folders of scans with times (then trajectory, "
    "too).\n"
    "output: a folder to create, with trajectory.csv, poses.txt, lasers.csv, sensor.toml, "
    "report.html\n"
    "and report.json, as far as known (docs/formats.md). poses, ranges, elevations: what is "
    "estimated.\n"
    "Gives report.json as a dict. Raises ValueError (DataError where the points do not say clearly "
    "that\n"
    "anything is wrong; the report is written nevertheless), OSError.";

constexpr const char* kExportDoc =
    "Write a splat model, points or the scans of a sequence for other programs.\n\n"
    "input: a splat model, a point file, a sequence folder or what simulate wrote. format:\n"
    "'gaussian-3d', 'gaussian-2d', 'glb', 'ply', 'las', 'laz' or 'mcap'; else what the ending of "
    "output says.\n"
    "color: 'class', 'intensity' or 'height'; else the first of these there is. Gives a dict: "
    "what\n"
    "was written and how much. Raises ValueError, OSError.";

constexpr const char* kFitSensorDoc =
    "Learn from measured scans what one unit of a sensor makes of what its beams meet.\n\n"
    "model: path of a splat model of the place. scans: a sequence, or a folder of files, one a "
    "scan "
    "(then\n"
    "trajectory, too). output: the sensor to write, TOML, for Sensor(), with all that is of the "
    "unit.\n"
    "motion: how the sensor moved during raw scans. Gives the report as a dict. Raises\n"
    "ValueError (DataError where the scans are of another place), OSError.";

constexpr const char* kSimKitti32Doc =
    "Make a labelled data set of another LiDAR from a SemanticKITTI sequence (paper section\n"
    "\"SimKITTI32\").\n\n"
    "sequence: a folder with labels. output: a folder to create; interrupted, the same call goes "
    "on\n"
    "where it stopped. offset: of the sensor in world axes, m; noise: of ranges, m; depth: hits of "
    "a\n"
    "ray that are averaged; moving: simulate what moves, too. model: the static model, instead of "
    "one\n"
    "that is made of the scans. Gives the report as a dict. Raises ValueError, OSError.";

constexpr const char* kCompareDoc =
    "Compare all methods on the same data with the same rays.\n\n"
    "data: what synth_street wrote, a SemanticKITTI folder or a point file. output: a folder for "
    "the\n"
    "reports and the work; interrupted, the same call goes on where it stopped. methods: a list "
    "of\n"
    "names; None: all that the data allow. meshes: ready-made ones, {name: file}. What is None is\n"
    "found in data. time_limit (s) and memory_limit (GiB; 0: 90 % of the machine's) are for every\n"
    "step, which the program adasplats runs: program, else that of PATH. Gives compare.json as a\n"
    "dict. Raises ValueError, OSError (FileNotFoundError: also where the program is not there).";

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
  Keywords keywords("mesh", kwargs);
  MeshCall call;
  call.take(keywords);
  keywords.finish();
  refuse_unused(unused_settings(call.job), kwargs);
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
  Keywords keywords("calibrate", kwargs);
  CalibrateCall call;
  call.take(keywords);
  keywords.finish();
  call.job.inputs = paths_of(inputs, "inputs");
  call.job.output = path_of(output, "output");
  Work work(call.work);
  const nlohmann::ordered_json report =
      work.run([&](Session& session) { return to_json(run_calibrate(call.job, session)); });
  return python_of(report);
}

/// Takes a word that may be None.
template <class T, std::size_t N>
void take_word(Keywords& keywords, const char* name, std::optional<T>& value,
               const std::pair<std::string_view, T> (&words)[N]) {
  std::string word;
  keywords.take(name, word);
  if (word.empty()) return;
  std::string known;
  for (const auto& [each, meaning] : words) {
    if (each == word) value = meaning;
    known += (known.empty() ? "'" : ", '") + std::string(each) + "'";
  }
  if (!value) throw py::value_error(std::string(name) + " must be one of " + known);
}

struct ExportCall {
  ExportJob job;
  WorkOptions work;

  void take(Keywords& keywords) {
    take_word(keywords, "format", job.format, kExportFormats);
    keywords.take("labels", job.labels);
    take_word(keywords, "color", job.color, kExportColors);
    take_load_options(keywords, job.load);
    work.has_device = false;
    work.take(keywords);
  }
};

/// The first keyword that says how to load points or scans; "" where there is none.
std::string load_keyword(const py::kwargs& given) {
  for (const auto& [name, value] : given) {
    auto word = name.cast<std::string>();
    const bool other = word == "format" || word == "labels" || word == "color" ||
                       word == "threads" || word == "progress";
    if (!other) return word;
  }
  return "";
}

py::dict export_file(py::handle input, py::handle output, const py::kwargs& kwargs) {
  Keywords keywords("export", kwargs);
  ExportCall call;
  call.take(keywords);
  keywords.finish();
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
  Keywords keywords("simkitti32", kwargs);
  SimKitti32Call call;
  call.take(keywords);
  keywords.finish();
  refuse_unused(unused_settings(call.job), kwargs);
  call.job.sequence = path_of(sequence, "sequence");
  call.job.output = path_of(output, "output");
  Work work(call.work);
  const nlohmann::ordered_json report = work.run([&](Session& session) {
    return to_json(run_simkitti32(call.job, session), load_label_scheme(call.job.labels));
  });
  return python_of(report);
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
  Keywords keywords("fit_sensor", kwargs);
  FitSensorCall call;
  call.take(keywords);
  keywords.finish();
  call.job.model = path_of(model, "model");
  call.job.scans_of = path_of(scans, "scans");
  const std::filesystem::path file = path_of(output, "output");
  Work work(call.work);
  const nlohmann::ordered_json report =
      work.run([&](Session& session) { return to_json(run_fit_sensor(call.job, file, session)); });
  return python_of(report);
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
    take_word(keywords, "remove", job.remove, kDynamicRemovals);
    take_settings(keywords, job);
    take_settings(keywords, job.limits);
    keywords.take("program", job.program);
    keywords.take<DeviceKind>("device", work.device.kind, device_words());
    work.has_device = false;  // of one GPU
    work.has_seed = true;
    work.take(keywords);
    work.has_device = true;
  }

  /// The job with what Keywords does not know.
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
  Keywords keywords("compare", kwargs);
  CompareCall call;
  call.take(keywords);
  keywords.finish();
  CompareJob job = call.finished();
  refuse_unused(unused_settings(job), kwargs);
  job.data = path_of(data, "data");
  job.output = path_of(output, "output");
  Work work(call.work);
  const nlohmann::ordered_json results =
      work.run([&](Session& session) { return run_compare(job, session); });
  return python_of(results);
}

template <class Call>
std::string doc_of(const char* name, const char* leading, const char* text) {
  return documented(
      name, leading, [](Keywords& keywords) { Call().take(keywords); }, text);
}

}  // namespace

void bind_recipes(py::module_& module) {
  module.def("mesh", &mesh, py::arg("points"),
             doc_of<MeshCall>("mesh", "points", kMeshDoc).c_str());
  module.def("calibrate", &calibrate_drive, py::arg("inputs"), py::arg("output"),
             doc_of<CalibrateCall>("calibrate", "inputs, output", kCalibrateDoc).c_str());
  module.def("export", &export_file, py::arg("input"), py::arg("output"),
             doc_of<ExportCall>("export", "input, output", kExportDoc).c_str());
  module.def("compare", &compare, py::arg("data"), py::arg("output"),
             doc_of<CompareCall>("compare", "data, output", kCompareDoc).c_str());
  module.def("fit_sensor", &fit_one_sensor, py::arg("model"), py::arg("scans"), py::arg("output"),
             doc_of<FitSensorCall>("fit_sensor", "model, scans, output", kFitSensorDoc).c_str());
  module.def("simkitti32", &simkitti32, py::arg("sequence"), py::arg("output"),
             doc_of<SimKitti32Call>("simkitti32", "sequence, output", kSimKitti32Doc).c_str());
}

}  // namespace adasplats::python
