// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Private to trace/: what differs between Embree 3 and 4, so that nothing else has to know.

#ifndef ADASPLATS_EMBREE_MAJOR
#error "who includes this needs the version that CMake found"
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
