// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/table.h"

namespace adasplats {

/// Colours as glTF has them: 8 bits a channel, linear, opacity.
using GlbColor = std::array<std::uint8_t, 4>;

/// sRGB (IEC 61966-2-1) as linear light; opaque.
std::vector<GlbColor> linear_colors(const std::vector<std::array<std::uint8_t, 3>>& srgb);

/// One attribute of points: its columns have one type and are of the points in order.
struct GlbAttribute {
  /// Empty: an accessor that only extensions name. Others are a multiple of four bytes per point.
  std::string name;
  std::vector<ColumnView> columns;
  bool normalized = false;
  std::size_t components = 0;  ///< fewer than the columns, if the others pad; 0: all
};

/// What a .glb of points is made of.
struct GlbPoints {
  std::vector<GlbAttribute> attributes;  ///< the first has the positions, float32
  std::string primitive;                 ///< members of the primitive, as JSON: ,"extensions":...
  std::string extras;                    ///< members of the node's extras
  std::vector<std::string> extensions;   ///< that are used
};

/// Writes binary glTF 2.0 (Khronos Group, sections 3.7 and 4.4): one mesh of points, whose node
/// turns x forward, y left, z up into glTF's z, x, y. No points: a node without a mesh. Atomic.
/// Errors: data (more points than 4 GiB hold).
void write_glb_points(const std::filesystem::path& path, std::size_t points,
                      const GlbPoints& content);

/// What a .glb has in front of its binary chunk's bytes, which the caller pads with zeros to a
/// multiple of four: headers and the document.
std::string glb_start(std::string json, std::size_t binary_bytes);

/// [x,y,z] with all digits.
std::string json_vector(Vec3d v);
/// A text in quotes; bytes that are no ASCII come from files of any encoding, and become '?'.
std::string json_text(std::string_view text);

}  // namespace adasplats
