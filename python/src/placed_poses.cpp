// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/scene/placed_poses.h"

#include <cmath>

#include "adasplats/jobs/scene/drive.h"
#include "scenes.h"
#include "trajectories.h"
#include "work.h"

namespace adasplats::python {
namespace {

constexpr const char* kPosesAtDoc =
    R"(Make level poses at positions, 0.1 s apart: a Trajectory for simulate().

places: (N, 2), (N, 3) or (N, 4): x, y[, z[, yaw]] in world coordinates, m and degrees. If z is
missing or NaN, the pose is height (m) above the ground of the scene (docs/formats.md).
Raises TypeError, ValueError (no ground at a position).)";

constexpr const char* kPosesOnPathDoc =
    R"(Make level poses along a polyline above the ground, facing ahead: a Trajectory for simulate().

corners: (N, 2) x, y in world coordinates, m. height: above the ground of the scene, m. speed: m/s.
rate: poses per second. spacing: distance between poses, m, in place of rate.
Raises TypeError, ValueError (no ground at a pose).)";

/// At least one row of `min` to `max` numbers. Errors: TypeError, ValueError.
py::array_t<double> rows_of(py::handle value, const char* name, py::ssize_t min, py::ssize_t max) {
  const auto rows = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!rows) {
    PyErr_Clear();
    throw py::type_error(std::string(name) + ": expected an array of numbers");
  }
  if (rows.ndim() != 2 || rows.shape(0) == 0 || rows.shape(1) < min || rows.shape(1) > max)
    throw py::value_error(std::string(name) + ": expected shape (N, " + std::to_string(min) +
                          (min == max ? ")" : ") to (N, " + std::to_string(max) + ")"));
  return rows;
}

py::object poses_at_places(const std::shared_ptr<SceneObject>& object, py::handle places,
                           double height_m) {
  const py::array_t<double> rows = rows_of(places, "places", 2, 4);
  const auto numbers = rows.unchecked<2>();
  DriveOptions drive;
  for (py::ssize_t i = 0; i < numbers.shape(0); ++i) {
    SensorPlace place{numbers(i, 0), numbers(i, 1), {}, 0};
    if (numbers.shape(1) > 2 && !std::isnan(numbers(i, 2))) place.z_m = numbers(i, 2);
    if (numbers.shape(1) > 3) place.yaw_deg = numbers(i, 3);
    drive.at.push_back(place);
  }
  drive.height_m = height_m;
  check_drive(drive);
  Trajectory poses;
  PythonProgress progress{py::none()};
  {
    const py::gil_scoped_release released;
    const auto lock = object->lock();
    poses = poses_at(*object->scene, drive.at, height_m, object->executor, progress);
  }
  progress.issue_warnings();
  return trajectory_object(std::move(poses));
}

py::object poses_on_corners(const std::shared_ptr<SceneObject>& object, py::handle corners,
                            double speed, double rate, std::optional<double> spacing,
                            double height_m) {
  const py::array_t<double> rows = rows_of(corners, "corners", 2, 2);
  const auto numbers = rows.unchecked<2>();
  DriveOptions drive;
  for (py::ssize_t i = 0; i < numbers.shape(0); ++i)
    drive.path.push_back({numbers(i, 0), numbers(i, 1)});
  drive.speed_mps = speed;
  drive.height_m = height_m;
  drive.spacing_m = spacing;
  if (!spacing) drive.rate_hz = rate;
  check_drive(drive);
  Trajectory poses;
  PythonProgress progress{py::none()};
  {
    const py::gil_scoped_release released;
    const auto lock = object->lock();
    poses = poses_on_path(*object->scene, drive.path, {height_m, speed, rate, spacing},
                          object->executor, progress);
  }
  progress.issue_warnings();
  return trajectory_object(std::move(poses));
}

}  // namespace

void add_placed_poses(SceneClass& type) {
  type.def("poses_at", &poses_at_places, py::arg("places"), py::kw_only(),
           py::arg("height") = kRoofHeight_m,
           documented("poses_at", "self, places, *, height=1.73", kPosesAtDoc).c_str())
      .def("poses_on_path", &poses_on_corners, py::arg("corners"), py::kw_only(),
           py::arg("speed") = kTownSpeed_mps, py::arg("rate") = kUsualRate_hz,
           py::arg("spacing") = py::none(), py::arg("height") = kRoofHeight_m,
           documented("poses_on_path",
                      "self, corners, *, speed=10.0, rate=10.0, spacing=None, height=1.73",
                      kPosesOnPathDoc)
               .c_str());
}

}  // namespace adasplats::python
