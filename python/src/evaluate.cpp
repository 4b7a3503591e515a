// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

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

/// Two positional arguments and the keywords of `Arguments`, the result as a dict.
template <class Arguments>
void define(py::module_& module, const char* name, const char* first, const char* second,
            const char* text) {
  const std::string doc = documented(
      name, (std::string(first) + ", " + second).c_str(),
      [](Keywords& keywords) {
        Arguments arguments;
        arguments.take(keywords);
      },
      text);
  module.def(
      name,
      [name = std::string(name)](py::handle a, py::handle b, const py::kwargs& kwargs) {
        Keywords keywords(name, kwargs);
        Arguments arguments;
        arguments.take(keywords);
        keywords.finish();
        return arguments.run(a, b);
      },
      py::arg(first), py::arg(second), doc.c_str());
}

/// Work's result through to_json().
template <class F>
py::object reported(const WorkOptions& options, F&& f) {
  Work work(options);
  return python_of(work.run([&](Session& session) { return to_json(f(session)); }));
}

struct CloudArguments {
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
    std::array<std::shared_ptr<const PointCloud>, 2> clouds;
    std::array<std::filesystem::path, 2> files;
    const std::array<py::handle, 2> given = {simulated, original};
    for (std::size_t k = 0; k < 2; ++k) {
      if (py::isinstance<PointCloud>(given[k]))
        clouds[k] = given[k].cast<std::shared_ptr<PointCloud>>();
      else
        files[k] = path_of(given[k], k == 0 ? "simulated" : "original");
    }
    return reported(work, [&](Session& session) {
      for (std::filesystem::path& file : files)
        if (!file.empty()) file = resolve_cloud_input(file);
      const auto scheme = label_scheme_for(labels, files);
      for (std::size_t k = 0; k < 2; ++k)
        if (!clouds[k])
          clouds[k] = std::make_shared<PointCloud>(
              load_cloud(std::span(files).subspan(k, 1), {}, session.executor, session.progress)
                  .first);
      return evaluate_clouds(*clouds[0], *clouds[1], classes, scheme ? &*scheme : nullptr, session);
    });
  }
};

/// Nothing of None. Throws TypeError, and ValueError for a word that is no protocol.
std::optional<HeldOutProtocol> protocol_of(const py::object& word) {
  if (word.is_none()) return {};
  if (!py::isinstance<py::str>(word)) throw py::type_error("protocol: expected a string or None");
  std::string known;
  for (const auto& [each, protocol] : kHeldOutProtocols) {
    if (each == word.cast<std::string>()) return protocol;
    known += (known.empty() ? "" : ", ") + std::string(each);
  }
  throw py::value_error("protocol: '" + word.cast<std::string>() + "', expected one of " + known);
}

struct ResimulateArguments {
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
    py::object protocol = py::none();
    keywords.take("protocol", protocol);
    extras.protocol = protocol_of(protocol);
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

/// Classes of an array of labels: their low 16 bits, as in files of labels.
std::vector<std::uint16_t> classes_of(py::handle labels, const char* name) {
  const py::array array = labels.is_none() ? py::array() : py::array::ensure(labels);
  if (labels.is_none() || !array)
    throw py::type_error(std::string(name) +
                         ": expected a path or an array of whole numbers, got " +
                         std::string(py::str(py::type::of(labels).attr("__name__"))));
  const auto count = static_cast<std::size_t>(array.size());
  const std::vector<std::uint32_t> numbers = whole_numbers_of<std::uint32_t>(array, count, name);
  std::vector<std::uint16_t> classes;
  classes.reserve(count);
  for (const std::uint32_t number : numbers)
    classes.push_back(static_cast<std::uint16_t>(number & 0xffff));
  return classes;
}

struct SegmentationArguments {
  SegmentationJob job;
  WorkOptions work{.has_device = false};

  void take(Keywords& keywords) {
    take_scan_range(keywords, job.scans);
    keywords.take("labels", job.labels);
    keywords.take("least_share", job.options.min_share);
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
    const std::vector<std::uint16_t> has = classes_of(predicted, "predicted");
    const std::vector<std::uint16_t> expected = classes_of(truth, "true");
    return reported(work, [&](Session& session) {
      return evaluate_segmentation(has, expected, job.labels, job.options, session);
    });
  }
};

}  // namespace

void bind_evaluate(py::module_& module) {
  py::module_ evaluate = module.def_submodule(
      "evaluate",
      "How good models and scans are: dicts with the keys of 'adasplats evaluate --report'.");
  define<CloudArguments>(
      evaluate, "c2c", "simulated", "original",
      "Distances between two clouds (paper: C2C), Chamfer distance, F-scores, completeness.\n\n"
      "simulated, original: PointCloud or paths. by_class: also class by class, with labels as\n"
      "label_scheme() takes them; nearest_classes: a simulated point is of the class of the "
      "nearest\n"
      "original one, whatever its own (a network's, or none). Raises ValueError, OSError.");
  define<ResimulateArguments>(
      evaluate, "resimulate", "model", "sequence",
      "Cast the measured beams of held-out scans again and compare ranges.\n\n"
      "model: a Scene or the path of a model. sequence: a SemanticKITTI folder. Ranges in metres.\n"
      "protocol: 'lidar4d' adds the measures of that publication.\n"
      "Raises ValueError, OSError.");
  define<TruthArguments>(
      evaluate, "truth", "model", "truth",
      "Cast a sensor's rays into a model and into the true surface and compare.\n\n"
      "model, truth, trajectory: paths (the model; a mesh; poses). sensor: a name or a file. "
      "offset:\n"
      "(3,) m, moves the poses. Raises TypeError, ValueError, OSError.");
  define<PresenceArguments>(evaluate, "presence", "model", "points",
                            "Which measured points a model has a surface at.\n\n"
                            "model, points: paths. within, min_range, max_range: m; the other "
                            "keywords are those of read().\n"
                            "Raises ValueError, OSError.");
  define<EchoArguments>(
      evaluate, "echoes", "model", "sequence",
      "Foretold intensities and beams without return against the measured ones.\n\n"
      "model, sequence, motion: paths. drop: file of 'adasplats fit-drop'. Raises ValueError, "
      "OSError.");
  define<UnitArguments>(
      evaluate, "unit", "model", "scans",
      "How well a unit of a sensor, as fit_sensor() learned it, foretells other scans.\n\n"
      "model, scans, motion, trajectory: paths. sensor: file of fit_sensor(). Intensities and lost "
      "beams.\n"
      "Raises ValueError, OSError.");
  define<LabelArguments>(evaluate, "labels", "simulated", "original",
                         "How many simulated points have the class of the nearest measured one.\n\n"
                         "simulated, original: SemanticKITTI folders. window: original scans "
                         "before and after the one\n"
                         "of the same time. Raises ValueError, OSError.");
  define<RealismArguments>(
      evaluate, "realism", "simulated", "real",
      "Whether simulated scans can be told from real ones of the same poses: AUC of classifiers of "
      "patches\n"
      "of 8 x 64 beams, and statistics side by side.\n\n"
      "simulated, real: paths of sequences or folders of scans of one sensor, at least 8 scans "
      "each.\n"
      "trajectory: poses of a folder without a poses.csv. Raises ValueError, OSError.");
  define<SegmentationArguments>(
      evaluate, "segmentation", "predicted", "true",
      "How well predicted classes agree with the true ones, by intersection over union.\n\n"
      "predicted, true: paths of sequences, trees, .label files or points with classes; or arrays "
      "(N,) of whole\n"
      "numbers, the class in the low 16 bits. least_share: rarer classes are left out of "
      "'miou_present'.\n"
      "Raises TypeError, ValueError, OSError.");
}

}  // namespace adasplats::python
