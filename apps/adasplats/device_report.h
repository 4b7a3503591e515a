// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "adasplats/pipeline/device_choice.h"

namespace adasplats::app {

/// "device" of a --report: "kind", "name", and of GPUs "driver" and "gpus", of the CPU "reason".
nlohmann::ordered_json device_json(const DeviceChoice& device);

}  // namespace adasplats::app
