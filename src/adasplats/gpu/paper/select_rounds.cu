// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/neighbors/neighborhoods_lists.cuh"
#include "adasplats/gpu/paper/select_rounds.h"

namespace adasplats::gpu {
namespace {

enum State : std::uint32_t { kOpen, kDiscarded, kTaken };

/// Kernel view of the selection. Candidate j is decided once all earlier candidates that list it
/// are: discarded if one of them was selected, selected otherwise. `blockers` counts the open ones,
/// so only candidates whose count has just become 0 must be processed.
struct Selection {
  ListsView discards;
  const std::uint32_t* turns;  ///< position of each candidate in the order; kNoTurn: none
  std::uint32_t* blockers;
  std::uint32_t* states;

  static constexpr std::uint32_t kNoTurn = 0xffffffffU;
};

/// Candidates to be processed; queues of consecutive rounds have separate counters, so the host
/// need not read the counter after each round.
struct Queue {
  std::uint32_t* members;
  std::uint32_t* size;

  __device__ void push(std::uint32_t candidate) const { members[atomicAdd(size, 1U)] = candidate; }
};

constexpr unsigned kRoundBlocks = 1024;

/// Calls body(candidate) for the members of a queue, with 8 threads for each.
template <class F>
__device__ void for_queue(const Queue& queue, const F& body) {
  constexpr std::uint32_t kGroup = 8;
  const std::uint32_t size = *queue.size;
  const std::uint32_t first = (blockIdx.x * kBlockThreads + threadIdx.x) / kGroup;
  for (std::uint32_t i = first; i < size; i += gridDim.x * kBlockThreads / kGroup)
    body(queue.members[i], threadIdx.x % kGroup, kGroup);
}

/// Selects all candidates of a queue; they discard the later candidates of their lists.
__global__ void __launch_bounds__(kBlockThreads)
    take_kernel(Selection selection, Queue ready, Queue discarded) {
  for_queue(ready, [&](std::uint32_t candidate, std::uint32_t lane, std::uint32_t lanes) {
    if (lane == 0) selection.states[candidate] = kTaken;
    const std::uint32_t turn = selection.turns[candidate];
    const std::uint32_t* list = selection.discards.of(candidate);
    for (std::uint32_t k = lane; k < selection.discards.sizes[candidate]; k += lanes) {
      const std::uint32_t other = list[k];
      if (selection.turns[other] > turn &&
          atomicCAS(selection.states + other, kOpen, kDiscarded) == kOpen)
        discarded.push(other);
    }
  });
}

/// Discarded candidates no longer block those after them.
__global__ void __launch_bounds__(kBlockThreads)
    release_kernel(Selection selection, Queue discarded, Queue ready) {
  for_queue(discarded, [&](std::uint32_t candidate, std::uint32_t lane, std::uint32_t lanes) {
    const std::uint32_t turn = selection.turns[candidate];
    if (turn == Selection::kNoTurn) return;  // it blocked no candidate
    const std::uint32_t* list = selection.discards.of(candidate);
    for (std::uint32_t k = lane; k < selection.discards.sizes[candidate]; k += lanes) {
      const std::uint32_t other = list[k];
      const std::uint32_t others_turn = selection.turns[other];
      if (others_turn <= turn || others_turn == Selection::kNoTurn) continue;
      if (atomicSub(selection.blockers + other, 1U) == 1U && selection.states[other] == kOpen)
        ready.push(other);
    }
  });
}

/// Positions in the visiting order; candidates without a radius have none.
DeviceBuffer<std::uint32_t> turns_of(const DeviceBuffer<float>& radii, const DeviceLists& discards,
                                     SelectionOrder order, cudaStream_t stream) {
  const std::size_t size = radii.size();
  DeviceBuffer<std::uint64_t> keys(size, stream);
  for_each(size, stream, "select splats",
           [order, radii = radii.data(), view = discards.view(),
            to = keys.data()] __device__(std::uint64_t i) {
             to[i] = visiting_key(order, static_cast<std::uint32_t>(i), radii[i], view.sizes[i]);
           });
  const DeviceBuffer<std::uint32_t> visiting = sort_order(keys, stream);
  DeviceBuffer<std::uint32_t> turns(size, stream);
  for_each(size, stream, "select splats",
           [radii = radii.data(), from = visiting.data(),
            to = turns.data()] __device__(std::uint64_t i) {
             const std::uint32_t rank = from[i];
             to[rank] = radii[rank] > 0.0F ? static_cast<std::uint32_t>(i) : Selection::kNoTurn;
           });
  return turns;
}

/// Counts the blockers of each candidate, and queues candidates without blockers.
void begin(const Selection& selection, std::size_t size, const Queue& ready, cudaStream_t stream) {
  for_each_warp(size, stream, "select splats", [selection] __device__(std::uint32_t i) {
    const std::uint32_t turn = selection.turns[i];
    if (turn == Selection::kNoTurn) return;
    const std::uint32_t* list = selection.discards.of(i);
    for (std::uint32_t k = lane_of_thread(); k < selection.discards.sizes[i]; k += kWarpLanes) {
      const std::uint32_t others_turn = selection.turns[list[k]];
      if (others_turn > turn && others_turn != Selection::kNoTurn)
        atomicAdd(selection.blockers + list[k], 1U);
    }
  });
  for_each(size, stream, "select splats", [selection, ready] __device__(std::uint64_t i) {
    if (selection.turns[i] != Selection::kNoTurn && selection.blockers[i] == 0)
      ready.push(static_cast<std::uint32_t>(i));
  });
}

DeviceBuffer<std::uint32_t> taken(const DeviceBuffer<std::uint32_t>& states, cudaStream_t stream) {
  DeviceBuffer<std::uint8_t> flags(states.size(), stream);
  for_each(states.size(), stream, "select splats",
           [from = states.data(), to = flags.data()] __device__(std::uint64_t i) {
             to[i] = from[i] == kTaken;
           });
  return flagged(flags.data(), flags.size(), stream);
}

}  // namespace

DeviceBuffer<std::uint32_t> select_greedily(const DeviceBuffer<float>& radii,
                                            const DeviceLists& discards, SelectionOrder order,
                                            cudaStream_t stream) {
  const std::size_t size = radii.size();
  if (size == 0) return {};
  const DeviceBuffer<std::uint32_t> turns = turns_of(radii, discards, order, stream);
  DeviceBuffer<std::uint32_t> blockers(size, stream), states(size, stream);
  DeviceBuffer<std::uint32_t> ready(size, stream), next_ready(size, stream), out(size, stream);
  blockers.fill_bytes(0);
  states.fill_bytes(0);
  const Selection selection{discards.view(), turns.data(), blockers.data(), states.data()};

  // Many rounds are queued at a time; those after the last one have nothing to do.
  constexpr std::size_t kRoundsAtOnce = 16;
  DeviceBuffer<std::uint32_t> counters(2 * kRoundsAtOnce + 1, stream);
  counters.fill_bytes(0);
  begin(selection, size, {ready.data(), counters.data()}, stream);
  std::uint32_t pending = 1;
  while (pending > 0) {
    for (std::size_t round = 0; round < kRoundsAtOnce; ++round) {
      std::uint32_t* const counter = counters.data() + 2 * round;
      take_kernel<<<kRoundBlocks, kBlockThreads, 0, stream>>>(
          selection, Queue{ready.data(), counter}, Queue{out.data(), counter + 1});
      release_kernel<<<kRoundBlocks, kBlockThreads, 0, stream>>>(
          selection, Queue{out.data(), counter + 1}, Queue{next_ready.data(), counter + 2});
      cuda_check(cudaGetLastError(), "select splats");
      std::swap(ready, next_ready);
    }
    pending = read_value(counters.data() + 2 * kRoundsAtOnce, stream);
    counters.fill_bytes(0);
    cuda_check(
        cudaMemcpyAsync(counters.data(), &pending, sizeof(pending), cudaMemcpyHostToDevice, stream),
        "select splats");
  }
  return taken(states, stream);
}

}  // namespace adasplats::gpu
