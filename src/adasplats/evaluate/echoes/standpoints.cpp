// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/echoes/standpoints.h"

namespace adasplats {

std::vector<std::uint32_t> standpoints_of(const KittiSequence& sequence,
                                          std::span<const std::size_t> indices) {
  constexpr double kApart_m = 2;
  std::vector<std::uint32_t> places;
  Vec3d begin;
  for (const std::size_t index : indices) {
    const Vec3d here = sequence.trajectory[index].world_from_sensor.translation;
    const bool is_first = places.empty();
    const bool is_new = is_first || length(here - begin) >= kApart_m;
    if (is_new) begin = here;
    places.push_back(is_first ? 0 : places.back() + (is_new ? 1 : 0));
  }
  return places;
}

}  // namespace adasplats
