// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <type_traits>

#include "adasplats/core/error.h"
#include "adasplats/trace/castable.h"
#include "adasplats/trace/embree.h"
#include "adasplats/trace/embree_callbacks.h"
#include "adasplats/trace/hit_list.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

namespace {

template <unsigned kLanes>
using Packet = std::conditional_t<kLanes == 16, RTCRayHit16,
                                  std::conditional_t<kLanes == 8, RTCRayHit8, RTCRayHit4>>;

/// The widest packet that Embree traverses natively on this machine. It splits wider ones and then
/// keeps only hits with a geometry id, which our callbacks do not write.
int native_packet_size(RTCDevice device) {
  const auto has = [&](RTCDeviceProperty property) {
    return rtcGetDeviceProperty(device, property) != 0;
  };
  if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
  if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) return 8;
  return has(RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED) ? 4 : 1;
}

class EmbreeTracer final : public Tracer {
 public:
  EmbreeTracer(const SceneView& scene, const Executor& executor)
      : disks_{scene.disks},
        triangles_{scene.mesh, static_cast<std::uint32_t>(scene.disk_count())} {
    if (scene.primitive_count() >= Hit::kNone)
      throw Error(ErrorKind::data, "a scene of " + std::to_string(scene.primitive_count()) +
                                       " primitives; the maximum is 2^32 - 2");
    device_ = start_embree(errors_);
    build(scene, executor);
    errors_.throw_if_any();
  }

  std::string_view name() const override { return "embree"; }

  void nearest(std::span<const Ray> rays, std::span<Hit> hits,
               const Executor& executor) const override {
    clear_hits(rays, 1, hits);
    executor.for_chunks(rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
      const auto chunk_rays = rays.subspan(begin, end - begin);
      const auto chunk_hits = hits.subspan(begin, end - begin);
      switch (packet_size_) {
        case 16: cast_packets<16>(chunk_rays, chunk_hits); break;
        case 8: cast_packets<8>(chunk_rays, chunk_hits); break;
        case 4: cast_packets<4>(chunk_rays, chunk_hits); break;
        default: cast_singles(chunk_rays, 1, chunk_hits);
      }
    });
    errors_.throw_if_any();
  }

  void nearest_hits(std::span<const Ray> rays, int depth, std::span<Hit> hits,
                    const Executor& executor) const override {
    clear_hits(rays, depth, hits);
    const auto slots = static_cast<std::size_t>(depth);
    executor.for_chunks(rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
      cast_singles(rays.subspan(begin, end - begin), slots,
                   hits.subspan(begin * slots, (end - begin) * slots));
    });
    errors_.throw_if_any();
  }

 private:
  void build(const SceneView& scene, const Executor& executor) {
    scene_.reset(rtcNewScene(device_.get()));
    add(disk_callbacks(), scene.disk_count(), &disks_);
    add(triangle_callbacks(), scene.triangle_count(), &triangles_);
    // Box tests that round outwards: with the margin of our boxes no hit is lost. Measured cost:
    // none.
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    commit(scene_.get(), executor);
    packet_size_ = native_packet_size(device_.get());
  }

  void add(GeometryCallbacks callbacks, std::size_t primitives, void* user_data) {
    if (primitives == 0) return;
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(primitives));
    rtcSetGeometryUserData(geometry, user_data);
    rtcSetGeometryBoundsFunction(geometry, callbacks.bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, callbacks.intersect);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
  }

  template <unsigned kLanes>
  void cast_packets(std::span<const Ray> rays, std::span<Hit> hits) const {
    Query query;
    embree::init(query.context);
    for (std::size_t begin = 0; begin < rays.size(); begin += kLanes) {
      const std::size_t count = std::min<std::size_t>(kLanes, rays.size() - begin);
      Packet<kLanes> packet;
      alignas(64) int valid[kLanes];
      bool any = false;
      for (std::size_t i = 0; i < kLanes; ++i) {
        const Ray& ray = rays[begin + std::min(i, count - 1)];
        const bool used = i < count && castable(ray);
        valid[i] = used ? -1 : 0;
        any = any || used;
        packet.ray.org_x[i] = ray.origin.x;
        packet.ray.org_y[i] = ray.origin.y;
        packet.ray.org_z[i] = ray.origin.z;
        packet.ray.tnear[i] = first_t(ray);
        packet.ray.dir_x[i] = ray.direction.x;
        packet.ray.dir_y[i] = ray.direction.y;
        packet.ray.dir_z[i] = ray.direction.z;
        packet.ray.time[i] = 0.0F;
        packet.ray.tfar[i] = ray.t_max;
        packet.ray.mask[i] = ~0U;
        packet.ray.id[i] = 0;
        packet.ray.flags[i] = 0;
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.primID[i] = Hit::kNone;
        packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
      }
      if (!any) continue;
      embree::intersect(scene_.get(), query.context, valid, packet);
      for (std::size_t i = 0; i < count; ++i)
        if (packet.hit.primID[i] != Hit::kNone)
          hits[begin + i] = {packet.ray.tfar[i], packet.hit.primID[i]};
    }
  }

  void cast_singles(std::span<const Ray> rays, std::size_t slots, std::span<Hit> hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i)
      cast_single(rays[i], hits.subspan(i * slots, slots));
  }

  void cast_single(const Ray& ray, std::span<Hit> slots) const {
    if (!castable(ray)) return;
    HitList list(slots);
    Query query;
    embree::init(query.context);
    query.nearest_hits = &list;
    RTCRayHit single{};
    single.ray.org_x = ray.origin.x;
    single.ray.org_y = ray.origin.y;
    single.ray.org_z = ray.origin.z;
    single.ray.tnear = first_t(ray);
    single.ray.dir_x = ray.direction.x;
    single.ray.dir_y = ray.direction.y;
    single.ray.dir_z = ray.direction.z;
    single.ray.tfar = ray.t_max;
    single.ray.mask = ~0U;
    single.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    single.hit.primID = Hit::kNone;
    single.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree::intersect(scene_.get(), query.context, single);
  }

  ErrorLog errors_;
  DiskGeometry disks_;
  TriangleGeometry triangles_;
  DeviceHandle device_;
  SceneHandle scene_;
  int packet_size_ = 1;
};

}  // namespace

std::unique_ptr<Tracer> make_embree_tracer(const SceneView& scene, const Executor& executor) {
  return std::make_unique<EmbreeTracer>(scene, executor);
}

}  // namespace adasplats
