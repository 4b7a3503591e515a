// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "adasplats/levels/level_sample.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

/// Private to levels/: attributes of a run of elements; element k has those of sources[k].
struct ElementValues {
  std::span<const std::uint16_t> classes;
  std::span<const float> intensities;
  std::span<const float> errors_m;
  std::span<const std::uint32_t> sources;

  std::uint16_t class_id(std::size_t k) const { return classes.empty() ? 0 : classes[sources[k]]; }
  float intensity(std::size_t k) const;  ///< NaN: 0
  float error_m(std::size_t k) const;    ///< NaN: not known
  ElementValues run(std::size_t begin, std::size_t end) const;
};

/// Element k as it stands in the input.
LevelSample sample_of(const Disk& disk, const ElementValues& values, std::size_t k);
LevelSample sample_of(Vec3f position, const ElementValues& values, std::size_t k);

/// Makes one disk, or two, of the disks of a cell. Normals of clouds have no reliable sign, so both
/// sides of a wall are one facing, and disks 45 degrees or more apart are two, if either has a
/// tenth of the area. Of each facing: the means of centers and normals, weighted by area, the sum
/// of the areas as far as the circle around the disks reaches, the class of most area, the mean
/// intensity, and the mean of the errors that are known.
class CellMerger {
 public:
  /// Adds to `merged`. `disks` are the cell's, one or more.
  void merge(std::span<const Disk> disks, const ElementValues& values,
             std::vector<LevelSample>& merged);

 private:
  struct Facing {
    Vec3f direction;
    double area = 0;  ///< over pi
    double with_direction = 0;
    Vec3d center_sum, normal_sum;
  };

  void find_facings(std::span<const Disk> disks);
  /// Every disk to the facing it is nearest to, and the facings' sums.
  void assign(std::span<const Disk> disks);
  LevelSample merged_facing(std::size_t facing, std::span<const Disk> disks,
                            const ElementValues& values);
  std::uint16_t class_of_most_area(std::size_t facing, std::span<const Disk> disks,
                                   const ElementValues& values);

  std::array<Facing, 2> facings_;
  std::size_t facing_count_ = 0;
  std::vector<std::uint8_t> facing_of_;
  std::vector<std::pair<std::uint16_t, double>> class_areas_;
};

}  // namespace adasplats
