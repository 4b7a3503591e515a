// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/recipes/export.h"
#include "adasplats/recipes/make_mesh.h"
#include "adasplats/recipes/simkitti32.h"
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

constexpr const char* kExportDoc =
    "Write a splat model, points or the scans of a sequence for other programs.\n\n"
    "input: a splat model, a point file, a sequence folder or what simulate wrote. format:\n"
    "'gaussian-3d', 'gaussian-2d', 'glb', 'ply' or 'mcap'; else what the ending of output says.\n"
    "color: 'class', 'intensity' or 'height'; else the first of these there is. Gives a dict: "
    "what\n"
    "was written and how much. Raises ValueError, OSError.";

constexpr const char* kSimKitti32Doc =
    "Make a labelled data set of another LiDAR from a SemanticKITTI sequence (paper section\n"
    "\"SimKITTI32\").\n\n"
    "sequence: a folder with labels. output: a folder to create; interrupted, the same call goes "
    "on\n"
    "where it stopped. offset: of the sensor in world axes, m; noise: of ranges, m; depth: hits of "
    "a\n"
    "ray that are averaged; moving: simulate what moves, too. Gives the report as a dict. Raises\n"
    "ValueError, OSError.";

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
  py::dict told;
  told[result.unit] = result.count;
  told["points_dropped"] = result.dropped;
  told["bytes"] = result.written_bytes;
  return told;
}

struct SimKitti32Call {
  SimKitti32Job job;
  WorkOptions work;

  void take(Keywords& keywords) {
    keywords.take("sensor", job.sensor);
    keywords.take("labels", job.labels);
    take_scan_range(keywords, job.scans);
    take_settings(keywords, job);
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

template <class Call>
std::string doc_of(const char* name, const char* leading, const char* text) {
  return documented(
      name, leading, [](Keywords& keywords) { Call().take(keywords); }, text);
}

}  // namespace

void bind_recipes(py::module_& module) {
  module.def("mesh", &mesh, py::arg("points"),
             doc_of<MeshCall>("mesh", "points", kMeshDoc).c_str());
  module.def("export", &export_file, py::arg("input"), py::arg("output"),
             doc_of<ExportCall>("export", "input, output", kExportDoc).c_str());
  module.def("simkitti32", &simkitti32, py::arg("sequence"), py::arg("output"),
             doc_of<SimKitti32Call>("simkitti32", "sequence, output", kSimKitti32Doc).c_str());
}

}  // namespace adasplats::python
