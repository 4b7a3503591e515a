// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/base/warp.cuh"
#include "adasplats/gpu/segment/device_pyramid.h"
#include "adasplats/segment/pyramid/cell_grid.h"

namespace adasplats::gpu {
namespace {

constexpr int kKeyBits = 3 * CellGrid::kAxisBits;
constexpr std::uint32_t kSearchWarps = 4;  // per block
constexpr std::size_t kMaxShared = 48 * 1024;

/// A grid for points within 2^20 cells of the origin.
CellGrid wide_grid(float cell_m) {
  constexpr std::int64_t kHalf = std::int64_t{1} << (CellGrid::kAxisBits - 1);
  return {{-kHalf, -kHalf, -kHalf}, cell_m};
}

DeviceBuffer<std::uint64_t> keys_of(const DeviceBuffer<Vec3f>& points, CellGrid grid,
                                    cudaStream_t stream) {
  DeviceBuffer<std::uint64_t> keys(points.size(), stream);
  for_each(points.size(), stream, "put points into cells",
           [grid, from = points.data(), to = keys.data()] __device__(std::uint64_t i) {
             to[i] = grid.key(from[i]);
           });
  return keys;
}

/// Support points sorted into cells as wide as the radius.
struct SearchView {
  const Vec3f* supports;
  const std::uint64_t* keys;
  const std::uint32_t* order;
  std::uint32_t count;
  CellGrid grid;
  float radius_m;

  __device__ std::uint32_t first_not_below(std::uint64_t key) const {
    std::uint32_t low = 0, high = count;
    while (low < high) {
      const std::uint32_t middle = (low + high) / 2;
      if (keys[middle] < key)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }
};

struct Candidate {
  float squared_m;
  std::uint32_t index;

  __device__ bool operator<(const Candidate& other) const {
    return squared_m != other.squared_m ? squared_m < other.squared_m : index < other.index;
  }
};

/// Finds all support points within the radius with a warp: nine columns of three cells. Returns
/// their number.
__device__ std::uint32_t collect(const SearchView& search, Vec3f query, Candidate* found,
                                 std::uint32_t capacity) {
  const std::uint32_t lane = lane_of_thread();
  std::uint32_t begin = 0, end = 0;
  if (lane < 9) {
    const std::int64_t x = search.grid.cell(query, 0) + lane / 3 - 1;
    const std::int64_t y = search.grid.cell(query, 1) + lane % 3 - 1;
    const std::int64_t z = search.grid.cell(query, 2);
    begin = search.first_not_below(CellGrid::key_of_cell(x, y, z - 1));
    end = search.first_not_below(CellGrid::key_of_cell(x, y, z + 1) + 1);
  }
  std::uint32_t total = 0;
  for (int column = 0; column < 9; ++column) {
    const std::uint32_t first = __shfl_sync(kAllLanes, begin, column);
    const std::uint32_t last = __shfl_sync(kAllLanes, end, column);
    for (std::uint32_t at = first; at < last; at += kWarpLanes) {
      Candidate own{HUGE_VALF, 0};
      if (at + lane < last) {
        own.index = search.order[at + lane];
        const Vec3f way = search.supports[own.index] - query;
        own.squared_m = dot(way, way);
      }
      const bool is_inside = own.squared_m < search.radius_m * search.radius_m;
      const std::uint32_t inside = __ballot_sync(kAllLanes, is_inside);
      const std::uint32_t place = total + lanes_before(inside);
      if (is_inside && place < capacity) found[place] = own;
      total += __popc(inside);
    }
  }
  __syncwarp();
  return ::min(total, capacity);
}

__global__ void __launch_bounds__(kSearchWarps* kWarpLanes)
    neighbors_kernel(SearchView search, const Vec3f* queries, std::uint32_t count,
                     std::uint32_t slots, std::uint32_t capacity, std::uint32_t* table) {
  extern __shared__ Candidate candidates[];
  const std::uint32_t warp = threadIdx.x / kWarpLanes;
  const std::uint32_t query = blockIdx.x * kSearchWarps + warp;
  if (query >= count) return;
  Candidate* const found = candidates + warp * capacity;
  const std::uint32_t total = collect(search, queries[query], found, capacity);
  std::uint32_t* const row = table + std::size_t{query} * slots;
  for (std::uint32_t k = total + lane_of_thread(); k < slots; k += kWarpLanes)
    row[k] = NeighborTable::kNone;
  for (std::uint32_t k = lane_of_thread(); k < total; k += kWarpLanes) {
    const Candidate own = found[k];
    std::uint32_t rank = 0;
    for (std::uint32_t other = 0; other < total; ++other) rank += found[other] < own ? 1 : 0;
    if (rank < slots) row[rank] = own.index;
  }
}

/// Upper bound of the number of cells that a ball touches: their centres are within half a diagonal
/// of it, so a ball larger by a full diagonal contains them.
std::uint32_t max_cells(float radius_m, float cell_m) {
  const double reach = static_cast<double>(radius_m) / static_cast<double>(cell_m) + std::sqrt(3.0);
  return static_cast<std::uint32_t>(std::ceil(4.0 / 3 * 3.14159265 * reach * reach * reach));
}

/// find_neighbors(); support points: at most one per cell of `cell_m`.
DeviceBuffer<std::uint32_t> find_neighbors(const DeviceBuffer<Vec3f>& queries,
                                           const DeviceBuffer<Vec3f>& supports, float radius_m,
                                           std::uint32_t slots, float cell_m, cudaStream_t stream) {
  const CellGrid grid = wide_grid(radius_m);
  DeviceBuffer<std::uint64_t> keys = keys_of(supports, grid, stream);
  const DeviceBuffer<std::uint32_t> order = sort_order(keys, stream, 0, kKeyBits);
  const auto count = static_cast<std::uint32_t>(queries.size());
  const std::uint32_t capacity = max_cells(radius_m, cell_m);
  const std::size_t shared = std::size_t{kSearchWarps} * capacity * sizeof(Candidate);
  if (shared > kMaxShared)
    throw Error(ErrorKind::unavailable,
                "the network's neighbourhoods are too wide for a GPU; use "
                "`device` cpu");
  DeviceBuffer<std::uint32_t> table(std::size_t{count} * slots, stream);
  if (count == 0) return table;
  const SearchView search{
      supports.data(), keys.data(), order.data(), static_cast<std::uint32_t>(supports.size()), grid,
      radius_m};
  neighbors_kernel<<<(count + kSearchWarps - 1) / kSearchWarps, kSearchWarps * kWarpLanes, shared,
                     stream>>>(search, queries.data(), count, slots, capacity, table.data());
  cuda_check(cudaGetLastError(), "find neighbours");
  return table;
}

/// Columns of 1 m, as in heights_above_ground().
constexpr int kReach = 4;

struct ColumnBounds {
  int low_x, low_y, high_x, high_y;
};

__device__ int column_of(float coordinate) { return static_cast<int>(floorf(coordinate / 1.0F)); }

ColumnBounds bounds_of(const DeviceBuffer<Vec3f>& points, cudaStream_t stream) {
  constexpr int kFar = 1 << 30;
  const std::vector<ColumnBounds> none = {{kFar, kFar, -kFar, -kFar}};
  const DeviceBuffer<ColumnBounds> bounds(std::span<const ColumnBounds>(none), stream);
  for_each(points.size(), stream, "find the columns of points",
           [from = points.data(), to = bounds.data()] __device__(std::uint64_t i) {
             const int x = column_of(from[i].x), y = column_of(from[i].y);
             if (x < to->low_x) atomicMin(&to->low_x, x);
             if (y < to->low_y) atomicMin(&to->low_y, y);
             if (x > to->high_x) atomicMax(&to->high_x, x);
             if (y > to->high_y) atomicMax(&to->high_y, y);
           });
  return read_value(bounds.data(), stream);
}

struct Columns {
  int width, height;

  std::size_t size() const { return static_cast<std::size_t>(width) * height; }
  __device__ std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * width + x;
  }
};

/// Combines each column with its neighbours along x or y.
template <class Body>
DeviceBuffer<float> spread_along(const DeviceBuffer<float>& numbers, Columns columns, bool along_x,
                                 float start, cudaStream_t stream, Body body) {
  DeviceBuffer<float> result(numbers.size(), stream);
  for_each(numbers.size(), stream, "find the ground",
           [=, from = numbers.data(), to = result.data()] __device__(std::uint64_t i) {
             const int x = static_cast<int>(i % columns.width);
             const int y = static_cast<int>(i / columns.width);
             float sum = start;
             for (int d = -kReach; d <= kReach; ++d) {
               const int u = along_x ? x + d : x, v = along_x ? y : y + d;
               if (u < 0 || v < 0 || u >= columns.width || v >= columns.height) continue;
               sum = body(sum, from[columns.place(u, v)]);
             }
             to[i] = sum;
           });
  return result;
}

struct Least {
  __device__ float operator()(float a, float b) const { return fminf(a, b); }
};
struct Plus {
  __device__ float operator()(float a, float b) const { return a + b; }
};

template <class Body>
DeviceBuffer<float> spread(const DeviceBuffer<float>& numbers, Columns columns, float start,
                           cudaStream_t stream, Body body) {
  return spread_along(spread_along(numbers, columns, true, start, stream, body), columns, false,
                      start, stream, body);
}

DeviceBuffer<float> lowest_of_columns(const DeviceBuffer<Vec3f>& points, ColumnBounds bounds,
                                      Columns columns, cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> bits(columns.size(), stream);
  bits.fill_bytes(0xff);
  for_each(points.size(), stream, "find the ground",
           [=, from = points.data(), to = bits.data()] __device__(std::uint64_t i) {
             const Vec3f p = from[i];
             atomicMin(
                 to + columns.place(column_of(p.x) - bounds.low_x, column_of(p.y) - bounds.low_y),
                 sortable_bits(p.z));
           });
  DeviceBuffer<float> lowest(columns.size(), stream);
  for_each(columns.size(), stream, "find the ground",
           [from = bits.data(), to = lowest.data()] __device__(std::uint64_t i) {
             to[i] = from[i] == 0xffffffffU ? HUGE_VALF : from_sortable_bits(from[i]);
           });
  return lowest;
}

}  // namespace

DeviceCellMeans means_by_cell(const DeviceBuffer<Vec3f>& points, float cell_m,
                              cudaStream_t stream) {
  DeviceCellMeans cells;
  DeviceBuffer<std::uint64_t> keys = keys_of(points, wide_grid(cell_m), stream);
  cells.order = sort_order(keys, stream, 0, kKeyBits);
  cells.begins = run_begins(keys.data(), keys.size(), stream);
  const std::size_t count = cells.begins.size() - 1;
  cells.means = DeviceBuffer<Vec3f>(count, stream);
  cells.cell_of = DeviceBuffer<std::uint32_t>(points.size(), stream);
  for_each(
      count, stream, "average the points of cells",
      [from = points.data(), order = cells.order.data(), begins = cells.begins.data(),
       means = cells.means.data(), cell_of = cells.cell_of.data()] __device__(std::uint64_t cell) {
        const std::uint32_t begin = begins[cell], end = begins[cell + 1];
        const Vec3f first = from[order[begin]];
        Vec3f sum;
        for (std::uint32_t k = begin; k < end; ++k) {
          sum = sum + (from[order[k]] - first);
          cell_of[order[k]] = static_cast<std::uint32_t>(cell);
        }
        means[cell] = first + sum / static_cast<float>(end - begin);
      });
  return cells;
}

std::vector<DeviceLevel> make_pyramid(DeviceBuffer<Vec3f> points, const PyramidShape& shape,
                                      cudaStream_t stream) {
  std::vector<DeviceLevel> levels;
  float cell_m = shape.cell_m;
  for (int k = 0; k < shape.levels; ++k, cell_m *= 2) {
    DeviceLevel& level = levels.emplace_back();
    level.cell_m = cell_m;
    level.points = std::move(points);
    const float radius_m = shape.radius * cell_m;
    level.neighbors =
        find_neighbors(level.points, level.points, radius_m, shape.neighbors, cell_m, stream);
    if (k + 1 == shape.levels) break;
    points = means_by_cell(level.points, 2 * cell_m, stream).means;
    level.pooled = find_neighbors(points, level.points, radius_m, shape.neighbors, cell_m, stream);
    level.coarser = find_neighbors(level.points, points, 4 * cell_m, 1, 2 * cell_m, stream);
  }
  return levels;
}

DeviceBuffer<float> heights_above_ground(const DeviceBuffer<Vec3f>& points, cudaStream_t stream) {
  DeviceBuffer<float> heights(points.size(), stream);
  if (points.empty()) return heights;
  const ColumnBounds bounds = bounds_of(points, stream);
  const Columns columns{bounds.high_x - bounds.low_x + 1, bounds.high_y - bounds.low_y + 1};
  DeviceBuffer<float> ground = spread(lowest_of_columns(points, bounds, columns, stream), columns,
                                      HUGE_VALF, stream, Least());
  DeviceBuffer<float> known(columns.size(), stream);
  for_each(columns.size(), stream, "find the ground",
           [of_ground = ground.data(), of_known = known.data()] __device__(std::uint64_t i) {
             of_known[i] = of_ground[i] < HUGE_VALF ? 1.0F : 0.0F;
             if (of_known[i] == 0) of_ground[i] = 0;
           });
  known = spread(known, columns, 0, stream, Plus());
  ground = spread(ground, columns, 0, stream, Plus());
  for_each(points.size(), stream, "measure heights above the ground",
           [=, from = points.data(), to = heights.data(), of_ground = ground.data(),
            of_known = known.data()] __device__(std::uint64_t i) {
             const std::size_t place = columns.place(column_of(from[i].x) - bounds.low_x,
                                                     column_of(from[i].y) - bounds.low_y);
             to[i] = from[i].z - of_ground[place] / of_known[place];
           });
  return heights;
}

}  // namespace adasplats::gpu
