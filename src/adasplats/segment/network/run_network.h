// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "adasplats/core/executor.h"
#include "adasplats/segment/network/network.h"
#include "adasplats/segment/pyramid/pyramid.h"

namespace adasplats {

/// The logits of every point of the finest level, point by point, a number a class. `features`:
/// likewise, a number a feature of the network. The same bits on any number of threads. Errors:
/// unavailable (built without OpenBLAS).
std::vector<float> run_network(const Network& network, std::span<const PyramidLevel> levels,
                               std::vector<float> features, const Executor& executor);

}  // namespace adasplats
