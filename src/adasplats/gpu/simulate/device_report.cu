// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <vector>

#include "adasplats/gpu/base/warp.cuh"
#include "adasplats/gpu/simulate/device_report.h"

namespace adasplats::gpu {
namespace {

constexpr unsigned kThreads = 256;
constexpr unsigned kWarps = kThreads / kWarpLanes;

__device__ ScanState state_of(const LaunchPoses& poses, std::uint32_t scan) {
  ScanState state;
  state.scan_index = poses.first_scan + scan;
  const std::uint32_t first = poses.first_knots == nullptr ? scan : poses.first_knots[scan];
  const std::uint32_t end = poses.first_knots == nullptr ? scan + 1 : poses.first_knots[scan + 1];
  state.knots = poses.knots + first;
  state.knot_count = end - first;
  if (poses.frame_knots != nullptr && state.knot_count > 1)
    state.frame_knots = poses.frame_knots + first;
  return state;
}

/// Exclusive sum over the threads of a block; `total`: over all. Every thread must call it.
__device__ std::uint32_t sum_before(std::uint32_t value, std::uint32_t& total) {
  __shared__ std::uint32_t of_warps[kWarps];
  std::uint32_t sum = value;
  for (unsigned apart = 1; apart < kWarpLanes; apart *= 2) {
    const std::uint32_t other = __shfl_up_sync(kAllLanes, sum, apart);
    if (lane_of_thread() >= apart) sum += other;
  }
  const unsigned warp = threadIdx.x / kWarpLanes;
  __syncthreads();  // a call before this one may still be reading
  if (lane_of_thread() == kWarpLanes - 1) of_warps[warp] = sum;
  __syncthreads();
  std::uint32_t before = sum - value;
  total = 0;
  for (unsigned i = 0; i < kWarps; ++i) {
    if (i < warp) before += of_warps[i];
    total += of_warps[i];
  }
  return before;
}

/// A block belongs to one scan: y; x counts the blocks of the scan.
template <int kMost>
__global__ void __launch_bounds__(kThreads)
    report_kernel(FiringRules rules, LaunchPoses poses, const Hit* hits, ReportSpace space) {
  const std::uint32_t scan = blockIdx.y;
  const std::uint32_t firing = blockIdx.x * kThreads + threadIdx.x;
  std::uint32_t count = 0;
  if (firing < poses.firings) {
    const std::uint64_t i = std::uint64_t{scan} * poses.firings + firing;
    ReportedReturn found[kMost + 1];
    const std::uint64_t a_firing = static_cast<std::uint64_t>(rules.beam.sub_rays) *
                                   static_cast<std::uint64_t>(rules.beam.depth);
    const ScanHits of_scan = {hits + std::uint64_t{scan} * poses.firings * a_firing, a_firing, 0,
                              poses.firings};
    count = static_cast<std::uint32_t>(
        report_firing<kMost>(rules, state_of(poses, scan), firing, of_scan, found));
    const auto room = static_cast<std::uint64_t>(rules.beam.returns);
    for (std::uint32_t k = 0; k < count; ++k) space.returns[i * room + k] = found[k];
    space.counts[i] = static_cast<std::uint8_t>(count);
  }
  std::uint32_t total = 0;
  sum_before(count, total);
  if (threadIdx.x == 0) space.block_counts[scan * gridDim.x + blockIdx.x] = total;
}

/// One block: turns counts into their exclusive prefix sums, followed by the total.
__global__ void __launch_bounds__(kThreads)
    offsets_kernel(std::uint32_t* counts, std::uint32_t count, std::uint32_t blocks_a_scan,
                   std::uint32_t* offsets) {
  std::uint32_t sum = 0;
  for (std::uint32_t begin = 0; begin < count; begin += kThreads) {
    const std::uint32_t i = begin + threadIdx.x;
    std::uint32_t total = 0;
    const std::uint32_t before = sum_before(i < count ? counts[i] : 0, total);
    if (i < count) {
      counts[i] = sum + before;
      if (i % blocks_a_scan == 0) offsets[i / blocks_a_scan] = sum + before;
    }
    sum += total;
  }
  if (threadIdx.x == 0) offsets[count / blocks_a_scan] = sum;
}

__device__ void write_return(const FiringRules& rules, const ScanState& state, std::uint32_t firing,
                             const ReportedReturn& one, const ReturnArrays& arrays,
                             std::uint32_t to) {
  const Firing& fired = rules.firings[firing];
  if (arrays.positions != nullptr)
    arrays.positions[to] = reported_position(rules, state, firing, one.range_m);
  if (arrays.ranges_m != nullptr) arrays.ranges_m[to] = one.range_m;
  if (arrays.intensities != nullptr) arrays.intensities[to] = one.intensity;
  if (arrays.classes != nullptr) arrays.classes[to] = one.class_id;
  if (arrays.instances != nullptr)
    arrays.instances[to] =
        one.primitive < rules.primitive_count ? rules.primitives[one.primitive].instance : 0;
  if (arrays.rings != nullptr) arrays.rings[to] = fired.ring;
  if (arrays.columns != nullptr) arrays.columns[to] = fired.column;
  if (arrays.times_s != nullptr) arrays.times_s[to] = fired.time_s;
  if (arrays.return_indices != nullptr)
    arrays.return_indices[to] = static_cast<std::uint8_t>(one.index);
}

__global__ void __launch_bounds__(kThreads)
    returns_kernel(FiringRules rules, LaunchPoses poses, ReportSpace space, ReturnArrays arrays) {
  const std::uint32_t scan = blockIdx.y;
  const std::uint32_t firing = blockIdx.x * kThreads + threadIdx.x;
  const std::uint64_t i = std::uint64_t{scan} * poses.firings + firing;
  const std::uint32_t count = firing < poses.firings ? space.counts[i] : 0;
  std::uint32_t total = 0;
  const std::uint32_t before = sum_before(count, total);
  if (count == 0) return;
  const std::uint32_t first = space.block_counts[scan * gridDim.x + blockIdx.x] + before;
  const ScanState state = state_of(poses, scan);
  const auto room = static_cast<std::uint64_t>(rules.beam.returns);
  for (std::uint32_t k = 0; k < count; ++k)
    write_return(rules, state, firing, space.returns[i * room + k], arrays, first + k);
}

dim3 grid_of(const LaunchPoses& poses) {
  return {(poses.firings + kThreads - 1) / kThreads, poses.scans, 1};
}

template <class T>
DeviceBuffer<T> upload_values(std::span<const T> values, cudaStream_t stream) {
  return values.empty() ? DeviceBuffer<T>() : DeviceBuffer<T>(values, stream);
}

}  // namespace

DeviceBuffer<PrimitiveValues> upload_primitives(const PrimitiveTable& table, cudaStream_t stream) {
  return upload_values(table.values, stream);
}

DeviceRules::DeviceRules(const ScanRules& rules, const PrimitiveValues* primitives,
                         cudaStream_t stream)
    : view_(rules.view()),
      firings_(upload_values(rules.firings(), stream)),
      range_offsets_m_(upload_values(rules.range_offsets_m(), stream)),
      ring_noise_m_(upload_values(rules.ring_noise_m(), stream)),
      weights_(upload_values(rules.weights(), stream)),
      blocked_(upload_values(rules.blocked(), stream)),
      body_cells_(upload_values(rules.body_cells(), stream)),
      body_(upload_values(rules.body(), stream)),
      expected_(upload_values(rules.expected(), stream)) {
  // The four tables of the response in one: nodes and gains of ranges, then of incidence angles.
  std::vector<float> gains;
  GainTable* const tables[] = {&view_.range_gain, &view_.incidence_gain};
  for (const GainTable* table : tables) {
    gains.insert(gains.end(), table->nodes, table->nodes + table->count);
    gains.insert(gains.end(), table->gains, table->gains + table->count);
  }
  gains_ = upload_values(std::span<const float>(gains), stream);
  const float* next = gains_.data();
  for (GainTable* table : tables) {
    table->nodes = next;
    table->gains = next + table->count;
    next += 2 * table->count;
  }
  view_.firings = firings_.data();
  view_.range_offsets_m = range_offsets_m_.data();
  view_.ring_noise_m = ring_noise_m_.data();
  upload_intensity(rules.intensity(), stream);
  if (const SensorFields* fields = rules.unit_fields()) {
    unit_fields_ = upload_values(std::span<const std::uint8_t>(fields->bytes), stream);
    view_.fields.bytes = unit_fields_.data();
  }
  view_.weights = weights_.data();
  view_.blocked = blocked_.data();
  view_.body_cells = body_cells_.data();
  view_.body = body_.data();
  view_.air.expected = expected_.data();
  view_.primitives = primitives;
}

/// The intensity tables of a calibrated sensor, concatenated.
void DeviceRules::upload_intensity(const SensorIntensity* unit, cudaStream_t stream) {
  if (unit == nullptr) return;
  std::vector<float> values;
  for (const auto* table :
       {&unit->ring_expected, &unit->ring_level, &unit->levels, &unit->zero_share, &unit->reported})
    values.insert(values.end(), table->begin(), table->end());
  unit_tables_ = upload_values(std::span<const float>(values), stream);
  IntensityRules& rules = view_.intensity;
  rules.ring_expected = unit_tables_.data();
  rules.ring_level = rules.ring_expected + unit->ring_expected.size();
  rules.levels = rules.ring_level + unit->ring_level.size();
  rules.zero_share = rules.levels + unit->levels.size();
  rules.reported = rules.zero_share + unit->zero_share.size();
}

std::size_t report_blocks(std::size_t scans, std::size_t firings) {
  return scans * ((firings + kThreads - 1) / kThreads);
}

void queue_reports(const FiringRules& rules, const LaunchPoses& poses, const Hit* hits,
                   const ReportSpace& space, cudaStream_t stream) {
  const dim3 grid = grid_of(poses);
  if (rules.beam.sub_rays == 1) {
    report_kernel<1><<<grid, kThreads, 0, stream>>>(rules, poses, hits, space);
  } else if (rules.beam.sub_rays <= kFewSubRays) {
    report_kernel<kFewSubRays><<<grid, kThreads, 0, stream>>>(rules, poses, hits, space);
  } else {
    report_kernel<static_cast<int>(kMaxSubRays)>
        <<<grid, kThreads, 0, stream>>>(rules, poses, hits, space);
  }
  cuda_check(cudaGetLastError(), "make returns on the GPU");
  const std::uint32_t blocks = grid.x * grid.y;
  offsets_kernel<<<1, kThreads, 0, stream>>>(space.block_counts, blocks, grid.x, space.offsets);
  cuda_check(cudaGetLastError(), "count returns on the GPU");
}

void queue_returns(const FiringRules& rules, const LaunchPoses& poses, const ReportSpace& space,
                   const ReturnArrays& arrays, cudaStream_t stream) {
  returns_kernel<<<grid_of(poses), kThreads, 0, stream>>>(rules, poses, space, arrays);
  cuda_check(cudaGetLastError(), "write returns on the GPU");
}

}  // namespace adasplats::gpu
