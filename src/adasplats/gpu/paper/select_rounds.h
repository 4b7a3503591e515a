// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/gpu/base/device_memory.h"
#include "adasplats/gpu/neighbors/neighborhoods_lists.h"
#include "adasplats/splats/paper/select.h"

namespace adasplats::gpu {

/// Private to gpu/: exactly the result of select_greedily(), from radii and discard lists in device
/// memory. Works in rounds: a candidate is decided once all candidates that could discard it are.
/// Waits for the stream.
DeviceBuffer<std::uint32_t> select_greedily(const DeviceBuffer<float>& radii,
                                            const DeviceLists& discards, SelectionOrder order,
                                            cudaStream_t stream);

}  // namespace adasplats::gpu
