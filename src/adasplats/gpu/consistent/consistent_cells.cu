// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/gpu/base/hilbert_order.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/consistent/consistent_cells.h"
#include "adasplats/surface/fused_points.h"

namespace adasplats::gpu {
namespace {

constexpr int kKeyBits = 63;

/// Points sorted by cell, and the begin of each cell.
struct SortedCells {
  DeviceBuffer<std::uint32_t> begins;  ///< number of cells + 1
  DeviceBuffer<std::uint32_t> members;

  std::size_t size() const { return begins.size() - 1; }
};

SortedCells sort_into_cells(const Vec3f* points, std::size_t count, double cell_m,
                            cudaStream_t stream) {
  DeviceBuffer<std::uint64_t> keys(count, stream);
  for_each(count, stream, "sort points into cells",
           [points, cell_m, to = keys.data()] __device__(std::uint64_t i) {
             to[i] = fusion_key(points[i], cell_m);
           });
  SortedCells cells;
  cells.members = sort_order(keys, stream, 0, kKeyBits);
  cells.begins = run_begins(keys.data(), count, stream);
  return cells;
}

void put_means(const Vec3f* points, const SortedCells& cells, Vec3f* means, cudaStream_t stream) {
  const CellsView view = {nullptr, cells.begins.data(), cells.members.data(), 0};
  for_each(cells.size(), stream, "fuse points",
           [points, view, means] __device__(std::uint64_t cell) {
             means[cell] = mean_position(points, view.points_of(cell));
           });
}

/// Cells in the order of the curve through their means, with the begin and number of their members.
struct LooseCells {
  DeviceBuffer<Vec3f> means;
  DeviceBuffer<std::uint32_t> first;
  DeviceBuffer<std::uint32_t> lengths;
  DeviceBuffer<std::uint32_t> members;
};

DeviceCells in_curve_order(const LooseCells& loose, std::size_t points, const CurveBox& box,
                           cudaStream_t stream) {
  const std::size_t size = loose.means.size();
  const DeviceBuffer<std::uint32_t> order = hilbert_order(loose.means.data(), size, box, stream);
  DeviceCells cells{DeviceBuffer<Vec3f>(size, stream),
                    DeviceBuffer<std::uint32_t>(size + 1, stream),
                    DeviceBuffer<std::uint32_t>(points, stream)};
  DeviceBuffer<std::uint32_t> lengths(size, stream);
  for_each(size, stream, "order cells",
           [from = order.data(), means = loose.means.data(), old_lengths = loose.lengths.data(),
            positions = cells.positions.data(), to = lengths.data()] __device__(std::uint64_t i) {
             positions[i] = means[from[i]];
             to[i] = old_lengths[from[i]];
           });
  const DeviceBuffer<std::uint64_t> sums = running_sums(lengths.data(), size, stream);
  for_each(size + 1, stream, "order cells",
           [from = sums.data(), to = cells.begins.data()] __device__(std::uint64_t i) {
             to[i] = static_cast<std::uint32_t>(from[i]);
           });
  for_each(
      size, stream, "order cells",
      [from = order.data(), first = loose.first.data(), old_members = loose.members.data(),
       begins = cells.begins.data(), members = cells.members.data()] __device__(std::uint64_t i) {
        const std::uint32_t* old = old_members + first[from[i]];
        for (std::uint32_t k = begins[i]; k < begins[i + 1]; ++k) members[k] = *old++;
      });
  return cells;
}

/// Appends the begins and member counts of cells.
void put_cells(const CellsView& cells, std::uint32_t first_member, std::uint64_t first_cell,
               LooseCells& loose, cudaStream_t stream) {
  for_each(cells.size, stream, "order cells",
           [cells, first_member, first = loose.first.data() + first_cell,
            lengths = loose.lengths.data() + first_cell] __device__(std::uint64_t i) {
             first[i] = first_member + cells.begins[i];
             lengths[i] = cells.begins[i + 1] - cells.begins[i];
           });
}

void copy(const std::uint32_t* from, std::size_t count, std::uint32_t* to, cudaStream_t stream) {
  cuda_check(
      cudaMemcpyAsync(to, from, count * sizeof(std::uint32_t), cudaMemcpyDeviceToDevice, stream),
      "copy cells");
}

/// The points of split cells, ascending, so that the small cells list theirs in ascending order.
DeviceBuffer<std::uint32_t> points_to_split(const CellsView& cells, const std::uint8_t* split,
                                            std::size_t points, cudaStream_t stream) {
  DeviceBuffer<std::uint8_t> is_loose(points, stream);
  for_each(cells.size, stream, "split cells",
           [cells, split, to = is_loose.data()] __device__(std::uint64_t cell) {
             for (const std::uint32_t i : cells.points_of(cell)) to[i] = split[cell];
           });
  return flagged(is_loose.data(), points, stream);
}

}  // namespace

FusedPoints DeviceCells::download() const {
  return {positions.download(), begins.download(), members.download()};
}

DeviceCells fuse_on_device(const Vec3f* points, std::size_t count, double cell_m,
                           const CurveBox& box, cudaStream_t stream) {
  SortedCells sorted = sort_into_cells(points, count, cell_m, stream);
  const std::size_t size = sorted.size();
  LooseCells loose{DeviceBuffer<Vec3f>(size, stream),
                   DeviceBuffer<std::uint32_t>(size, stream),
                   DeviceBuffer<std::uint32_t>(size, stream),
                   {}};
  put_means(points, sorted, loose.means.data(), stream);
  put_cells({nullptr, sorted.begins.data(), nullptr, static_cast<std::uint32_t>(size)}, 0, 0, loose,
            stream);
  loose.members = std::move(sorted.members);
  return in_curve_order(loose, count, box, stream);
}

DeviceCells split_on_device(const Vec3f* points, const DeviceCells& cells,
                            const std::uint8_t* split, double cell_m, const CurveBox& box,
                            cudaStream_t stream) {
  const std::size_t count = cells.members.size();
  const DeviceBuffer<std::uint32_t> numbers = points_to_split(cells.view(), split, count, stream);
  DeviceBuffer<Vec3f> loose_points(numbers.size(), stream);
  for_each(numbers.size(), stream, "split cells",
           [points, from = numbers.data(), to = loose_points.data()] __device__(std::uint64_t i) {
             to[i] = points[from[i]];
           });
  const SortedCells small =
      sort_into_cells(loose_points.data(), loose_points.size(), cell_m, stream);

  DeviceBuffer<std::uint8_t> stays(cells.size(), stream);
  for_each(cells.size(), stream, "split cells",
           [split, to = stays.data()] __device__(std::uint64_t i) { to[i] = split[i] == 0; });
  const DeviceBuffer<std::uint32_t> whole = flagged(stays.data(), cells.size(), stream);

  // Small cells first, then the unsplit ones; members of the small cells first, then all old ones.
  const std::size_t size = small.size() + whole.size();
  LooseCells loose{DeviceBuffer<Vec3f>(size, stream), DeviceBuffer<std::uint32_t>(size, stream),
                   DeviceBuffer<std::uint32_t>(size, stream),
                   DeviceBuffer<std::uint32_t>(numbers.size() + count, stream)};
  put_means(loose_points.data(), small, loose.means.data(), stream);
  put_cells({nullptr, small.begins.data(), nullptr, static_cast<std::uint32_t>(small.size())}, 0, 0,
            loose, stream);
  for_each(numbers.size(), stream, "split cells",
           [from = small.members.data(), all = numbers.data(),
            to = loose.members.data()] __device__(std::uint64_t i) { to[i] = all[from[i]]; });
  copy(cells.members.data(), count, loose.members.data() + numbers.size(), stream);
  for_each(whole.size(), stream, "split cells",
           [from = whole.data(), view = cells.view(), first_member = numbers.size(),
            means = loose.means.data() + small.size(), first = loose.first.data() + small.size(),
            lengths = loose.lengths.data() + small.size()] __device__(std::uint64_t i) {
             const std::uint32_t cell = from[i];
             means[i] = view.positions[cell];
             first[i] = static_cast<std::uint32_t>(first_member + view.begins[cell]);
             lengths[i] = view.begins[cell + 1] - view.begins[cell];
           });
  return in_curve_order(loose, count, box, stream);
}

}  // namespace adasplats::gpu
