// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/core/executor.h"
#include "adasplats/view/live_message.h"
#include "adasplats/view/view_scene.h"

namespace adasplats {

/// {"type": "picked", ...}: the nearest hit of a ray in `scene.place`, which must not be null.
std::string picked_message(const ViewScene& scene, const PickMessage& pick,
                           const Executor& executor);

}  // namespace adasplats
