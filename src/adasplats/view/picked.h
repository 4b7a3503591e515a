// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/core/executor.h"
#include "adasplats/view/live_message.h"
#include "adasplats/view/view_scene.h"

namespace adasplats {

/// {"type": "picked", ...}: what a ray meets first in the scene's place (not null).
std::string picked_message(const ViewScene& scene, const PickMessage& pick,
                           const Executor& executor);

}  // namespace adasplats
