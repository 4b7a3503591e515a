// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <deque>

#include "adasplats/cloud/load/rig.h"
#include "adasplats/jobs/scene/rig_sensors.h"
#include "adasplats/sensors/sensor_overrides.h"
#include "adasplats/simulate/scan/scan_motion.h"
#include "clouds.h"
#include "scans.h"
#include "scenes.h"
#include "sensors.h"
#include "simulate_arguments.h"
#include "trajectories.h"

namespace adasplats::python {
namespace {

constexpr const char* kSimulateDoc = R"(Simulate one Scan at each pose.

sensor: a Sensor, or a name or file as in Sensor(). poses: a Trajectory, or world_from_sensor
(N, 4, 4) or (4, 4), 0.1 s apart. rolling_shutter: the sensor moves during a revolution, along
motion (a Trajectory; None: poses). points: 'raw', as measured, or 'deskewed'. noise: apply the
noise of the sensor. range_noise (standard deviation, m), min_range, max_range (m) and rotation_rate
(Hz) replace those of the sensor. depth: number of splats along a ray; their weighted mean is the
echo. sub_rays: rays across the cross-section of a beam. returns: maximum per firing. return_mode:
'strongest', 'first' or 'last'. ray_drop: a file of 'adasplats fit-drop'. rain, snow: mm/h. fog:
visibility, m. seed: of all random numbers. first_number: number of the first scan, which random
numbers depend on. Results do not depend on threads or device. Returns Scans. Raises TypeError,
ValueError, OSError.)";

constexpr const char* kRigDoc = R"(Simulate all sensors of a vehicle: {name: Scans}.

rig: path of a rig file (docs/sensors.md), which has the sensors, their mounts, clocks and what hides
them. poses, motion: of the vehicle. The times of scans are those of the sensors' clocks. The other
keywords are those of simulate() and apply to every sensor. Raises TypeError, ValueError, OSError.)";

constexpr const char* kIterDoc =
    R"(As simulate(), but an iterator that makes the scans on demand and holds only a few in memory.)";

/// Scans per call on a GPU, for overlapping launches and copies.
constexpr std::size_t kGpuBatch = 16;

/// The arguments of a call: settings and motion of every scan.
struct Drive {
  SimulateArguments arguments;
  ScanSettings settings;
  std::vector<ScanMotion> scans;

  Drive(const char* function, py::handle sensor, py::handle poses, const py::kwargs& kwargs) {
    arguments = arguments_of<SimulateArguments>(function, kwargs);
    settings = arguments.scan.settings_of(sensor_of(sensor), arguments.seed);
    scans = arguments.drive.scans_at(poses, settings.sensor);
  }
};

/// The scans of one sensor; without the GIL. `time_offset_s`: subtracted from their times.
std::shared_ptr<ScanList> simulated(const SceneObject& object, ScanSettings settings,
                                    std::span<const ScanMotion> scans, std::uint64_t first_number,
                                    double time_offset_s, ProgressSink& progress) {
  auto list = std::make_shared<ScanList>();
  ScanSimulator simulator(*object.scene, std::move(settings), object.executor);
  list->image_size = image_size_of(simulator.firings());
  if (const LabelScheme* labels = object.scene->labels())
    list->labels = std::make_shared<LabelScheme>(*labels);
  progress.begin_step("simulate", scans.size());
  simulator.run(scans, first_number, [&](std::size_t i, Scan scan) {
    scan.time_s -= time_offset_s;
    list->scans.push_back(std::make_shared<Scan>(std::move(scan)));
    progress.advance(i + 1);
  });
  progress.end_step();
  return list;
}

std::shared_ptr<ScanList> simulate(const std::shared_ptr<SceneObject>& object, py::handle sensor,
                                   py::handle poses, const py::kwargs& kwargs) {
  Drive drive("simulate", sensor, poses, kwargs);
  PythonProgress progress(drive.arguments.progress);
  const py::gil_scoped_release released;
  const auto lock = object->lock();
  return simulated(*object, std::move(drive.settings), drive.scans, drive.arguments.first_number, 0,
                   progress);
}

py::dict simulate_rig(const std::shared_ptr<SceneObject>& object, py::handle rig, py::handle poses,
                      const py::kwargs& kwargs) {
  const auto arguments = arguments_of<SimulateArguments>("simulate_rig", kwargs);
  std::vector<MountedSensor> sensors =
      sensors_of_rig(read_rig_to_simulate(path_of(rig, "rig")), arguments.scan, arguments.seed);
  for (MountedSensor& sensor : sensors)
    sensor.scans = arguments.drive.scans_at(poses, sensor.settings.sensor, sensor.mount);
  PythonProgress progress(arguments.progress);
  py::dict lists;
  for (MountedSensor& sensor : sensors) {
    std::shared_ptr<ScanList> list = [&] {
      const py::gil_scoped_release released;
      const auto lock = object->lock();
      return simulated(*object, std::move(sensor.settings), sensor.scans, arguments.first_number,
                       sensor.time_offset_s, progress);
    }();
    lists[sensor.name.c_str()] = std::move(list);
  }
  return lists;
}

/// Makes the scans of a drive one by one.
class ScanIterator {
 public:
  ScanIterator(std::shared_ptr<SceneObject> object, Drive&& drive)
      : object_(std::move(object)),
        scans_(std::move(drive.scans)),
        first_number_(drive.arguments.first_number),
        progress_(drive.arguments.progress),
        simulator_(*object_->scene, std::move(drive.settings), object_->executor) {
    progress_.begin_step("simulate", scans_.size());
  }

  std::shared_ptr<Scan> next() {
    std::shared_ptr<Scan> scan = [this] {
      const py::gil_scoped_release released;
      return next_without_gil();
    }();
    if (!scan) throw py::stop_iteration();
    return scan;
  }

 private:
  std::shared_ptr<Scan> next_without_gil() {
    const std::scoped_lock one_at_a_time(mutex_);
    if (ready_.empty() && taken_ < scans_.size()) simulate_batch();
    if (ready_.empty()) return nullptr;
    std::shared_ptr<Scan> scan = std::move(ready_.front());
    ready_.pop_front();
    return scan;
  }

  void simulate_batch() {
    const auto lock = object_->lock();
    const std::size_t max_count = object_->scene->on_gpu() ? kGpuBatch : 1;
    const std::size_t count = std::min(max_count, scans_.size() - taken_);
    simulator_.run(std::span(scans_).subspan(taken_, count), first_number_ + taken_,
                   [this](std::size_t, Scan scan) {
                     ready_.push_back(std::make_shared<Scan>(std::move(scan)));
                   });
    taken_ += count;
    progress_.advance(taken_);
  }

  std::shared_ptr<SceneObject> object_;
  std::vector<ScanMotion> scans_;
  std::uint64_t first_number_;
  PythonProgress progress_;
  ScanSimulator simulator_;
  std::size_t taken_ = 0;
  std::deque<std::shared_ptr<Scan>> ready_;
  std::mutex mutex_;
};

std::string doc_of(const char* name, const char* text) {
  return documented<SimulateArguments>(name, "self, sensor, poses", text);
}

}  // namespace

void DriveArguments::take(Keywords& keywords) {
  keywords.take("motion", motion);
  keywords.take("rolling_shutter", rolling_shutter);
}

std::vector<ScanMotion> DriveArguments::scans_at(py::handle poses, const LidarModel& sensor,
                                                 const RigidTransform& mount) const {
  const Trajectory at = mounted(trajectory_of(poses, "poses"), mount);
  if (!rolling_shutter) {
    if (!motion.is_none()) throw py::value_error("motion needs rolling_shutter=True");
    return still_scans(at);
  }
  const Trajectory moves = motion.is_none() ? at : mounted(trajectory_of(motion, "motion"), mount);
  if (moves.size() < 2)
    throw py::value_error("rolling_shutter needs at least two poses for the motion");
  if (fires_at_once(sensor)) return still_scans(at);
  const double duration_s = 1 / sensor.rotation_hz;
  if (const std::string note = motion_ends_note(at, moves, duration_s); !note.empty())
    if (PyErr_WarnEx(PyExc_UserWarning, note.c_str(), 1) != 0) throw py::error_already_set();
  return moving_scans(at, moves, duration_s);
}

void add_simulation(SceneClass& type) {
  py::class_<ScanIterator, std::shared_ptr<ScanIterator>>(type, "ScanIterator",
                                                          "Iterator of Scene.iter_scans().")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &ScanIterator::next);
  type.def("simulate", &simulate, py::arg("sensor"), py::arg("poses"),
           doc_of("simulate", kSimulateDoc).c_str());
  type.def("simulate_rig", &simulate_rig, py::arg("rig"), py::arg("poses"),
           documented<SimulateArguments>("simulate_rig", "self, rig, poses", kRigDoc).c_str());
  type.def(
      "iter_scans",
      [](const std::shared_ptr<SceneObject>& object, py::handle sensor, py::handle poses,
         const py::kwargs& kwargs) {
        object->require_own_process();
        return std::make_shared<ScanIterator>(object, Drive("iter_scans", sensor, poses, kwargs));
      },
      py::arg("sensor"), py::arg("poses"), doc_of("iter_scans", kIterDoc).c_str());
}

}  // namespace adasplats::python
