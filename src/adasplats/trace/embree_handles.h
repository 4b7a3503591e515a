// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <type_traits>

#include "adasplats/core/executor.h"
#include "adasplats/trace/embree.h"

namespace adasplats {

/// Private to trace/: Embree's handles by value, and its errors as exceptions.

/// The first error that Embree reports; it reports from any thread and must not see an exception.
class ErrorLog {
 public:
  static void report(void* log, RTCError code, const char* text);
  /// Throws Error (no memory, unsupported CPU) or std::logic_error.
  void throw_if_any() const;

 private:
  mutable std::mutex mutex_;
  RTCError code_ = RTC_ERROR_NONE;
  std::string text_;
};

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

/// A device that reports to `errors`, which must outlive it. Errors: software.
DeviceHandle start_embree(ErrorLog& errors);

/// Builds a scene. Embree builds in the thread pool of its caller, so the call is made on the
/// executor's. (The device's own setting `threads` would bound all of the process.)
void commit(RTCScene scene, const Executor& executor);

}  // namespace adasplats
