// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/jobs/evaluate/evaluate_clouds.h"
#include "adasplats/jobs/evaluate/evaluate_echoes.h"
#include "adasplats/jobs/evaluate/evaluate_labels.h"
#include "adasplats/jobs/evaluate/evaluate_realism.h"
#include "adasplats/jobs/evaluate/evaluate_resimulation.h"
#include "adasplats/jobs/evaluate/evaluate_surface.h"
#include "adasplats/jobs/evaluate/fit_sensor.h"
#include "adasplats/jobs/session/inputs.h"
#include "arrays.h"
#include "clouds.h"
#include "json.h"
#include "scenes.h"

namespace adasplats::python {
namespace {

/// Adds a function of two positional arguments and the keywords of `Arguments`; it returns a dict.
template <class Arguments>
void define(py::module_& module, const char* name, const char* first, const char* second) {
  const std::string leading = std::string(first) + ", " + second;
  module.def(
      name,
      [name](py::handle a, py::handle b, const py::kwargs& kwargs) {
        return arguments_of<Arguments>(name, kwargs).run(a, b);
      },
      py::arg(first), py::arg(second),
      documented<Arguments>(name, leading.c_str(), Arguments::kDoc).c_str());
}

/// Runs f(session) and converts its report to a dict.
template <class F>
py::object reported(const WorkOptions& options, F&& f) {
  Work work(options);
  return python_of(work.run([&](Session& session) { return to_json(f(session)); }));
}

struct CloudArguments {
  static constexpr const char* kDoc =
      R"(Compare two clouds: C2C distances (as in the paper), Chamfer distance, F-scores, completeness.

simulated, original: PointClouds or paths. by_class: also compare each class by itself; labels names
the scheme, as in label_scheme(). nearest_classes: give each simulated point the class of the
nearest original point and ignore its own. Raises ValueError, OSError.)";

  bool by_class = false, nearest_classes = false;
  std::string labels;
  WorkOptions work{.has_device = false};

  void take(Keywords& keywords) {
    keywords.take("by_class", by_class);
    keywords.take("nearest_classes", nearest_classes);
    keywords.take("labels", labels);
    work.take(keywords);
  }

  py::object run(py::handle simulated, py::handle original) const {
    if (nearest_classes && !by_class)
      throw py::value_error("nearest_classes has no effect without by_class");
    const ByClass classes = nearest_classes ? ByClass::nearest
                            : by_class      ? ByClass::own
                                            : ByClass::no;
    constexpr std::array<const char*, 2> kNames = {"simulated", "original"};
    std::array<std::shared_ptr<const PointCloud>, 2> clouds;
    std::array<std::filesystem::path, 2> files;
    const std::array<py::handle, 2> given = {simulated, original};
    for (std::size_t k = 0; k < 2; ++k) {
      if (py::isinstance<PointCloud>(given[k]))
        clouds[k] = given[k].cast<std::shared_ptr<PointCloud>>();
      else
        files[k] = path_of(given[k], kNames[k]);
    }
    return reported(work, [&](Session& session) {
      if (!clouds[0] && !clouds[1]) {
        const CloudPair pair = load_clouds({files[0], files[1], labels}, session);
        return evaluate_clouds(pair.simulated, pair.original, classes,
                               pair.labels ? &*pair.labels : nullptr, session);
      }
      for (std::filesystem::path& file : files)
        if (!file.empty()) file = resolve_cloud_input(file);
      const auto scheme = label_scheme_for(labels, files);
      for (std::size_t k = 0; k < 2; ++k)
        if (!clouds[k])
          clouds[k] = std::make_shared<PointCloud>(
              load_cloud(std::span(files).subspan(k, 1), {}, session.executor, session.progress)
                  .first);
      const auto name = [&](std::size_t k) {
        return files[k].empty() ? std::filesystem::path(kNames[k]) : files[k];
      };
      require_same_crs({{name(0), clouds[0]->crs}, {name(1), clouds[1]->crs}}, session.progress);
      return evaluate_clouds(*clouds[0], *clouds[1], classes, scheme ? &*scheme : nullptr, session);
    });
  }
};

struct ResimulateArguments {
  static constexpr const char* kDoc =
      R"(Cast the measured beams of held-out scans into a model and compare the ranges.

model: a Scene or the path of a model. sequence: a SemanticKITTI folder. min_range, max_range: m.
protocol: 'lidar4d' adds the metrics of that publication. Raises TypeError, ValueError, OSError.)";

  HeldOutScans scans;
  std::string labels = "semantickitti";
  ResimulateOptions options;
  HeldOutExtras extras;
  WorkOptions work;

  void take(Keywords& keywords) {
    take_scan_range(keywords, scans.scans);
    keywords.take("beams_from_poses", scans.beams_from_poses);
    keywords.take("motion", scans.motion);
    keywords.take("trajectory", scans.trajectory);
    keywords.take("boxes", scans.boxes);
    take_settings(keywords, scans, &Setting::key);
    keywords.take("labels", labels);
    keywords.take("min_range", options.min_range_m);
    keywords.take("max_range", options.max_range_m);
    keywords.take("drop_moving", options.drop_moving);
    keywords.take("drop_movable", options.drop_movable);
    keywords.take("all_poses", extras.all_poses);
    keywords.take<HeldOutProtocol>("protocol", extras.protocol, kHeldOutProtocols);
    work.take(keywords);
  }

  py::object run(py::handle model, py::handle sequence) {
    scans.sequence = path_of(sequence, "sequence");
    const bool in_memory = py::isinstance<SceneObject>(model);
    const auto object =
        in_memory ? model.cast<std::shared_ptr<SceneObject>>() : std::shared_ptr<SceneObject>();
    const std::filesystem::path file =
        in_memory ? std::filesystem::path() : path_of(model, "model");
    return reported(work, [&](Session& session) {
      if (!in_memory) require_input(file);
      KittiSequence held_out = open_held_out(scans, session);
      if (!in_memory)
        return evaluate_resimulation(ModelScene(file, "", session), held_out, labels, options,
                                     extras, session);
      const auto lock = object->lock();
      return evaluate_resimulation(*object->scene, held_out, labels, options, extras, session);
    });
  }
};

struct TruthArguments {
  static constexpr const char* kDoc =
      R"(Cast the rays of a sensor into a model and into the true surface and compare the hits.

model, truth, trajectory: paths of a model, a mesh and poses. sensor: a name or a file. offset: (3,)
m, added to the positions of the poses. Raises TypeError, ValueError, OSError.)";

  TruthJob job;
  WorkOptions work;

  void take(Keywords& keywords) {
    keywords.take("trajectory", job.trajectory);
    keywords.take("sensor", job.sensor);
    keywords.take("offset", job.offset_m);
    std::uint64_t every = job.every;
    keywords.take("every", every);
    job.every = every;
    keywords.take("labels", job.labels);
    keywords.take("drop_moving", job.options.drop_moving);
    keywords.take("drop_movable", job.options.drop_movable);
    work.take(keywords);
  }

  py::object run(py::handle model, py::handle truth) {
    job.model = path_of(model, "model");
    job.truth = path_of(truth, "truth");
    if (job.trajectory.empty()) throw py::type_error("truth(): trajectory is missing");
    return reported(work, [&](Session& session) { return evaluate_truth(job, session); });
  }
};

struct PresenceArguments {
  static constexpr const char* kDoc = R"(Find which measured points the model has a surface at.

model, points: paths. within, min_range, max_range: m. The other keywords are those of read().
Raises ValueError, OSError.)";

  PresenceJob job;
  WorkOptions work;

  void take(Keywords& keywords) {
    keywords.take("labels", job.labels);
    keywords.take("within", job.options.within_m);
    keywords.take("min_range", job.options.min_range_m);
    keywords.take("max_range", job.options.max_range_m);
    take_load_options(keywords, job.load);
    work.take(keywords);
  }

  py::object run(py::handle model, py::handle points) {
    job.model = path_of(model, "model");
    job.points = path_of(points, "points");
    return reported(work, [&](Session& session) { return evaluate_presence(job, session); });
  }
};

struct EchoArguments {
  static constexpr const char* kDoc =
      R"(Compare predicted intensities and missing returns with the measured ones.

model, sequence, motion: paths. drop: a file of 'adasplats fit-drop'. Raises ValueError, OSError.)";

  EchoInputs inputs;
  std::filesystem::path drop;
  WorkOptions work;

  void take(Keywords& keywords) {
    take_scan_range(keywords, inputs.scans);
    keywords.take("motion", inputs.motion);
    keywords.take("sensor", inputs.sensor);
    keywords.take("drop", drop);
    work.take(keywords);
  }

  py::object run(py::handle model, py::handle sequence) {
    inputs.model = path_of(model, "model");
    inputs.sequence = path_of(sequence, "sequence");
    return reported(work, [&](Session& session) { return evaluate_echoes(inputs, drop, session); });
  }
};

struct UnitArguments {
  static constexpr const char* kDoc =
      R"(Check how well a calibrated sensor predicts the intensities and missing returns of other scans.

model, scans, motion, trajectory: paths. sensor: a file of fit_sensor(). Raises ValueError,
OSError.)";

  EvaluateUnitJob job;
  WorkOptions work;

  void take(Keywords& keywords) {
    keywords.take("sensor", job.sensor);
    take_scan_range(keywords, job.scans.scans);
    keywords.take("motion", job.scans.motion);
    keywords.take("trajectory", job.scans.trajectory);
    work.take(keywords);
  }

  py::object run(py::handle model, py::handle scans) {
    job.scans.model = path_of(model, "model");
    job.scans.scans_of = path_of(scans, "scans");
    return reported(work, [&](Session& session) { return evaluate_unit(job, session); });
  }
};

struct LabelArguments {
  static constexpr const char* kDoc =
      R"(Count the simulated points that have the class of the nearest measured point.

simulated, original: SemanticKITTI folders. window: number of original scans before and after the
one of the same time that are searched. Raises ValueError, OSError.)";

  LabelAgreementJob job;
  WorkOptions work{.has_device = false};

  void take(Keywords& keywords) {
    std::uint64_t window = job.options.window;
    std::uint64_t every = job.options.every;
    keywords.take("window", window);
    keywords.take("every", every);
    job.options.window = window;
    job.options.every = every;
    keywords.take("labels", job.labels);
    work.take(keywords);
  }

  py::object run(py::handle simulated, py::handle original) {
    job.simulated = path_of(simulated, "simulated");
    job.original = path_of(original, "original");
    return reported(work, [&](Session& session) { return evaluate_labels(job, session); });
  }
};

struct RealismArguments {
  static constexpr const char* kDoc =
      R"(Try to distinguish simulated from real scans of the same poses.

Gives the AUC of classifiers of patches of 8 x 64 beams, and statistics of both sets of scans.
simulated, real: paths of sequences or folders of scans of one sensor, at least 8 scans each.
trajectory: poses of a folder without a poses.csv. Raises ValueError, OSError.)";

  RealismJob job;
  WorkOptions work{.has_device = false, .has_seed = true};

  void take(Keywords& keywords) {
    take_scan_range(keywords, job.scans);
    keywords.take("trajectory", job.trajectory);
    work.take(keywords);
  }

  py::object run(py::handle simulated, py::handle real) {
    job.simulated = path_of(simulated, "simulated");
    job.real = path_of(real, "real");
    return reported(work, [&](Session& session) { return evaluate_realism(job, session); });
  }
};

/// Classes of an array of labels: the low 16 bits, as in SemanticKITTI's .label files.
std::vector<std::uint16_t> classes_of(py::handle labels, const char* name) {
  const py::array array = labels.is_none() ? py::array() : py::array::ensure(labels);
  if (labels.is_none() || !array)
    throw py::type_error(std::string(name) +
                         ": expected a path or an array of whole numbers, got " +
                         type_name(labels));
  const auto count = static_cast<std::size_t>(array.size());
  const std::vector<std::uint32_t> numbers = whole_numbers_of<std::uint32_t>(array, count, name);
  std::vector<std::uint16_t> classes;
  classes.reserve(count);
  for (const std::uint32_t number : numbers)
    classes.push_back(static_cast<std::uint16_t>(number & 0xffff));
  return classes;
}

struct SegmentationArguments {
  static constexpr const char* kDoc =
      R"(Compare predicted classes with the true ones by intersection over union.

predicted, true: paths of sequences, folders, .label files or points with classes; or integer arrays
(N,) with the class in the low 16 bits. min_share: minimum share of a class among the true points;
rarer classes do not count in 'miou_present'. Raises TypeError, ValueError, OSError.)";

  SegmentationJob job;
  WorkOptions work{.has_device = false};

  void take(Keywords& keywords) {
    take_scan_range(keywords, job.scans);
    keywords.take("labels", job.labels);
    keywords.take("min_share", job.options.min_share);
    work.take(keywords);
  }

  py::object run(py::handle predicted, py::handle truth) {
    if (is_path(predicted) || is_path(truth)) {
      job.predicted = path_of(predicted, "predicted");
      job.truth = path_of(truth, "true");
      return reported(work, [&](Session& session) { return evaluate_segmentation(job, session); });
    }
    if (job.scans != ScanRange())
      throw py::value_error("segmentation(): first_scan, scan_count and scan_stride are for paths");
    const std::vector<std::uint16_t> found = classes_of(predicted, "predicted");
    const std::vector<std::uint16_t> expected = classes_of(truth, "true");
    return reported(work, [&](Session& session) {
      return evaluate_segmentation(found, expected, job.labels, job.options, session);
    });
  }
};

}  // namespace

void bind_evaluate(py::module_& module) {
  py::module_ evaluate = module.def_submodule(
      "evaluate",
      "Metrics of models and scans: dicts with the keys of 'adasplats evaluate --report'.");
  define<CloudArguments>(evaluate, "c2c", "simulated", "original");
  define<ResimulateArguments>(evaluate, "resimulate", "model", "sequence");
  define<TruthArguments>(evaluate, "truth", "model", "truth");
  define<PresenceArguments>(evaluate, "presence", "model", "points");
  define<EchoArguments>(evaluate, "echoes", "model", "sequence");
  define<UnitArguments>(evaluate, "unit", "model", "scans");
  define<LabelArguments>(evaluate, "labels", "simulated", "original");
  define<RealismArguments>(evaluate, "realism", "simulated", "real");
  define<SegmentationArguments>(evaluate, "segmentation", "predicted", "true");
}

}  // namespace adasplats::python
