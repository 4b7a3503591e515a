// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "sensors.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "adasplats/core/error.h"
#include "clouds.h"
#include "pickles.h"

namespace adasplats {

template <class Archive>
void fields(Archive& archive, RosettePattern& rosette) {
  archive("prism_hz", rosette.prism_hz);
  archive("deflection_rad", rosette.deflection_rad);
  archive("points_per_s", rosette.points_per_s);
  archive("laser_tilts_rad", rosette.laser_tilts_rad);
}

template <class Archive>
void fields(Archive& archive, SensorIntensity& unit) {
  archive("step", unit.step);
  archive("highest", unit.highest);
  archive("ring_nodes", unit.ring_nodes);
  archive("ring_expected", unit.ring_expected);
  archive("ring_level", unit.ring_level);
  archive("levels", unit.levels);
  archive("zero_share", unit.zero_share);
  archive("reported", unit.reported);
}

template <class Archive>
void fields(Archive& archive, SensorFields& unit) {
  archive("turns", unit.turns);
  archive("rings", unit.rings);
  archive("columns", unit.columns);
  archive("bytes", unit.bytes);
}

template <class Archive>
void fields(Archive& archive, LidarModel& model) {
  archive("name", model.name);
  archive("elevations_rad", model.elevations_rad);
  archive("azimuth_offsets_rad", model.azimuth_offsets_rad);
  archive("beam_origins_m", model.beam_origins_m);
  archive("firing_times_s", model.firing_times_s);
  archive("range_offsets_m", model.range_offsets_m);
  archive("ring_noise_m", model.ring_noise_m);
  archive("intensity", model.intensity);
  archive("fields", model.fields);
  archive("columns", model.columns);
  archive("first_azimuth_rad", model.first_azimuth_rad);
  archive("rotation_hz", model.rotation_hz);
  archive("min_range_m", model.min_range_m);
  archive("max_range_m", model.max_range_m);
  archive("range_noise_m", model.range_noise_m);
  archive("angular_noise_rad", model.angular_noise_rad);
  archive("range_resolution_m", model.range_resolution_m);
  archive("divergence_rad", model.divergence_rad);
  archive("divergence_kind", model.divergence_kind);
  archive("max_returns", model.max_returns);
  archive("clockwise", model.clockwise);
  archive("free_pattern", model.free_pattern);
  archive("rosette", model.rosette);
  archive("source", model.source);
}

}  // namespace adasplats

namespace adasplats::python {
namespace {

constexpr const char* kSensorsClassDoc =
    R"(A LiDAR: the rays of one revolution and the properties of its measurements.

name_or_file: a name of sensors(), or a file: TOML, Ouster JSON, Velodyne YAML, or a CSV of rays
azimuth_deg,elevation_deg[,time_s[,ring]] (docs/sensors.md). Angles are in radians: azimuth
counter-clockwise from +x, elevation up. Raises TypeError, ValueError, FileNotFoundError.)";

constexpr const char* kBeamsDoc = R"(A spinning LiDAR.

elevations_rad: (B,), topmost first. azimuth_offsets_rad, firing_times_s: (B,) or None.
beam_origins_m: (B, 3) or None, in the frame of the spinning head. columns: azimuth steps per
revolution. A divergence needs divergence_kind, the definition of its angle: 'fwhm', '1/e2' (full
angle), '1/e2-half' or 'unknown' (docs/sensors.md). Returns a Sensor. Raises TypeError, ValueError.)";

constexpr const char* kRaysDoc = R"(A LiDAR that fires the same list of rays in every scan.

directions: (N, 3) in the sensor frame, will be normalised. origins_m: (N, 3) or None, start points
of the rays. times_s: (N,) since the start of the scan; None: all 0. rings: (N,) integers from 0 to
65535, 0 is the topmost; None: all 0. columns: (N,) integers; None: the index of the ray. Returns a
Sensor. Raises TypeError, ValueError.)";

/// Angles need their definition; the model holds full angles at 1/e^2.
void take_divergence(Keywords& keywords, LidarModel& model) {
  std::optional<double> angles_rad[2];
  std::string word;
  keywords.take("divergence_horizontal_rad", angles_rad[0]);
  keywords.take("divergence_vertical_rad", angles_rad[1]);
  keywords.take("divergence_kind", word);
  if (!angles_rad[0] && !angles_rad[1] && word.empty()) return;
  const std::vector<std::string> words = list_of<DivergenceKind>(kDivergenceKinds);
  std::string known;
  for (const std::string& each : words) known += (known.empty() ? "'" : ", '") + each + "'";
  if (word.empty())
    throw py::type_error("a divergence needs divergence_kind, the definition of its angle: " +
                         known);
  if (!angles_rad[0] && !angles_rad[1])
    throw py::type_error(
        "divergence_kind needs divergence_horizontal_rad, divergence_vertical_rad "
        "or both");
  const auto found = std::ranges::find(words, word);
  if (found == words.end())
    throw py::value_error("divergence_kind must be one of " + known + ", not '" + word + "'" +
                          did_you_mean(word, words));
  model.divergence_kind = kDivergenceKinds[found - words.begin()].second;
  for (const int axis : {0, 1})
    if (angles_rad[axis])
      model.divergence_rad[axis] = full_e2_angle_rad(*angles_rad[axis], model.divergence_kind);
}

/// Keywords of all patterns.
void take_common(Keywords& keywords, LidarModel& model) {
  keywords.take("name", model.name);
  keywords.take("rotation_hz", model.rotation_hz);
  keywords.take("min_range_m", model.min_range_m);
  keywords.take("max_range_m", model.max_range_m);
  keywords.take("range_noise_m", model.range_noise_m);
  keywords.take("angular_noise_rad", model.angular_noise_rad);
  keywords.take("range_resolution_m", model.range_resolution_m);
  take_divergence(keywords, model);
  keywords.take("max_returns", model.max_returns);
}

void require(bool holds, const char* message) {
  if (!holds) throw py::value_error(message);
}

void check_common(const LidarModel& model) {
  require(model.rotation_hz > 0 && std::isfinite(model.rotation_hz),
          "rotation_hz must be greater than 0");
  require(model.min_range_m >= 0 && model.max_range_m > model.min_range_m,
          "expected 0 <= min_range_m < max_range_m");
  require(model.range_noise_m >= 0 && model.angular_noise_rad >= 0 && model.range_resolution_m >= 0,
          "noise and resolution must not be negative");
  for (const double angle_rad : model.divergence_rad)
    require(angle_rad >= 0 && angle_rad <= std::numbers::pi / 2,
            "a divergence must be 0 to 90 degrees at 1/e2");
}

LidarModel default_beams() {
  LidarModel model;
  model.name = "beams";
  model.columns = 1800;
  return model;
}

LidarModel default_rays() {
  LidarModel model;
  model.name = "rays";
  return model;
}

struct BeamArguments {
  LidarModel model = default_beams();
  py::object azimuth_offsets_rad = py::none();
  py::object firing_times_s = py::none();
  py::object beam_origins_m = py::none();

  void take(Keywords& keywords) {
    keywords.take("azimuth_offsets_rad", azimuth_offsets_rad);
    keywords.take("firing_times_s", firing_times_s);
    keywords.take("beam_origins_m", beam_origins_m);
    std::uint64_t columns = model.columns;
    keywords.take("columns", columns);
    require(columns >= 1 && columns <= 1U << 24, "columns must be 1 to 16777216");
    model.columns = static_cast<std::uint32_t>(columns);
    keywords.take("first_azimuth_rad", model.first_azimuth_rad);
    keywords.take("clockwise", model.clockwise);
    take_common(keywords, model);
  }
};

LidarModel from_beams(py::handle elevations_rad, const py::kwargs& kwargs) {
  auto arguments = arguments_of<BeamArguments>("from_beams", kwargs);
  LidarModel& model = arguments.model;
  check_common(model);
  const std::size_t beams = py::len(elevations_rad);
  model.elevations_rad = numbers_of(elevations_rad, beams, "elevations_rad");
  require(beams >= 1 && beams <= 65536, "elevations_rad: expected 1 to 65536 beams");
  for (std::size_t i = 1; i < beams; ++i)
    require(model.elevations_rad[i] <= model.elevations_rad[i - 1],
            "elevations_rad: expected the topmost beam first");
  model.azimuth_offsets_rad =
      numbers_of(arguments.azimuth_offsets_rad, beams, "azimuth_offsets_rad");
  model.firing_times_s = numbers_of(arguments.firing_times_s, beams, "firing_times_s");
  if (arguments.beam_origins_m.is_none()) return model;
  const Rows origins(arguments.beam_origins_m, 3, "beam_origins_m");
  require(origins.size() == beams, "beam_origins_m: expected one row per beam");
  origins.require_finite();
  for (std::size_t i = 0; i < beams; ++i) model.beam_origins_m.push_back(origins.vector(i));
  return model;
}

struct RayArguments {
  LidarModel model = default_rays();
  py::object origins_m = py::none();
  py::object times_s = py::none();
  py::object rings = py::none();
  py::object columns = py::none();

  void take(Keywords& keywords) {
    keywords.take("origins_m", origins_m);
    keywords.take("times_s", times_s);
    keywords.take("rings", rings);
    keywords.take("columns", columns);
    take_common(keywords, model);
  }
};

std::vector<Firing> pattern_of(const Rows& directions, const RayArguments& arguments) {
  const std::size_t count = directions.size();
  directions.require_finite();
  const auto rings = whole_numbers_of<std::uint16_t>(arguments.rings, count, "rings");
  const auto columns = whole_numbers_of<std::uint32_t>(arguments.columns, count, "columns");
  const std::vector<double> times_s = numbers_of(arguments.times_s, count, "times_s");
  std::vector<Firing> pattern(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d direction = directions.vector(i);
    if (!(length(direction) > 0))
      throw py::value_error("directions: row " + std::to_string(i) + " has length 0");
    Firing& firing = pattern[i];
    firing.direction = vec_cast<float>(normalized(direction));
    firing.ring = rings.empty() ? std::uint16_t{0} : rings[i];
    firing.column = columns.empty() ? static_cast<std::uint32_t>(i) : columns[i];
    firing.time_s = times_s.empty() ? 0.0F : static_cast<float>(times_s[i]);
  }
  return pattern;
}

LidarModel from_rays(py::handle directions, const py::kwargs& kwargs) {
  auto arguments = arguments_of<RayArguments>("from_rays", kwargs);
  LidarModel& model = arguments.model;
  check_common(model);
  model.free_pattern = pattern_of(Rows(directions, 3, "directions"), arguments);
  require(!model.free_pattern.empty(), "directions: expected at least one ray");
  if (arguments.origins_m.is_none()) return model;
  const Rows origins(arguments.origins_m, 3, "origins_m");
  require(origins.size() == model.free_pattern.size(), "origins_m: expected one row per ray");
  origins.require_finite();
  for (std::size_t i = 0; i < model.free_pattern.size(); ++i)
    model.free_pattern[i].origin = vec_cast<float>(origins.vector(i));
  return model;
}

LidarModel replaced(const LidarModel& sensor, const py::kwargs& kwargs) {
  Keywords keywords("replaced", kwargs);
  LidarModel model = sensor;
  take_common(keywords, model);
  keywords.finish();
  check_common(model);
  return model;
}

/// The rays of one scan, the owner of array views.
struct Firings {
  std::vector<Firing> firings;
};

constexpr Firing kNoFiring{};

template <class T>
auto firing_view(T Firing::*member) {
  return [member](const py::object& self) {
    const std::vector<Firing>& firings = self.cast<const Firings&>().firings;
    const Firing* const first = firings.empty() ? &kNoFiring : firings.data();
    if constexpr (std::is_same_v<T, Vec3f>) {
      return vectors_view(&(first->*member), firings.size(), sizeof(Firing), self);
    } else {
      return array_view(py::dtype::of<T>(), &(first->*member),
                        {static_cast<py::ssize_t>(firings.size())},
                        {static_cast<py::ssize_t>(sizeof(Firing))}, self);
    }
  };
}

void bind_firings(py::module_& module) {
  py::class_<Firings, std::shared_ptr<Firings>>(
      module, "Firings",
      "The rays of one scan, made by Sensor.firings(). Arrays are read-only views without a copy.")
      .def("__len__", [](const Firings& f) { return f.firings.size(); })
      .def_property_readonly("directions", firing_view(&Firing::direction),
                             "(N, 3) float32, unit vectors in the sensor frame.")
      .def_property_readonly("origins", firing_view(&Firing::origin),
                             "(N, 3) float32, m: start points of the rays in the sensor frame.")
      .def_property_readonly("rings", firing_view(&Firing::ring), "(N,) uint16, 0 the topmost.")
      .def_property_readonly("columns", firing_view(&Firing::column), "(N,) uint32, azimuth steps.")
      .def_property_readonly("times", firing_view(&Firing::time_s),
                             "(N,) float32, s since the start of the scan.");
}

using SensorClass = py::class_<LidarModel, std::shared_ptr<LidarModel>>;

void add_attributes(SensorClass& type) {
  type.def_readonly("name", &LidarModel::name, "Name of the sensor.")
      .def_readonly("source", &LidarModel::source, "Source of its specification.")
      .def_readonly("rotation_hz", &LidarModel::rotation_hz, "Revolutions per second, Hz.")
      .def_readonly("columns", &LidarModel::columns, "Azimuth steps per revolution; 0: none.")
      .def_readonly("min_range_m", &LidarModel::min_range_m,
                    "Minimum range: nearer surfaces return no echo, m.")
      .def_readonly("max_range_m", &LidarModel::max_range_m,
                    "Maximum range: farther surfaces return no echo, m.")
      .def_readonly("range_noise_m", &LidarModel::range_noise_m, "Standard deviation of ranges, m.")
      .def_readonly("angular_noise_rad", &LidarModel::angular_noise_rad,
                    "Standard deviation of angles, rad.")
      .def_readonly("range_resolution_m", &LidarModel::range_resolution_m,
                    "Ranges are multiples of this, m; 0: continuous.")
      .def_readonly("max_returns", &LidarModel::max_returns,
                    "Maximum number of returns per firing.")
      .def_property_readonly("rings", &LidarModel::rings, "Number of beams.")
      .def_property_readonly("rays_per_scan", &LidarModel::rays_per_scan, "Firings per scan.")
      .def_property_readonly(
          "repeats", [](const LidarModel& model) { return repeats(model); },
          "Whether every scan has the same rays.")
      .def_property_readonly("elevations_rad", view_getter(&LidarModel::elevations_rad),
                             "(B,) float64, topmost first; empty for a list of rays or a rosette.")
      .def_property_readonly(
          "range_offsets_m", view_getter(&LidarModel::range_offsets_m),
          "(B,) float64, m, to add to the ranges of each ring of this sensor; empty: not "
          "calibrated.")
      .def_property_readonly(
          "divergence_rad",
          [](const LidarModel& m) {
            return py::make_tuple(m.divergence_rad[0], m.divergence_rad[1]);
          },
          "Full angles of a beam at 1/e2 of its intensity, horizontal and vertical, rad.")
      .def_property_readonly(
          "divergence_kind",
          [](const LidarModel& m) {
            return std::string(word_of(m.divergence_kind, kDivergenceKinds));
          },
          "Definition of the angle in the source: 'fwhm', '1/e2', '1/e2-half' or 'unknown'.");
}

void add_makers(SensorClass& type) {
  type.def_static("from_beams", &from_beams, py::arg("elevations_rad"),
                  documented<BeamArguments>("from_beams", "elevations_rad", kBeamsDoc).c_str())
      .def_static("from_rays", &from_rays, py::arg("directions"),
                  documented<RayArguments>("from_rays", "directions", kRaysDoc).c_str())
      .def("replaced", &replaced,
           "replaced(self, **changes)\n--\n\n"
           "A Sensor with the same rays and other properties: the keywords of from_rays() from "
           "name\n"
           "on. Raises TypeError, ValueError.")
      .def(
          "firings",
          [](const LidarModel& sensor, std::uint64_t scan_index) {
            return std::make_shared<Firings>(Firings{firings_of(sensor, scan_index)});
          },
          py::arg("scan_index") = 0,
          documented("firings", "self, scan_index=0",
                     "The Firings of a scan; scan_index matters if repeats is False.")
              .c_str());
}

}  // namespace

LidarModel sensor_of(py::handle value) {
  if (py::isinstance<LidarModel>(value)) return value.cast<const LidarModel&>();
  if (!is_path(value))
    throw py::type_error("sensor: expected a Sensor, a name or a path, got " + type_name(value));
  return load_lidar_model(path_of(value, "sensor").string());
}

void bind_sensors(py::module_& module) {
  bind_firings(module);
  SensorClass type(module, "Sensor", kSensorsClassDoc);
  type.def(py::init([](py::handle name_or_file) {
             return std::make_shared<LidarModel>(
                 load_lidar_model(path_of(name_or_file, "name_or_file").string()));
           }),
           py::arg("name_or_file"),
           documented("__init__", "self, name_or_file", "See the class.").c_str());
  type.def("__repr__", [](const LidarModel& model) {
    return "<adasplats.Sensor '" + model.name + "' of " + std::to_string(model.rays_per_scan()) +
           " rays per scan>";
  });
  add_attributes(type);
  add_makers(type);
  add_pickling<LidarModel>(type, "Sensor");
  module.def("sensors", &lidar_model_names,
             documented("sensors", "", "Names of the sensors that come with adasplats.").c_str());
}

}  // namespace adasplats::python
