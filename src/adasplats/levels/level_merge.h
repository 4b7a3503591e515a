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

/// Private to levels/. Attributes of a run of elements; element k has those of sources[k].
struct ElementValues {
  std::span<const std::uint16_t> classes;
  std::span<const float> intensities;
  std::span<const float> errors_m;
  std::span<const std::array<std::uint8_t, 3>> colors;
  std::span<const std::uint32_t> sources;

  std::uint16_t class_id(std::size_t k) const { return classes.empty() ? 0 : classes[sources[k]]; }
  float intensity(std::size_t k) const;  ///< NaN: 0
  float error_m(std::size_t k) const;    ///< NaN: unknown
  Vec3f color(std::size_t k) const;      ///< 0 to 255; black without colours
  ElementValues run(std::size_t begin, std::size_t end) const;
};

/// Element k, unchanged from the input.
LevelSample sample_of(const Disk& disk, const ElementValues& values, std::size_t k);
LevelSample sample_of(Vec3f position, const ElementValues& values, std::size_t k);

/// Merges the disks of a cell into one or two. Signs of normals are unreliable, so both sides of a
/// wall are one facing. Disks at least 45 degrees apart form two facings if each has a tenth of the
/// area. The disk of a facing has the mean center and normal, weighted by area; the sum of the
/// areas, limited by the circle around the disks; the class with the largest area; the mean
/// intensity and colour; and the mean of the known errors.
class CellMerger {
 public:
  /// Appends the merged disks of a cell with at least one disk.
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
  /// Assigns every disk to the nearest facing and sums up the facings.
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
