// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/closest_point.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/trace/embree.h"
#include "adasplats/trace/embree_callbacks.h"

namespace adasplats {

namespace {

constexpr std::size_t kPointsPerChunk = 1024;
constexpr float kFarthest_m = 1e18F;  // as in castable(): beyond, squares overflow

double squared_to_segment(Vec3d point, Vec3d a, Vec3d b) {
  const Vec3d edge = b - a;
  const double size2 = dot(edge, edge);
  const double share = size2 > 0 ? std::clamp(dot(point - a, edge) / size2, 0.0, 1.0) : 0.0;
  const Vec3d offset = point - (a + share * edge);
  return dot(offset, offset);
}

/// State of one query.
struct Search {
  const TriangleMesh& mesh;
  Vec3f point;
  float squared_m2 = std::numeric_limits<float>::infinity();
  std::uint32_t triangle = SurfaceDistance::kNone;
};

/// Called for triangles with a box that touches the query's sphere; true if the sphere shrank.
bool offer(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const std::uint32_t triangle = arguments->primID;
  const float squared_m2 = squared_distance(search.point, search.mesh.triangle(triangle));
  const bool first_of_equals = squared_m2 == search.squared_m2 && triangle < search.triangle;
  if (!(squared_m2 < search.squared_m2 || first_of_equals)) return false;
  search.squared_m2 = squared_m2;
  search.triangle = triangle;
  // Slightly wider, as are the boxes: triangles at the same distance are visited despite the
  // rounding of box distances.
  arguments->query->radius = std::sqrt(squared_m2) * (1.0F + 0x1.0p-20F);
  return true;
}

bool usable(Vec3f p) {
  return std::fabs(p.x) <= kFarthest_m && std::fabs(p.y) <= kFarthest_m &&
         std::fabs(p.z) <= kFarthest_m;
}

}  // namespace

float squared_distance(Vec3f point, const Triangle& triangle) {
  const Vec3d p = vec_cast<double>(point);
  const Vec3d a = vec_cast<double>(triangle.a);
  const Vec3d b = vec_cast<double>(triangle.b);
  const Vec3d c = vec_cast<double>(triangle.c);
  const Vec3d normal = cross(b - a, c - a);
  const double size2 = dot(normal, normal);
  const auto inside = [&](Vec3d from, Vec3d to) {
    return dot(cross(to - from, p - from), normal) >= 0;
  };
  if (size2 > 0 && inside(a, b) && inside(b, c) && inside(c, a)) {
    const double along = dot(p - a, normal);
    return static_cast<float>(along * along / size2);
  }
  return static_cast<float>(std::min(
      {squared_to_segment(p, a, b), squared_to_segment(p, b, c), squared_to_segment(p, c, a)}));
}

struct ClosestPoint::Impl {
  explicit Impl(const TriangleMesh& mesh) : geometry{&mesh, 0} {}

  ErrorLog errors;
  TriangleGeometry geometry;
  DeviceHandle device;
  SceneHandle scene;
};

ClosestPoint::ClosestPoint(const TriangleMesh& mesh, const Executor& executor)
    : impl_(std::make_unique<Impl>(mesh)) {
  if (mesh.triangles.size() >= SurfaceDistance::kNone)
    throw Error(ErrorKind::data, "a mesh of " + std::to_string(mesh.triangles.size()) +
                                     " triangles; the maximum is 2^32 - 2");
  if (mesh.triangles.empty()) return;
  impl_->device = start_embree(impl_->errors);
  impl_->scene.reset(rtcNewScene(impl_->device.get()));
  const RTCGeometry geometry = rtcNewGeometry(impl_->device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(mesh.triangles.size()));
  rtcSetGeometryUserData(geometry, &impl_->geometry);
  rtcSetGeometryBoundsFunction(geometry, triangle_callbacks().bounds, nullptr);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  commit(impl_->scene.get(), executor);
  impl_->errors.throw_if_any();
}

ClosestPoint::~ClosestPoint() = default;

std::vector<SurfaceDistance> ClosestPoint::of(std::span<const Vec3f> points,
                                              const Executor& executor) const {
  std::vector<SurfaceDistance> result(points.size());
  if (!impl_->scene) return result;
  executor.for_chunks(points.size(), kPointsPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!usable(points[i])) continue;
      Search search{*impl_->geometry.mesh, points[i]};
      RTCPointQuery query{};
      query.x = points[i].x;
      query.y = points[i].y;
      query.z = points[i].z;
      query.radius = std::numeric_limits<float>::infinity();
      RTCPointQueryContext context;
      rtcInitPointQueryContext(&context);
      rtcPointQuery(impl_->scene.get(), &query, &context, &offer, &search);
      result[i] = {std::sqrt(search.squared_m2), search.triangle};
    }
  });
  impl_->errors.throw_if_any();
  return result;
}

}  // namespace adasplats
