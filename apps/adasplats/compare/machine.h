// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

namespace adasplats::app {

/// The processor's name; null where the system does not tell.
nlohmann::ordered_json cpu_name();

/// What figures were measured on: {"cpu", "cores", "memory_bytes", "system"}; null where the system
/// does not tell.
nlohmann::ordered_json machine_json(int threads);

/// Main memory that this process may use: the machine's, or what its container is limited to.
/// 0 where the system does not tell.
std::uint64_t usable_memory_bytes();

}  // namespace adasplats::app
