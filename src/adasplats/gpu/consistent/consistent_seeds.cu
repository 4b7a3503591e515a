// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/consistent/consistent_seeds.h"
#include "adasplats/splats/consistent/element_steps.h"

namespace adasplats::gpu {
namespace {

constexpr int kClassBits = 16;

/// The most frequent class of the points of every cell.
DeviceBuffer<std::uint16_t> majority_classes(const CellsView& cells,
                                             const DeviceBuffer<std::uint16_t>& classes,
                                             cudaStream_t stream) {
  // Classes are sorted within their cell, so the begins of cells do not change.
  DeviceBuffer<std::uint64_t> keys(classes.size(), stream);
  for_each(cells.size, stream, "find classes of cells",
           [cells, from = classes.data(), to = keys.data()] __device__(std::uint64_t cell) {
             for (std::uint32_t k = cells.begins[cell]; k < cells.begins[cell + 1]; ++k) {
               to[k] = cell << kClassBits | from[cells.members[k]];
             }
           });
  sort_order(keys, stream, 0, 32 + kClassBits);
  DeviceBuffer<std::uint16_t> sorted(classes.size(), stream);
  for_each(classes.size(), stream, "find classes of cells",
           [from = keys.data(), to = sorted.data()] __device__(std::uint64_t i) {
             to[i] = static_cast<std::uint16_t>(from[i]);
           });
  DeviceBuffer<std::uint16_t> majorities(cells.size, stream);
  for_each(cells.size, stream, "find classes of cells",
           [cells, from = sorted.data(), to = majorities.data()] __device__(std::uint64_t cell) {
             const std::uint32_t begin = cells.begins[cell];
             to[cell] = majority_class({from + begin, cells.begins[cell + 1] - begin});
           });
  return majorities;
}

DeviceBuffer<float> mean_intensities(const CellsView& cells, const DeviceBuffer<float>& intensities,
                                     cudaStream_t stream) {
  DeviceBuffer<float> means(cells.size, stream);
  for_each(cells.size, stream, "find intensities of cells",
           [cells, from = intensities.data(), to = means.data()] __device__(std::uint64_t cell) {
             to[cell] = mean_intensity(from, cells.points_of(cell));
           });
  return means;
}

}  // namespace

double median_spacing(const DeviceBuffer<LocalPlane>& planes, const DeviceBuffer<float>& units_m,
                      cudaStream_t stream) {
  // The bits of non-negative floats have the same order; excluded cells come last.
  const std::size_t size = planes.size();
  DeviceBuffer<std::uint32_t> bits(size, stream), counted(size, stream);
  for_each(size, stream, "find the spacing of cells",
           [from = planes.data(), units = units_m.data(), to = bits.data(),
            count = counted.data()] __device__(std::uint64_t i) {
             const bool counts = units[i] > 0;
             to[i] = counts ? __float_as_uint(from[i].spacing_m / units[i]) : ~0U;
             count[i] = counts;
           });
  const std::uint64_t spacings = sum_of(counted.data(), size, stream);
  if (spacings == 0) return 0;
  sort_pairs(bits, counted, stream);
  const std::uint32_t middle = read_value(bits.data() + spacings / 2, stream);
  return static_cast<double>(std::bit_cast<float>(middle));
}

std::size_t count_present(const DeviceBuffer<Disk>& disks, cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> count(1, stream);
  count.fill_bytes(0);
  for_each(disks.size(), stream, "count disks",
           [from = disks.data(), to = count.data()] __device__(std::uint64_t i) {
             if (from[i].radius > 0) atomicAdd(to, 1U);
           });
  return count.download().front();
}

ConsistentSplats splats_of(const DeviceBuffer<Disk>& disks, const DeviceBuffer<DiskExtent>& extents,
                           const DeviceCells& cells, const DeviceCloud& cloud,
                           cudaStream_t stream) {
  DeviceBuffer<std::uint8_t> present(disks.size(), stream);
  for_each(disks.size(), stream, "take splats",
           [from = disks.data(), to = present.data()] __device__(std::uint64_t i) {
             to[i] = from[i].radius > 0;
           });
  const DeviceBuffer<std::uint32_t> taken = flagged(present.data(), disks.size(), stream);
  ConsistentSplats splats;
  splats.disks = gather(disks, taken, stream).download();
  if (extents.size() > 0)
    for (const DiskExtent& extent : gather(extents, taken, stream).download())
      splats.opacities.push_back(extent.opacity);
  if (!cloud.classes.empty()) {
    const auto classes = majority_classes(cells.view(), cloud.classes, stream);
    splats.classes = gather(classes, taken, stream).download();
  }
  if (!cloud.intensities.empty()) {
    const auto intensities = mean_intensities(cells.view(), cloud.intensities, stream);
    splats.intensities = gather(intensities, taken, stream).download();
  }
  return splats;
}

}  // namespace adasplats::gpu
