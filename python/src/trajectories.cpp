// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "trajectories.h"

#include <pybind11/stl.h>

#include "adasplats/jobs/output/output_check.h"
#include "adasplats/jobs/session/inputs.h"
#include "bindings.h"
#include "clouds.h"
#include "pickles.h"

namespace adasplats::python {
namespace {

/// A wrapper, because pybind11 converts a vector to a list.
struct TrajectoryObject {
  Trajectory poses;
};

template <class Archive>
void fields(Archive& archive, TrajectoryObject& trajectory) {
  archive("poses", trajectory.poses);
}

constexpr double kPeriod_s = 0.1;  // as in read_trajectory() for poses without times

constexpr const char* kTrajectoriesDoc = R"(Poses of a sensor over time.

poses: (N, 4, 4) or (4, 4), world_from_sensor: x forward, y left, z up, m. times: (N,), s, ascending;
None: 0.1 s apart. Raises TypeError, ValueError (a matrix that is not a rotation and translation;
times that do not ascend).)";

Trajectory make_trajectory(py::handle poses, py::handle times) {
  const std::vector<RigidTransform> transforms = transforms_of(poses, "poses");
  const std::vector<double> times_s = numbers_of(times, transforms.size(), "times");
  Trajectory trajectory;
  for (std::size_t i = 0; i < transforms.size(); ++i) {
    const double time_s = times.is_none() ? kPeriod_s * static_cast<double>(i) : times_s[i];
    if (i > 0 && !(time_s > trajectory.back().time_s))
      throw py::value_error("times[" + std::to_string(i) + "] does not ascend");
    trajectory.push_back({time_s, transforms[i]});
  }
  return trajectory;
}

py::array poses_of(const TrajectoryObject& trajectory) {
  std::vector<RigidTransform> transforms;
  for (const TimedPose& pose : trajectory.poses) transforms.push_back(pose.world_from_sensor);
  return matrices_of(transforms);
}

py::array times_of(const TrajectoryObject& trajectory) {
  std::vector<double> times;
  for (const TimedPose& pose : trajectory.poses) times.push_back(pose.time_s);
  const auto count = static_cast<py::ssize_t>(times.size());
  return owned_array(std::move(times), {count});
}

TrajectoryObject resampled(const TrajectoryObject& trajectory, std::optional<double> rate_hz,
                           std::optional<double> spacing_m) {
  if (rate_hz.has_value() == spacing_m.has_value())
    throw py::type_error("resampled() needs either rate_hz or spacing_m");
  return {rate_hz ? resampled_by_time(trajectory.poses, *rate_hz)
                  : resampled_by_distance(trajectory.poses, *spacing_m)};
}

TrajectoryObject taken(const TrajectoryObject& trajectory, const py::slice& slice) {
  std::size_t start = 0, stop = 0, step = 0, count = 0;
  if (!slice.compute(trajectory.poses.size(), &start, &stop, &step, &count))
    throw py::error_already_set();
  if (static_cast<py::ssize_t>(step) < 1)
    throw py::value_error("the step of a slice of a trajectory must be positive");
  TrajectoryObject part;
  for (std::size_t k = 0; k < count; ++k) part.poses.push_back(trajectory.poses[start + k * step]);
  return part;
}

py::array pose_at_time(const TrajectoryObject& trajectory, double time_s) {
  if (trajectory.poses.empty()) throw py::value_error("an empty trajectory has no pose");
  return matrix_of(interpolate(trajectory.poses, time_s));
}

using TrajectoryClass = py::class_<TrajectoryObject>;

/// Methods that make another trajectory or a pose.
void add_transformations(TrajectoryClass& type) {
  type.def("resampled", &resampled, py::kw_only(), py::arg("rate_hz") = py::none(),
           py::arg("spacing_m") = py::none(),
           documented("resampled", "self, *, rate_hz=None, spacing_m=None",
                      "A Trajectory of interpolated poses, rate_hz per second or spacing_m apart "
                      "along the path.\nRaises TypeError, ValueError.")
               .c_str())
      .def(
          "shifted",
          [](const TrajectoryObject& t, py::handle offset) {
            return TrajectoryObject{adasplats::shifted(t.poses, vector_of(offset, "offset"))};
          },
          py::arg("offset"),
          documented("shifted", "self, offset",
                     "A Trajectory with every pose moved by offset, (3,) m, along the world axes.\n"
                     "Raises TypeError, ValueError.")
              .c_str())
      .def(
          "mounted",
          [](const TrajectoryObject& t, py::handle vehicle_from_sensor) {
            const auto mounts = transforms_of(vehicle_from_sensor, "vehicle_from_sensor");
            if (mounts.size() != 1)
              throw py::value_error("vehicle_from_sensor: expected shape (4, 4)");
            return TrajectoryObject{adasplats::mounted(t.poses, mounts.front())};
          },
          py::arg("vehicle_from_sensor"),
          documented("mounted", "self, vehicle_from_sensor",
                     "The Trajectory of a sensor mounted on a vehicle with this trajectory.\n"
                     "vehicle_from_sensor: (4, 4). Raises TypeError, ValueError.")
              .c_str())
      .def("interpolate", &pose_at_time, py::arg("time"),
           documented(
               "interpolate", "self, time",
               "The pose at a time (s): (4, 4) float64, interpolated; the first or last pose "
               "outside\nthe times of the trajectory. Raises ValueError (an empty trajectory).")
               .c_str());
}

}  // namespace

Trajectory trajectory_of(py::handle value, const char* name) {
  if (py::isinstance<TrajectoryObject>(value)) return value.cast<const TrajectoryObject&>().poses;
  Trajectory trajectory;
  for (const RigidTransform& pose : transforms_of(value, name))
    trajectory.push_back({kPeriod_s * static_cast<double>(trajectory.size()), pose});
  return trajectory;
}

py::object trajectory_object(Trajectory poses) {
  return py::cast(TrajectoryObject{std::move(poses)});
}

void bind_trajectories(py::module_& module) {
  TrajectoryClass type(module, "Trajectory", kTrajectoriesDoc);
  type.def(py::init([](py::handle poses, py::handle times) {
             return TrajectoryObject{make_trajectory(poses, times)};
           }),
           py::arg("poses"), py::arg("times") = py::none(),
           documented("__init__", "self, poses, times=None", "See the class.").c_str())
      .def_static(
          "read",
          [](py::handle path) { return TrajectoryObject{load_trajectory(path_of(path, "path"))}; },
          py::arg("path"),
          documented("read", "path",
                     "Read a KITTI poses.txt, a CSV with the first line time,x,y,z,qw,qx,qy,qz, a "
                     "TUM file\n"
                     "with its header line, or a sequence folder.\n"
                     "Raises TypeError, FileNotFoundError, ValueError.")
              .c_str())
      .def(
          "save",
          [](const TrajectoryObject& trajectory, py::handle path) {
            const std::filesystem::path file = path_of(path, "path");
            require_ending(file, ".csv");
            write_trajectory_csv(file, trajectory.poses);
          },
          py::arg("path"),
          documented("save", "self, path",
                     "Write a .csv with 9 decimals. Raises TypeError, OSError, ValueError\n"
                     "(another extension).")
              .c_str())
      .def("__len__", [](const TrajectoryObject& t) { return t.poses.size(); })
      .def("__repr__",
           [](const TrajectoryObject& t) {
             return "<adasplats.Trajectory of " + std::to_string(t.poses.size()) + " poses>";
           })
      .def("__getitem__", &taken, py::arg("slice"), "A slice, as a Trajectory.")
      .def_property_readonly("poses", &poses_of,
                             "(N, 4, 4) float64, world_from_sensor: a new array.")
      .def_property_readonly("times", &times_of, "(N,) float64, s: a new array.");
  add_transformations(type);
  add_pickling<TrajectoryObject>(type, "Trajectory");
}

}  // namespace adasplats::python
