// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>

#include "adasplats/simulate/scan/scan_batch.h"
#include "arrays.h"
#include "device_arrays.h"
#include "scenes.h"
#include "sensors.h"
#include "simulate_arguments.h"

namespace adasplats::python {
namespace {

constexpr const char* kBatchesDoc =
    R"(As simulate(), but an iterator of batches without copies, made in a background thread.

fields: names of the attributes of ScanBatch to compute; None: all. on_device: leave the arrays in
GPU memory. On a GPU a batch has as many scans as a launch; on the CPU it has one. The scans are the
same as those of simulate(). Raises TypeError, ValueError, OSError, RuntimeError (on_device with a
scene on the CPU).)";

constexpr const char* kBatchDoc =
    R"(Scans in consecutive arrays, made by Scene.scan_batches(): scan i has the returns offsets[i] to
offsets[i + 1] - 1. Arrays are read-only views, or DeviceArrays in GPU memory for DLPack
(torch.from_dlpack); attributes that were not requested or that the scene lacks are None.)";

/// A batch with the scene whose GPU may hold it. May be freed without the GIL.
struct BatchObject {
  std::shared_ptr<SceneObject> scene;
  ScanBatch batch;
};
using Batch = std::shared_ptr<BatchObject>;

/// Thrown to end the thread of an iterator that was deleted.
struct Abandoned {};

/// Makes batches in a thread, up to two in advance.
class BatchStream {
 public:
  BatchStream(std::shared_ptr<SceneObject> scene, ScanSettings settings,
              std::vector<ScanMotion> scans, std::uint64_t first_number, BatchMemory memory)
      : scene_(std::move(scene)),
        simulator_(*scene_->scene, std::move(settings), scene_->executor),
        scans_(std::move(scans)),
        first_number_(first_number),
        memory_(memory),
        thread_([this] { work(); }) {}
  ~BatchStream() {
    {
      const std::lock_guard lock(mutex_);
      abandoned_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  BatchStream(const BatchStream&) = delete;
  BatchStream& operator=(const BatchStream&) = delete;

  /// Null: the end. Errors: those of the simulation.
  Batch next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !made_.empty() || ended_; });
    if (made_.empty()) {
      if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
      return nullptr;
    }
    Batch batch = std::move(made_.front());
    made_.pop_front();
    changed_.notify_all();
    return batch;
  }

 private:
  static constexpr std::size_t kAhead = 2;

  void work() {
    std::exception_ptr error;
    try {
      auto use = scene_->lock();
      simulator_.run_batches(scans_, first_number_, memory_, [&](ScanBatch&& batch) {
        // Who takes the batches may use the scene meanwhile.
        if (use.owns_lock()) use.unlock();
        put(std::make_shared<BatchObject>(BatchObject{scene_, std::move(batch)}));
        use = scene_->lock();
      });
    } catch (const Abandoned&) {
    } catch (...) {
      error = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    error_ = error;
    ended_ = true;
    changed_.notify_all();
  }

  void put(Batch batch) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return made_.size() < kAhead || abandoned_; });
    if (abandoned_) throw Abandoned();
    made_.push_back(std::move(batch));
    changed_.notify_all();
  }

  std::shared_ptr<SceneObject> scene_;
  ScanSimulator simulator_;
  std::vector<ScanMotion> scans_;
  std::uint64_t first_number_;
  BatchMemory memory_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Batch> made_;
  std::exception_ptr error_;
  bool ended_ = false;
  bool abandoned_ = false;
  std::thread thread_;  ///< last, because it uses all other members
};

/// The iterator in Python; frees the stream at its end.
struct BatchIterator {
  std::unique_ptr<BatchStream> stream;
  PythonProgress progress;
  std::size_t taken = 0;

  explicit BatchIterator(const py::object& report_to) : progress(report_to) {}
  ~BatchIterator() {
    const py::gil_scoped_release released;
    stream.reset();
  }
  BatchIterator(const BatchIterator&) = delete;
  BatchIterator& operator=(const BatchIterator&) = delete;

  Batch next() {
    Batch batch;
    {
      const py::gil_scoped_release released;
      if (stream) batch = stream->next();
      if (!batch) stream.reset();
    }
    if (!batch) throw py::stop_iteration();
    taken += batch->batch.scans();
    progress.advance(taken);
    return batch;
  }
};

struct BatchArguments {
  SimulateArguments simulate;
  py::object fields = py::none();
  bool on_device = false;

  void take(Keywords& keywords) {
    simulate.take(keywords);
    keywords.take("fields", fields);
    keywords.take("on_device", on_device);
  }
};

ScanFields fields_of(const py::object& names) {
  if (names.is_none()) return {};
  if (py::isinstance<py::str>(names) || !py::isinstance<py::sequence>(names))
    throw py::type_error("fields: expected a sequence of names");
  std::vector<std::string> texts;
  for (const py::handle name : names) {
    if (!py::isinstance<py::str>(name))
      throw py::type_error("fields: expected a sequence of names");
    texts.push_back(name.cast<std::string>());
  }
  return scan_fields(texts);
}

std::unique_ptr<BatchIterator> scan_batches(const std::shared_ptr<SceneObject>& object,
                                            py::handle sensor, py::handle poses,
                                            const py::kwargs& kwargs) {
  object->require_own_process();
  const auto arguments = arguments_of<BatchArguments>("scan_batches", kwargs);
  ScanSettings settings =
      arguments.simulate.scan.settings_of(sensor_of(sensor), arguments.simulate.seed);
  settings.fields = fields_of(arguments.fields);
  std::vector<ScanMotion> scans = arguments.simulate.drive.scans_at(poses, settings.sensor);
  auto iterator = std::make_unique<BatchIterator>(arguments.simulate.progress);
  iterator->progress.begin_step("simulate", scans.size());
  const py::gil_scoped_release released;
  iterator->stream = std::make_unique<BatchStream>(
      object, std::move(settings), std::move(scans), arguments.simulate.first_number,
      arguments.on_device ? BatchMemory::device : BatchMemory::host);
  return iterator;
}

/// Element type and number of components of a value.
template <class T>
struct Component {
  using type = T;
  static constexpr std::int64_t kCount = 1;
};
template <>
struct Component<Vec3f> {
  using type = float;
  static constexpr std::int64_t kCount = 3;
};

template <class T>
dlpack::DataType data_type() {
  using Value = typename Component<T>::type;
  const auto code = std::is_floating_point_v<Value> ? dlpack::TypeCode::floating
                                                    : dlpack::TypeCode::unsigned_integer;
  return {code, 8 * sizeof(Value), 1};
}

template <class T>
py::object array_of_batch(const Batch& batch, const T* values) {
  if (values == nullptr) return py::none();
  const auto returns = static_cast<std::int64_t>(batch->batch.returns());
  if (batch->batch.device >= 0) {
    DeviceArray array;
    array.keep = batch;
    array.device = batch->batch.device;
    array.data = values;
    array.type = data_type<T>();
    array.shape = {returns};
    array.strides = {Component<T>::kCount};
    if (Component<T>::kCount > 1) {
      array.shape.push_back(Component<T>::kCount);
      array.strides.push_back(1);
    }
    return py::cast(std::move(array));
  }
  const py::object owner = py::cast(batch);
  if constexpr (Component<T>::kCount > 1)
    return vectors_view(values, batch->batch.returns(), sizeof(T), owner);
  else
    return array_view(std::span<const T>(values, batch->batch.returns()), owner);
}

/// (scans, length[, 3]) with the first `length` returns of each scan, followed by zeros.
template <class T>
py::array padded_array(const ScanBatch& batch, const T* values, std::size_t length) {
  using Value = typename Component<T>::type;
  std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(batch.scans()),
                                    static_cast<py::ssize_t>(length)};
  if (Component<T>::kCount > 1) shape.push_back(Component<T>::kCount);
  py::array array(py::dtype::of<Value>(), shape);
  auto* to = static_cast<T*>(array.mutable_data());
  for (std::size_t i = 0; i < batch.scans(); ++i, to += length) {
    const std::size_t count =
        std::min<std::size_t>(length, batch.offsets[i + 1] - batch.offsets[i]);
    std::copy_n(values + batch.offsets[i], count, to);
    std::fill(to + count, to + length, T{});
  }
  return array;
}

py::array padded(const BatchObject& object, const std::string& name, std::size_t length) {
  const ScanBatch& batch = object.batch;
  if (batch.device >= 0) throw py::value_error("padded() is for batches in host memory");
  py::object found = py::none();
  const auto take = [&](const char* known, const auto* values) {
    if (name == known && values != nullptr) found = padded_array(batch, values, length);
  };
  take("positions", batch.arrays.positions);
  for_each_scan_attribute(
      [&](const auto& attribute) { take(attribute.name, attribute.of(batch.arrays)); });
  if (found.is_none()) throw py::value_error("the batch has no '" + name + "'");
  return found;
}

void bind_batch(SceneClass& type) {
  py::class_<BatchObject, Batch> batch(type, "ScanBatch", kBatchDoc);
  batch.def("__len__", [](const BatchObject& self) { return self.batch.scans(); })
      .def_property_readonly(
          "first", [](const BatchObject& self) { return self.batch.first; },
          "Index in poses of its first scan.")
      .def_property_readonly(
          "offsets",
          [](const BatchObject& self) {
            return owned_array(
                std::vector<std::int64_t>(self.batch.offsets.begin(), self.batch.offsets.end()),
                {static_cast<py::ssize_t>(self.batch.offsets.size())});
          },
          "(scans + 1,) int64, index of the first return of each scan.")
      .def_property_readonly(
          "positions",
          [](const Batch& self) { return array_of_batch(self, self->batch.arrays.positions); },
          "(N, 3) float32, m, in the sensor's frame; or None.")
      .def("padded", &padded, py::arg("name"), py::arg("length"),
           documented(
               "padded", "self, name, length",
               "A new array (scans, length) or (scans, length, 3) of the attribute: the first "
               "returns\nof each scan, followed by zeros. Raises ValueError (no such attribute; "
               "GPU memory).")
               .c_str());
  for_each_scan_attribute([&](const auto& attribute) {
    const auto of = attribute.of;
    using Value = std::remove_cvref_t<decltype(*of(std::declval<const ReturnArrays&>()))>;
    batch.def_property_readonly(
        attribute.name,
        [of](const Batch& self) { return array_of_batch(self, of(self->batch.arrays)); },
        (shape_and_type<Value>() + attribute.about + "; or None.").c_str());
  });
}

}  // namespace

void add_scan_batches(SceneClass& type) {
  bind_batch(type);
  py::class_<BatchIterator>(type, "BatchIterator", "Iterator of Scene.scan_batches().")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &BatchIterator::next);
  type.def("scan_batches", &scan_batches, py::arg("sensor"), py::arg("poses"),
           documented<BatchArguments>("scan_batches", "self, sensor, poses", kBatchesDoc).c_str());
}

}  // namespace adasplats::python
