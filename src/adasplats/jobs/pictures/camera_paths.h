// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "adasplats/jobs/scene/view_choice.h"

namespace adasplats {

/// Cameras of a film, one a picture.

/// Once around the part, from the height of overview() and so far away that all of it is always in
/// the picture.
std::vector<Camera> turntable(const ViewChoice& view, const ShownPart& part, std::size_t frames);

/// Along the view's trajectory from its first pose to its last, as fast as it was driven. Errors:
/// those of the trajectory's file.
std::vector<Camera> along_drive(const ViewChoice& view, std::size_t frames);

}  // namespace adasplats
