// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace adasplats::app {

/// What figures were measured on: {"cpu", "cores", "memory_bytes", "system"}; null where the system
/// does not tell.
nlohmann::ordered_json machine_json(int threads);

/// Main memory; 0 where the system does not tell.
std::uint64_t machine_memory_bytes();

}  // namespace adasplats::app
