// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/embree.h"

#include <stdexcept>

#include "adasplats/core/error.h"

namespace adasplats {

void ErrorLog::report(void* log, RTCError code, const char* text) {
  auto& self = *static_cast<ErrorLog*>(log);
  const std::lock_guard lock(self.mutex_);
  if (self.code_ != RTC_ERROR_NONE) return;
  self.code_ = code;
  self.text_ = text == nullptr ? "" : text;
}

void ErrorLog::throw_if_any() const {
  const std::lock_guard lock(mutex_);
  if (code_ == RTC_ERROR_NONE) return;
  const std::string message = "Embree: " + text_ + " (error " + std::to_string(code_) + ")";
  if (code_ == RTC_ERROR_OUT_OF_MEMORY || code_ == RTC_ERROR_UNSUPPORTED_CPU)
    throw Error(ErrorKind::software, message);
  throw std::logic_error(message);
}

DeviceHandle start_embree(ErrorLog& errors) {
  DeviceHandle device(rtcNewDevice(nullptr));
  if (!device)
    throw Error(ErrorKind::software,
                "Embree does not start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcSetDeviceErrorFunction(device.get(), &ErrorLog::report, &errors);
  return device;
}

void commit(RTCScene scene, const Executor& executor) {
  executor.run([&] { rtcCommitScene(scene); });
}

}  // namespace adasplats
