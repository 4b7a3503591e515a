// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/simulate/image/image.h"

namespace adasplats {

/// A black picture.
Image blank_image(int width, int height);

/// Copies `part`, which must fit, into `picture` with its top left corner at (left, top).
void paste(Image& picture, const Image& part, int left, int top);

}  // namespace adasplats
