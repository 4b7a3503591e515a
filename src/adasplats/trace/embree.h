// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to trace/. Hides the differences between Embree 3 and 4, owns handles, throws errors.

#include <memory>
#include <mutex>
#include <string>
#include <type_traits>

#include "adasplats/core/executor.h"

#ifndef ADASPLATS_EMBREE_MAJOR
#error "the includer must define the Embree version that CMake found"
#endif
#if ADASPLATS_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace adasplats::embree {

#if ADASPLATS_EMBREE_MAJOR >= 4

using QueryContext = RTCRayQueryContext;

/// Arguments of one call; the context must outlive it.
inline RTCIntersectArguments arguments_of(QueryContext& context, bool coherent) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
  arguments.context = &context;
  return arguments;
}

inline void init(QueryContext& context) { rtcInitRayQueryContext(&context); }

inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  RTCIntersectArguments arguments = arguments_of(context, false);
  rtcIntersect1(scene, &ray, &arguments);
}
inline void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit4& rays) {
  RTCIntersectArguments arguments = arguments_of(context, true);
  rtcIntersect4(valid, scene, &rays, &arguments);
}
inline void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit8& rays) {
  RTCIntersectArguments arguments = arguments_of(context, true);
  rtcIntersect8(valid, scene, &rays, &arguments);
}
inline void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit16& rays) {
  RTCIntersectArguments arguments = arguments_of(context, true);
  rtcIntersect16(valid, scene, &rays, &arguments);
}

#else

using QueryContext = RTCIntersectContext;

inline void init(QueryContext& context) { rtcInitIntersectContext(&context); }

inline void intersect(RTCScene scene, QueryContext& context, RTCRayHit& ray) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  rtcIntersect1(scene, &context, &ray);
}
inline void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit4& rays) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect4(valid, scene, &context, &rays);
}
inline void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit8& rays) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid, scene, &context, &rays);
}
inline void intersect(RTCScene scene, QueryContext& context, const int* valid, RTCRayHit16& rays) {
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid, scene, &context, &rays);
}

#endif

}  // namespace adasplats::embree

namespace adasplats {

/// Stores the first error that Embree reports; it reports on any thread and must not see
/// exceptions.
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

/// Creates a device that reports to `errors`, which must outlive it. Errors: software.
DeviceHandle start_embree(ErrorLog& errors);

/// Builds a scene on the executor's threads: Embree uses the thread pool of its caller. (The device
/// setting `threads` would limit the entire process.)
void commit(RTCScene scene, const Executor& executor);

}  // namespace adasplats
