// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds.h"

#include <algorithm>

#include "adasplats/jobs/output/output_check.h"
#include "bindings.h"
#include "crs.h"
#include "pickles.h"
#include "work.h"

namespace adasplats {

template <class Archive>
void fields(Archive& archive, CloudSensor& sensor) {
  archive("name", sensor.name);
  archive("scans", sensor.scans);
  archive("is_in_model", sensor.is_in_model);
  archive("unknown_sweep_m", sensor.unknown_sweep_m);
}

template <class Archive>
void fields(Archive& archive, PointCloud& cloud) {
  archive("origin", cloud.origin);
  archive("crs", cloud.crs);
  archive("positions", cloud.positions);
  for_each_attribute([&](const auto& attribute) { archive(attribute.name, attribute.of(cloud)); });
  archive("scan_poses", cloud.scan_poses);
  archive("sensors", cloud.sensors);
}

}  // namespace adasplats

namespace adasplats::python {
namespace {

constexpr const char* kReadDoc =
    R"(Read point files and SemanticKITTI sequence folders into one PointCloud.

paths: a path or a list of them (PLY, PCD, LAS/LAZ, E57, KITTI bin, text, npy, a sequence folder, a
folder of point files). The keywords are the options of 'adasplats model' for loading. first_scan,
scan_count (None: all) and scan_stride choose scans of a sequence. viewpoint, (3,) m, or trajectory
(a path) gives the sensor positions. label_field: name of the column of classes.
Points that are not finite or too far away are dropped with a warning. A share of them above
max_dropped is an error; with strict, any point that is not finite is one. Unknown intensities are
NaN. Points on the recording vehicle are removed: those that move with the sensor, or all within
own_body_m of it (0 keeps all). So are points within driven_path_m of the driven path (0 keeps them).
Raises TypeError, FileNotFoundError, ValueError (wrong content of a file), OSError.)";

constexpr const char* kCloudDoc = R"(Points of one or many scans.

positions: (N, 3), world coordinates, m, any numeric dtype. classes, instances: (N,) integers from 0
to 65535. intensities: (N,), NaN if unknown. sensor_positions: (N, 3), world coordinates, m, of the
LiDAR when it measured each point; without them normals cannot be oriented, and the model cannot be
checked against rays.
origin_kinds: (N,), the source of each sensor position: 0 unknown, 1 guessed (only used to orient
normals), 2 stated, 3 measured; None: all measured.
scan_indices: (N,), integers >= 0. origin: (3,), m; positions are stored as float32 relative to it;
None: chosen from the extent of the points. crs_wkt: coordinate system of the world as well-known
text; models and files keep it. Arrays are read-only views without a copy; missing attributes are
None. Raises TypeError, ValueError (with the first row that is not finite).)";

struct ReadArguments {
  LoadOptions load;
  WorkOptions work{.has_device = false};

  void take(Keywords& keywords) {
    take_load_options(keywords, load);
    work.take(keywords);
  }
};

std::shared_ptr<PointCloud> read(py::handle paths, const py::kwargs& kwargs) {
  const auto arguments = arguments_of<ReadArguments>("read", kwargs);
  const auto inputs = paths_of(paths, "paths");
  Work work(arguments.work);
  return work.run([&](Session& session) {
    return std::make_shared<PointCloud>(
        load_cloud(inputs, arguments.load, session.executor, session.progress).first);
  });
}

std::vector<Vec3f> relative(const Rows& world, Vec3d origin) {
  std::vector<Vec3f> vectors(world.size());
  for (std::size_t i = 0; i < vectors.size(); ++i)
    vectors[i] = vec_cast<float>(world.vector(i) - origin);
  return vectors;
}

std::shared_ptr<PointCloud> make_cloud(py::handle positions, py::handle classes,
                                       py::handle instances, py::handle intensities,
                                       py::handle sensor_positions, py::handle origin_kinds,
                                       py::handle scan_indices, py::handle origin,
                                       const std::string& crs_wkt) {
  auto cloud = std::make_shared<PointCloud>();
  cloud->crs = crs_of_wkt(crs_wkt);
  LocalVectors local = local_vectors(Rows(positions, 3, "positions"), origin);
  cloud->origin = local.origin;
  cloud->positions = std::move(local.vectors);
  const std::size_t count = cloud->size();
  cloud->classes = whole_numbers_of<std::uint16_t>(classes, count, "classes");
  cloud->instances = whole_numbers_of<std::uint16_t>(instances, count, "instances");
  cloud->scan_indices = whole_numbers_of<std::uint32_t>(scan_indices, count, "scan_indices");
  const std::vector<double> measured =
      numbers_of(intensities, count, "intensities", NotANumber::is_unknown);
  cloud->intensities.assign(measured.begin(), measured.end());
  if (sensor_positions.is_none()) {
    if (!origin_kinds.is_none()) throw py::value_error("origin_kinds needs sensor_positions");
    return cloud;
  }
  const Rows sensors(sensor_positions, 3, "sensor_positions");
  if (sensors.size() != count || (sensors.is_single() && count == 1))
    throw py::value_error("sensor_positions: expected shape (" + std::to_string(count) +
                          ", 3), one row per point");
  sensors.require_finite();
  cloud->sensor_positions = relative(sensors, cloud->origin);
  for (const auto kind : whole_numbers_of<std::uint16_t>(origin_kinds, count, "origin_kinds")) {
    if (kind > static_cast<std::uint16_t>(OriginKind::measured))
      throw py::value_error("origin_kinds: expected numbers from 0 to 3, got " +
                            std::to_string(kind));
    cloud->origin_kinds.push_back(static_cast<OriginKind>(kind));
  }
  return cloud;
}

py::array world_positions(const PointCloud& cloud) {
  std::vector<Vec3d> world(cloud.size());
  for (std::size_t i = 0; i < world.size(); ++i) world[i] = cloud.world(i);
  const auto count = static_cast<py::ssize_t>(world.size());
  std::vector<double> numbers(3 * world.size());
  if (!world.empty()) __builtin_memcpy(numbers.data(), world.data(), numbers.size() * 8);
  return owned_array(std::move(numbers), {count, 3});
}

}  // namespace

LocalVectors local_vectors(const Rows& world, py::handle origin) {
  world.require_finite();
  LocalVectors local;
  if (!origin.is_none()) {
    local.origin = vector_of(origin, "origin");
  } else if (world.size() > 0) {
    Vec3d low = world.vector(0);
    Vec3d high = low;
    for (std::size_t i = 1; i < world.size(); ++i) {
      low = min(low, world.vector(i));
      high = max(high, world.vector(i));
    }
    local.origin = choose_origin(low, high);
  }
  local.vectors = relative(world, local.origin);
  return local;
}

void take_scan_range(Keywords& keywords, ScanRange& range, const std::string& prefix) {
  std::optional<double> count;
  keywords.take((prefix + "first_scan").c_str(), range.first);
  keywords.take((prefix + "scan_count").c_str(), count);
  keywords.take((prefix + "scan_stride").c_str(), range.stride);
  if (count) range.count = static_cast<std::size_t>(std::max(0.0, *count));
}

void take_load_options(Keywords& keywords, LoadOptions& options) {
  take_settings(keywords, options, &Setting::key);
  keywords.take("sensor_x_field", options.sensor_x_field);
  keywords.take("sensor_y_field", options.sensor_y_field);
  keywords.take("sensor_z_field", options.sensor_z_field);
  ScanRange scans{options.first_scan, options.scan_count, options.scan_stride};
  take_scan_range(keywords, scans);
  options.first_scan = scans.first;
  options.scan_count = scans.count;
  options.scan_stride = scans.stride;
}

namespace {

using CloudClass = py::class_<PointCloud, std::shared_ptr<PointCloud>>;

void bind_attributes(CloudClass& type) {
  for_each_attribute([&](const auto& attribute) {
    const auto of = attribute.of;
    using Values = std::decay_t<decltype(of(std::declval<const PointCloud&>()))>;
    type.def_property_readonly(
        attribute.name,
        [of](const py::object& self) {
          const auto& cloud = self.cast<const PointCloud&>();
          return optional_view(of(cloud), cloud.size(), self);
        },
        (shape_and_type<typename Values::value_type>() + attribute.about + "; or None.").c_str());
  });
  type.def_property_readonly("positions", view_getter(&PointCloud::positions),
                             "(N, 3) float32, m, relative to origin.")
      .def_property_readonly(
          "origin", [](const PointCloud& cloud) { return array_of(cloud.origin); },
          "(3,) float64, world coordinates of the local origin, m.")
      .def_property_readonly("world_positions", &world_positions,
                             "(N, 3) float64, origin + positions: a new array.");
}

}  // namespace

void bind_clouds(py::module_& module) {
  const std::string init_doc = documented(
      "__init__",
      "self, positions, *, classes=None, instances=None, intensities=None, sensor_positions=None, "
      "origin_kinds=None, scan_indices=None, origin=None, crs_wkt=''",
      "See the class.");
  CloudClass type(module, "PointCloud", kCloudDoc);
  type.def(py::init(&make_cloud), py::arg("positions"), py::kw_only(),
           py::arg("classes") = py::none(), py::arg("instances") = py::none(),
           py::arg("intensities") = py::none(), py::arg("sensor_positions") = py::none(),
           py::arg("origin_kinds") = py::none(), py::arg("scan_indices") = py::none(),
           py::arg("origin") = py::none(), py::arg("crs_wkt") = "", init_doc.c_str())
      .def("__len__", &PointCloud::size)
      .def("__repr__",
           [](const PointCloud& cloud) {
             return "<adasplats.PointCloud of " + std::to_string(cloud.size()) + " points>";
           })
      .def(
          "save",
          [](const PointCloud& cloud, py::handle path) {
            const std::filesystem::path file = path_of(path, "path");
            require_ending(file, ".ply");
            const py::gil_scoped_release released;
            save_cloud_ply(file, cloud);
          },
          py::arg("path"),
          documented("save", "self, path",
                     "Write a .ply with every attribute; no partial file remains after an error.\n"
                     "Raises TypeError, OSError, ValueError (another extension).")
              .c_str());

  bind_attributes(type);
  add_crs(type, [](const PointCloud& cloud) -> const Crs& { return cloud.crs; });
  add_pickling<PointCloud>(type, "PointCloud");

  module.def("read", &read, py::arg("paths"),
             documented<ReadArguments>("read", "paths", kReadDoc).c_str());
}

}  // namespace adasplats::python
