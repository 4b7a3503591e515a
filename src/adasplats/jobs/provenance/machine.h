// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "adasplats/jobs/session/device_choice.h"

namespace adasplats {

/// What figures were measured on: {"cpu", "cores" (the threads used), "memory_bytes", "system",
/// "compiler"}; null where the system does not say.
nlohmann::ordered_json machine_json(int threads);

/// What computed: "kind", "name" and "driver" (the CUDA version that it supports); of GPUs also
/// "kernel_driver" (the version of the driver itself, null where the system does not say) and
/// "gpus" (CUDA's numbers), of a CPU that stood in for them the "reason".
nlohmann::ordered_json device_json(const DeviceChoice& device);

/// Main memory that this process may use: the machine's, or what its container is limited to.
/// 0 where the system does not say.
std::uint64_t usable_memory_bytes();

}  // namespace adasplats
