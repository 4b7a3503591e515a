// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/neighbors/hilbert.h"

namespace adasplats::gpu {

/// Private to gpu/: the points of a PointCloud in device memory. An attribute is empty or as long
/// as `positions`.
struct DeviceCloud {
  DeviceBuffer<Vec3f> positions;
  DeviceBuffer<Vec3f> sensor_positions;
  DeviceBuffer<OriginKind> origin_kinds;
  DeviceBuffer<float> intensities;
  DeviceBuffer<std::uint16_t> classes;
  DeviceBuffer<std::uint16_t> instances;
  DeviceBuffer<std::uint32_t> scan_indices;
  DeviceBuffer<std::uint16_t> lasers;

  std::size_t size() const { return positions.size(); }
};

DeviceCloud copy_to_device(const PointCloud& cloud, cudaStream_t stream);

/// The points of a cloud, with all attributes, in the order of `indices` (device memory).
DeviceCloud gather(const DeviceCloud& cloud, const DeviceBuffer<std::uint32_t>& indices,
                   cudaStream_t stream);
/// The same for one attribute, which may be empty.
template <class T>
DeviceBuffer<T> gather(const DeviceBuffer<T>& values, const DeviceBuffer<std::uint32_t>& indices,
                       cudaStream_t stream);

/// Concatenates clouds. All that have points have the same attributes.
DeviceCloud concatenate(std::span<const DeviceCloud* const> clouds, cudaStream_t stream);
template <class T>
DeviceBuffer<T> concatenate(std::span<const DeviceBuffer<T>* const> parts, cudaStream_t stream);

/// Whether all normals can be oriented towards the sensor (PointCloud::has_all_origins()). Waits
/// for the stream.
bool has_all_origins(const DeviceCloud& cloud, cudaStream_t stream);

/// The order of canonical_order() (splats/model/canonical_order.h).
DeviceBuffer<std::uint32_t> canonical_order(const DeviceCloud& cloud, cudaStream_t stream);

/// Input of both methods: the cloud on the device, in canonical order along a curve over `box`,
/// which contains it, without the points of classes flagged in `removed` (ClassTables::removed; may
/// be empty).
DeviceCloud load_in_order(const PointCloud& cloud, const CurveBox& box,
                          std::span<const std::uint8_t> removed, cudaStream_t stream);

}  // namespace adasplats::gpu
