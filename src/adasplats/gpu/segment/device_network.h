// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/segment/device_pyramid.h"
#include "adasplats/segment/network/network.h"

namespace adasplats::gpu {

/// Private to gpu/: a network in device memory.
class DeviceNetwork {
 public:
  /// `network` must outlive this.
  DeviceNetwork(const Network& network, cudaStream_t stream);

  /// run_network(): the same logits except for the order of sums in matrix products.
  DeviceBuffer<float> logits(std::span<const DeviceLevel> levels, DeviceBuffer<float> features,
                             cudaStream_t stream) const;

  const PointFeature* features() const { return features_.data(); }

 private:
  friend class DeviceRun;

  const Network& network_;
  std::vector<DeviceBuffer<float>> weights_;
  DeviceBuffer<Vec3f> kernel_;
  DeviceBuffer<PointFeature> features_;
};

}  // namespace adasplats::gpu
