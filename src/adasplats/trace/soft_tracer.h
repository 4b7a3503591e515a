// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "adasplats/scene/scene.h"
#include "adasplats/trace/tracer.h"

namespace adasplats {

/// Finds where rays most likely end in a scene with opacities (SoftHits). `all_hits` traces its
/// disks as opaque ones. With a depth above 1 the result is that of `all_hits`. The scene's data
/// must outlive it.
std::unique_ptr<Tracer> make_soft_tracer(std::unique_ptr<Tracer> all_hits, const SceneView& scene);

}  // namespace adasplats
