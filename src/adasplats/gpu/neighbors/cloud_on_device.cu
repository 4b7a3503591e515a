// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <type_traits>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/error.h"
#include "adasplats/gpu/base/hilbert_order.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/neighbors/cloud_on_device.h"
#include "adasplats/scene/intersect.h"

namespace adasplats::gpu {
namespace {

template <class T>
DeviceBuffer<T> copied(const std::vector<T>& values, cudaStream_t stream) {
  return DeviceBuffer<T>(std::span<const T>(values), stream);
}

/// Concatenates one array, returned by `of`, of several clouds.
template <class Of>
auto concatenated(std::span<const DeviceCloud* const> clouds, const Of& of, cudaStream_t stream) {
  using Buffer = std::decay_t<decltype(of(*clouds.front()))>;
  std::vector<const Buffer*> parts;
  for (const DeviceCloud* cloud : clouds) parts.push_back(&of(*cloud));
  return concatenate(std::span<const Buffer* const>(parts), stream);
}

/// The values that break ties between coincident points, least significant last.
void add_tie_breakers(std::vector<TieBreaker>& breakers, const DeviceBuffer<Vec3f>& values) {
  for (int axis = 0; axis < 3; ++axis) breakers.push_back(TieBreaker::of(values.data(), axis));
}
void add_tie_breakers(std::vector<TieBreaker>& breakers, const DeviceBuffer<OriginKind>& values) {
  breakers.push_back(TieBreaker::of(reinterpret_cast<const std::uint8_t*>(values.data())));
}
template <class T>
void add_tie_breakers(std::vector<TieBreaker>& breakers, const DeviceBuffer<T>& values) {
  breakers.push_back(TieBreaker::of(values.data()));
}

/// Removes the points of flagged classes from an order.
DeviceBuffer<std::uint32_t> without_classes(const DeviceBuffer<std::uint32_t>& order,
                                            const DeviceBuffer<std::uint16_t>& classes,
                                            std::span<const std::uint8_t> removed,
                                            cudaStream_t stream) {
  const DeviceBuffer<std::uint8_t> table(removed, stream);
  DeviceBuffer<std::uint8_t> stays(order.size(), stream);
  for_each(order.size(), stream, "remove points",
           [order = order.data(), classes = classes.data(), table = table.data(),
            stays = stays.data()] __device__(std::uint64_t i) {
             stays[i] = table[classes[order[i]]] == 0;
           });
  return gather(order, flagged(stays.data(), stays.size(), stream), stream);
}

}  // namespace

DeviceCloud copy_to_device(const PointCloud& cloud, cudaStream_t stream) {
  if (cloud.size() >= std::size_t{1} << 31)
    throw Error(ErrorKind::unavailable, "a GPU supports fewer than 2^31 points; use `device` cpu");
  DeviceCloud copy;
  copy.positions = copied(cloud.positions, stream);
  for_each_attribute(
      [&](const auto& attribute) { attribute.of(copy) = copied(attribute.of(cloud), stream); });
  return copy;
}

template <class T>
DeviceBuffer<T> gather(const DeviceBuffer<T>& values, const DeviceBuffer<std::uint32_t>& indices,
                       cudaStream_t stream) {
  if (values.empty()) return {};
  DeviceBuffer<T> result(indices.size(), stream);
  for_each(indices.size(), stream, "gather points",
           [from = values.data(), at = indices.data(),
            to = result.data()] __device__(std::uint64_t i) { to[i] = from[at[i]]; });
  return result;
}

template DeviceBuffer<SemanticGroup> gather(const DeviceBuffer<SemanticGroup>&,
                                            const DeviceBuffer<std::uint32_t>&, cudaStream_t);
template DeviceBuffer<OriginKind> gather(const DeviceBuffer<OriginKind>&,
                                         const DeviceBuffer<std::uint32_t>&, cudaStream_t);
template DeviceBuffer<std::uint16_t> gather(const DeviceBuffer<std::uint16_t>&,
                                            const DeviceBuffer<std::uint32_t>&, cudaStream_t);
template DeviceBuffer<std::uint32_t> gather(const DeviceBuffer<std::uint32_t>&,
                                            const DeviceBuffer<std::uint32_t>&, cudaStream_t);
template DeviceBuffer<float> gather(const DeviceBuffer<float>&, const DeviceBuffer<std::uint32_t>&,
                                    cudaStream_t);
template DeviceBuffer<Vec3f> gather(const DeviceBuffer<Vec3f>&, const DeviceBuffer<std::uint32_t>&,
                                    cudaStream_t);
template DeviceBuffer<Disk> gather(const DeviceBuffer<Disk>&, const DeviceBuffer<std::uint32_t>&,
                                   cudaStream_t);

DeviceCloud gather(const DeviceCloud& cloud, const DeviceBuffer<std::uint32_t>& indices,
                   cudaStream_t stream) {
  DeviceCloud result;
  result.positions = gather(cloud.positions, indices, stream);
  for_each_attribute([&](const auto& attribute) {
    attribute.of(result) = gather(attribute.of(cloud), indices, stream);
  });
  return result;
}

template <class T>
DeviceBuffer<T> concatenate(std::span<const DeviceBuffer<T>* const> parts, cudaStream_t stream) {
  std::size_t size = 0;
  for (const DeviceBuffer<T>* part : parts) size += part->size();
  DeviceBuffer<T> whole(size, stream);
  std::size_t at = 0;
  for (const DeviceBuffer<T>* part : parts) {
    if (part->empty()) continue;
    cuda_check(cudaMemcpyAsync(whole.data() + at, part->data(), part->bytes(),
                               cudaMemcpyDeviceToDevice, stream),
               "put points together");
    at += part->size();
  }
  return whole;
}

template DeviceBuffer<SemanticGroup> concatenate(
    std::span<const DeviceBuffer<SemanticGroup>* const>, cudaStream_t);

DeviceCloud concatenate(std::span<const DeviceCloud* const> clouds, cudaStream_t stream) {
  DeviceCloud whole;
  whole.positions = concatenated(
      clouds, [](auto& cloud) -> auto& { return cloud.positions; }, stream);
  for_each_attribute([&](const auto& attribute) {
    attribute.of(whole) = concatenated(clouds, attribute.of, stream);
  });
  return whole;
}

bool has_all_origins(const DeviceCloud& cloud, cudaStream_t stream) {
  if (cloud.sensor_positions.empty()) return false;
  if (cloud.origin_kinds.empty()) return true;
  DeviceBuffer<std::uint32_t> unknown(1, stream);
  unknown.fill_bytes(0);
  for_each(cloud.size(), stream, "look at origins",
           [kinds = cloud.origin_kinds.data(), to = unknown.data()] __device__(std::uint64_t i) {
             if (!is_known(kinds[i])) *to = 1;
           });
  return read_value(unknown.data(), stream) == 0;
}

namespace {

/// The values that break ties between coincident points, least significant first.
std::vector<TieBreaker> tie_breakers(const DeviceCloud& cloud) {
  std::map<int, std::vector<TieBreaker>> ranked;
  for_each_attribute([&](const auto& attribute) {
    const auto& values = attribute.of(cloud);
    if (!values.empty()) add_tie_breakers(ranked[attribute.tie_rank], values);
  });
  std::vector<TieBreaker> more;
  for (const auto& [rank, breakers] : ranked)
    more.insert(more.end(), breakers.begin(), breakers.end());
  std::reverse(more.begin(), more.end());
  return more;
}

}  // namespace

DeviceBuffer<std::uint32_t> canonical_order(const DeviceCloud& cloud, cudaStream_t stream) {
  return hilbert_order(cloud.positions.data(), cloud.size(), stream, tie_breakers(cloud));
}

DeviceCloud load_in_order(const PointCloud& cloud, const CurveBox& box,
                          std::span<const std::uint8_t> removed, cudaStream_t stream) {
  const DeviceCloud unordered = copy_to_device(cloud, stream);
  DeviceBuffer<std::uint32_t> order = hilbert_order(unordered.positions.data(), unordered.size(),
                                                    box, stream, tie_breakers(unordered));
  if (!removed.empty() && !order.empty())
    order = without_classes(order, unordered.classes, removed, stream);
  return gather(unordered, order, stream);
}

}  // namespace adasplats::gpu
