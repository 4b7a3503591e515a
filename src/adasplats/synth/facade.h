// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/core/maths/random.h"
#include "adasplats/synth/street_parts.h"

// Private to synth/: walls with openings, shared by apartment buildings and houses.

namespace adasplats {

/// A rectangle on a wall.
struct WallRect {
  double a0, a1, z0, z1;
};

/// Fills an opening in a wall.
enum class OpeningKind : std::uint8_t { window, shutters, shop, door, french_window };

/// The rectangle `panel` of a wall with the opening `hole`: wall, reveal, and at its back the pane
/// with its frame, or the door.
void add_wall_with_opening(MeshBuilder& builder, const WallFrame& wall, const WallRect& panel,
                           const WallRect& hole, OpeningKind kind, float wall_reflectance);

/// A balcony at floor height z over [a0, a1]: slab, brackets and a railing of single bars.
void add_balcony(MeshBuilder& builder, const WallFrame& wall, double a0, double a1, double z,
                 double depth);

/// A box in a wall's frame.
void add_wall_box(MeshBuilder& builder, const WallFrame& wall, const WallRect& rect, double out0,
                  double out1, const Material& material);

}  // namespace adasplats
