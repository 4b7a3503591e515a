// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cameras.h"

#include <memory>
#include <string>
#include <vector>

#include "arrays.h"
#include "keywords.h"
#include "pickles.h"

namespace adasplats {

template <class Archive>
void fields(Archive& archive, MountedCamera& camera) {
  archive("name", camera.name);
  archive("lens", camera.lens);
  archive("mount", camera.vehicle_from_camera);
}

}  // namespace adasplats

namespace adasplats::python {
namespace {

constexpr const char* kCameraClassDoc =
    R"(A camera with a lens, mounted on a vehicle or sensor.

file: TOML, CameraInfo of ROS (YAML, JSON) or a calibration of KITTI; 'FILE:NAME' chooses one of
several cameras (docs/pictures.md). Raises TypeError, ValueError, FileNotFoundError.)";

constexpr const char* kMatrixDoc = R"(A camera from its intrinsics.

matrix: (3, 3), fx 0 cx; 0 fy cy; 0 0 1, pixels; integer coordinates are pixel centres, as in
OpenCV. width, height: pixels. model: 'none', 'brown_conrady' (k1, k2, p1, p2, k3), 'rational' (k1,
k2, p1, p2, k3, k4, k5, k6) or 'fisheye' (k1 to k4), or their names in ROS. coefficients: in that
order. mount: (4, 4) vehicle_from_camera; camera: x forward, y left, z up. Returns a Camera. Raises
TypeError, ValueError.)";

struct MatrixArguments {
  std::string model = "none";
  py::object coefficients = py::none();
  py::object mount = py::none();
  std::string name = "camera";

  void take(Keywords& keywords) {
    keywords.take("model", model);
    keywords.take("coefficients", coefficients);
    keywords.take("mount", mount);
    keywords.take("name", name);
  }
};

MountedCamera from_matrix(py::handle matrix, int width, int height, const py::kwargs& kwargs) {
  const auto arguments = arguments_of<MatrixArguments>("from_matrix", kwargs);
  const Rows rows(matrix, 3, "matrix");
  if (rows.size() != 3) throw py::value_error("matrix: expected shape (3, 3)");
  std::vector<double> values;
  for (std::size_t i = 0; i < 9; ++i) values.push_back(rows.at(i / 3, i % 3));
  MountedCamera camera;
  camera.name = arguments.name;
  camera.lens = pinhole_lens(values, arguments.name + ": matrix");
  camera.lens.width = width;
  camera.lens.height = height;
  std::vector<double> coefficients;
  if (!arguments.coefficients.is_none())
    coefficients =
        numbers_of(arguments.coefficients, py::len(arguments.coefficients), "coefficients");
  camera.lens = distorted_lens(camera.lens, arguments.model, coefficients, arguments.name);
  if (arguments.mount.is_none()) return camera;
  const std::vector<RigidTransform> mounts = transforms_of(arguments.mount, "mount");
  if (mounts.size() != 1) throw py::value_error("mount: expected shape (4, 4)");
  camera.vehicle_from_camera = mounts.front();
  return camera;
}

/// Directions through the centres of all pixels.
py::array directions_of(const MountedCamera& camera) {
  const Lens& lens = camera.lens;
  std::vector<double> values;
  for (int v = 0; v < lens.height; ++v)
    for (int u = 0; u < lens.width; ++u) {
      const Vec3d direction = kCameraFromOptical * lens.direction(u, v);
      for (int axis = 0; axis < 3; ++axis) values.push_back(direction[axis]);
    }
  return owned_array(std::move(values), {lens.height, lens.width, 3});
}

py::array matrix_of_lens(const MountedCamera& camera) {
  const Lens& lens = camera.lens;
  return owned_array(std::vector<double>{lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1},
                     {3, 3});
}

}  // namespace

MountedCamera camera_of(py::handle value) {
  if (py::isinstance<MountedCamera>(value)) return value.cast<const MountedCamera&>();
  if (!is_path(value))
    throw py::type_error("camera: expected a Camera or a path, got " + type_name(value));
  return load_camera(path_of(value, "camera").string());
}

void bind_cameras(py::module_& module) {
  py::class_<MountedCamera, std::shared_ptr<MountedCamera>> type(module, "Camera", kCameraClassDoc);
  type.def(py::init([](py::handle file) {
             return std::make_shared<MountedCamera>(load_camera(path_of(file, "file").string()));
           }),
           py::arg("file"), documented("__init__", "self, file", "See the class.").c_str());
  type.def("__repr__", [](const MountedCamera& camera) {
    return "<adasplats.Camera '" + camera.name + "' of " + std::to_string(camera.lens.width) +
           " x " + std::to_string(camera.lens.height) + " pixels>";
  });
  type.def_static(
      "from_matrix", &from_matrix, py::arg("matrix"), py::arg("width"), py::arg("height"),
      documented<MatrixArguments>("from_matrix", "matrix, width, height", kMatrixDoc).c_str());
  type.def_readonly("name", &MountedCamera::name, "Name of the camera.")
      .def_property_readonly(
          "width", [](const MountedCamera& camera) { return camera.lens.width; },
          "Width of the picture, pixels.")
      .def_property_readonly(
          "height", [](const MountedCamera& camera) { return camera.lens.height; },
          "Height of the picture, pixels.")
      .def_property_readonly("matrix", &matrix_of_lens,
                             "(3, 3) float64, new: fx 0 cx; 0 fy cy; 0 0 1, pixels.")
      .def_property_readonly(
          "mount",
          [](const MountedCamera& camera) { return matrix_of(camera.vehicle_from_camera); },
          "(4, 4) float64, new: vehicle_from_camera; camera: x forward, y left, z up.")
      .def("directions", &directions_of,
           documented("directions", "self",
                      "Unit vectors through the centres of all pixels in the frame of the camera, "
                      "x forward, y left,\nz up: (height, width, 3) float64, new. 0 where the lens "
                      "shows nothing.")
               .c_str());
  add_pickling<MountedCamera>(type, "Camera");
}

}  // namespace adasplats::python
