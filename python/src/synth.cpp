// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scans/synth.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "bindings.h"
#include "clouds.h"
#include "json.h"
#include "work.h"

namespace adasplats::python {
namespace {

constexpr const char* kSynthDoc =
    R"(Make a procedural street with labels and simulated recordings, for trials and tests.

folder: where to write, created if missing: mapping.ply, mapping_trajectory.csv, sequences/00
(SemanticKITTI), mesh.ply (the true surface) and the true trajectories. points: size of the mapping
cloud, within 10 %. length: of the road, m; 0: chosen from the number of points. range_noise:
standard deviation, m. driving_spacing: distance between the driving scans, m; 0: none. Returns a
dict with the keys of 'adasplats synth street --report'. Raises TypeError, ValueError, OSError.)";

struct StreetArguments {
  StreetOptions street{.seed = 1, .length_m = 0};
  StreetScanOptions scan;
  WorkOptions work{.has_device = false, .has_seed = true};

  void take(Keywords& keywords) {
    std::uint64_t points = scan.points;
    keywords.take("points", points);
    scan.points = points;
    keywords.take("length", street.length_m);
    keywords.take("range_noise", scan.range_noise_m);
    keywords.take("passes", scan.passes);
    keywords.take("driving_spacing", scan.driving_spacing_m);
    work.take(keywords);
    street.seed = scan.seed = work.seed;
  }
};

py::object synth_street(py::handle folder, const py::kwargs& kwargs) {
  const auto arguments = arguments_of<StreetArguments>("synth_street", kwargs);
  const std::filesystem::path path = path_of(folder, "folder");
  Work work(arguments.work);
  const StreetReport report = work.run([&](Session& session) {
    std::filesystem::create_directories(path);
    return write_street(path, arguments.street, arguments.scan, session.executor, session.progress);
  });
  return python_of(to_json(report));
}

}  // namespace

void bind_synth(py::module_& module) {
  module.def("synth_street", &synth_street, py::arg("folder"),
             documented<StreetArguments>("synth_street", "folder", kSynthDoc).c_str());
}

}  // namespace adasplats::python
