// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/consistent/consistent_cover.cuh"
#include "adasplats/gpu/neighbors/neighborhoods.cuh"

namespace adasplats::gpu {
namespace {

constexpr std::size_t kPlacesAtFirst = 64;  // initial list entries per seed; grows if needed
constexpr int kRoundsAtOnce = 4;            // before the host reads the number of open disks

/// Grows one seed over its neighbours and lists the seeds that it covers.
struct Grow {
  CoverView cover;
  const std::uint8_t* unchecked;  ///< flags of seeds; null: none
  std::uint64_t* begins;
  CoverOptions options;
  unsigned long long* listed;  ///< used entries of the lists
  unsigned long long capacity;

  /// The k-th neighbour, if it exists.
  __device__ bool is_there(const std::uint64_t* keys, std::uint32_t size, std::uint32_t k,
                           Disk& other) const {
    if (k >= size) return false;
    other = cover.seeds[static_cast<std::uint32_t>(keys[k])];
    return other.radius > 0;
  }

  __device__ float radius_m(const Disk& disk, int sector_count, const std::uint64_t* keys,
                            std::uint32_t size) const {
    Disk other;
    auto end_m = static_cast<float>(options.largest_radius_m);
    for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes) {
      if (!is_there(keys, size, k, other)) continue;
      const DiskOffset place = disk_offset(disk, other.center);
      if (ends_at(place, grows_over(disk, other, place, options), options))
        end_m = std::min(end_m, place.along_m);
    }
    end_m = warp_smallest(end_m);
    float reach_m = disk.radius;
    SectorReach sectors(disk, sector_count);
    for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes) {
      if (!is_there(keys, size, k, other)) continue;
      const DiskOffset place = disk_offset(disk, other.center);
      if (place.along_m < end_m && grows_over(disk, other, place, options)) {
        reach_m = std::max(reach_m, place.along_m);
        sectors.add(other.center, place.along_m);
      }
    }
    for (int i = 0; i < sectors.sectors(); ++i) {
      sectors.reach_m(i) = warp_largest(sectors.reach_m(i));
    }
    return grown_radius(disk, warp_largest(reach_m), sectors);
  }

  /// Calls found(rank, is_covered) with all lanes, for 32 neighbours at a time.
  template <class F>
  __device__ void covered(const Disk& disk, float covered_m, const std::uint64_t* keys,
                          std::uint32_t size, const F& found) const {
    Disk other;
    for (std::uint32_t first = 0; first < size; first += kWarpLanes) {
      const std::uint32_t k = first + lane_of_thread();
      const bool is_covered = is_there(keys, size, k, other) &&
                              may_cover(disk_offset(disk, other.center), covered_m, options);
      found(is_covered ? static_cast<std::uint32_t>(keys[k]) : 0, is_covered);
    }
  }

  __device__ void operator()(std::uint32_t seed, const std::uint64_t* keys,
                             std::uint32_t size) const {
    const Disk disk = cover.seeds[seed];
    const bool is_unchecked = unchecked != nullptr && unchecked[seed] != 0;
    const int sectors = is_unchecked ? options.unchecked_sectors : options.sectors;
    const float own_m = radius_m(disk, sectors, keys, size);
    const float covered_m = covered_reach(cover.overlap, own_m);
    std::uint32_t length = 0;
    covered(disk, covered_m, keys, size, [&](std::uint32_t, bool is_covered) {
      length += __popc(__ballot_sync(kAllLanes, is_covered));
    });
    unsigned long long begin = 0;
    if (lane_of_thread() == 0) {
      begin = atomicAdd(listed, static_cast<unsigned long long>(length));
      cover.radii_m[seed] = own_m;
      begins[seed] = begin;
      cover.lengths[seed] = length;
    }
    begin = __shfl_sync(kAllLanes, begin, 0);
    if (begin + length > capacity) return;  // repeated with a larger capacity
    std::uint32_t* to = cover.lists + begin;
    covered(disk, covered_m, keys, size, [&](std::uint32_t rank, bool is_covered) {
      const std::uint32_t lanes = __ballot_sync(kAllLanes, is_covered);
      if (is_covered) to[lanes_before(lanes)] = rank;
      to += __popc(lanes);
    });
  }
};

/// Removes from a disk's list the seeds that it no longer covers: radii only shrink, and removed
/// disks do not return.
struct ShortenList {
  CoverView cover;

  __device__ void operator()(std::uint32_t i) const {
    const Disk disk = cover.seeds[i];
    const std::uint32_t size = cover.lengths[i];
    const float covered_m = covered_reach(cover.overlap, cover.radii_m[i]);
    std::uint32_t* const list = cover.lists + cover.begins[i];
    std::uint32_t kept = 0;
    for (std::uint32_t first = 0; first < size; first += kWarpLanes) {
      const std::uint32_t k = first + lane_of_thread();
      const std::uint32_t other = k < size ? list[k] : 0;
      const bool stays = k < size && disk.radius > 0 && cover.seeds[other].radius > 0 &&
                         disk_offset(disk, cover.seeds[other].center).along_m <= covered_m;
      const std::uint32_t lanes = __ballot_sync(kAllLanes, stays);
      if (stays) list[kept + lanes_before(lanes)] = other;
      kept += __popc(lanes);
    }
    if (lane_of_thread() == 0) cover.lengths[i] = kept;
  }
};

/// State of one choice of disks.
struct Choice {
  static constexpr std::uint8_t kOpen = 0, kChosen = 1, kClosed = 2;
  CoverView cover;
  std::uint8_t* states;
  std::uint32_t* blocked;  ///< last round in which an earlier open disk covered it

  /// Whether the greedy order has disk `a` before `b`.
  __device__ bool comes_before(std::uint32_t a, std::uint32_t b) const {
    const std::uint32_t covers_a = cover.lengths[a], covers_b = cover.lengths[b];
    return covers_a > covers_b || (covers_a == covers_b && a < b);
  }

  /// Calls body(other) for the later disks that disk `i` covers.
  template <class F>
  __device__ void for_later(std::uint32_t i, const F& body) const {
    const std::uint32_t* const list = cover.lists + cover.begins[i];
    const std::uint32_t size = cover.lengths[i];
    for (std::uint32_t k = lane_of_thread(); k < size; k += kWarpLanes) {
      const std::uint32_t other = list[k];
      if (states[other] == kOpen && comes_before(i, other)) body(other);
    }
  }
};

/// The open disks, unordered, and their number.
struct OpenDisks {
  std::uint32_t* numbers;
  std::uint32_t* count;
};

struct BlockLater {
  Choice choice;
  OpenDisks open;
  std::uint32_t round;

  __device__ void operator()(std::uint32_t i) const {
    if (i >= *open.count) return;
    choice.for_later(open.numbers[i], [&](std::uint32_t other) { choice.blocked[other] = round; });
  }
};

struct TakeUnblocked {
  Choice choice;
  OpenDisks open;
  std::uint32_t round;

  __device__ void operator()(std::uint32_t i) const {
    if (i >= *open.count) return;
    const std::uint32_t disk = open.numbers[i];
    if (choice.blocked[disk] == round) return;
    choice.for_later(disk, [&](std::uint32_t other) { choice.states[other] = Choice::kClosed; });
    if (lane_of_thread() == 0) choice.states[disk] = Choice::kChosen;
  }
};

struct ListOpen {
  Choice choice;
  OpenDisks from;
  OpenDisks to;

  __device__ void operator()(std::uint64_t i) const {
    if (i >= *from.count) return;
    const std::uint32_t disk = from.numbers[i];
    if (choice.states[disk] == Choice::kOpen) to.numbers[atomicAdd(to.count, 1U)] = disk;
  }
};

/// Chooses until no disk is open; returns the number of rounds.
int choose_in_rounds(const Choice& choice, std::uint32_t open_count, OpenDisks now, OpenDisks next,
                     cudaStream_t stream) {
  int rounds = 0;
  while (open_count > 0) {
    for (int k = 0; k < kRoundsAtOnce; ++k) {
      const auto round = static_cast<std::uint32_t>(++rounds);
      for_each_warp(open_count, stream, "choose disks", BlockLater{choice, now, round});
      for_each_warp(open_count, stream, "choose disks", TakeUnblocked{choice, now, round});
      cuda_check(cudaMemsetAsync(next.count, 0, sizeof(std::uint32_t), stream), "choose disks");
      for_each(open_count, stream, "choose disks", ListOpen{choice, now, next});
      std::swap(now, next);
    }
    open_count = read_value(now.count, stream);
  }
  return rounds;
}

DeviceBuffer<std::uint32_t> numbers_of_present(const Disk* seeds, std::size_t count,
                                               cudaStream_t stream) {
  DeviceBuffer<std::uint8_t> present(count, stream);
  for_each(count, stream, "choose disks", [seeds, to = present.data()] __device__(std::uint64_t i) {
    to[i] = seeds[i].radius > 0;
  });
  return flagged(present.data(), count, stream);
}

DeviceBuffer<Disk> chosen_disks(const Choice& choice, cudaStream_t stream) {
  DeviceBuffer<Disk> chosen(choice.cover.size, stream);
  for_each(choice.cover.size, stream, "choose disks",
           [choice, to = chosen.data()] __device__(std::uint64_t i) {
             Disk disk;
             if (choice.states[i] == Choice::kChosen) {
               disk = choice.cover.seeds[i];
               disk.radius = choice.cover.radii_m[i];
             }
             to[i] = disk;
           });
  return chosen;
}

/// Returns the number of entries that the lists need.
std::uint64_t grow(const DevicePointIndex& index, const Grow& grow_seed, cudaStream_t stream) {
  cuda_check(cudaMemsetAsync(grow_seed.listed, 0, sizeof(*grow_seed.listed), stream), "grow disks");
  for_each_neighborhood_of(
      grow_seed.options.neighbors, index, stream, "grow disks",
      [cover = grow_seed.cover, count = grow_seed.options.neighbors] __device__(
          std::uint32_t seed) { return NeighborLimit{cover.seeds[seed].radius > 0 ? count : 0}; },
      grow_seed);
  return read_value(grow_seed.listed, stream);
}

}  // namespace

DeviceCover::DeviceCover(const Disk* seeds, const std::uint8_t* unchecked,
                         const DevicePointIndex& index, const CoverOptions& options,
                         cudaStream_t stream)
    : stream_(stream),
      overlap_(options.overlap),
      seeds_(index.size(), stream),
      radii_m_(index.size(), stream),
      lists_(index.size() * kPlacesAtFirst, stream),
      begins_(index.size(), stream),
      lengths_(index.size(), stream) {
  if (index.size() == 0) return;
  cuda_check(
      cudaMemcpyAsync(seeds_.data(), seeds, seeds_.bytes(), cudaMemcpyDeviceToDevice, stream),
      "copy seeds");
  radii_m_.fill_bytes(0);
  begins_.fill_bytes(0);
  lengths_.fill_bytes(0);
  const DeviceBuffer<unsigned long long> listed(1, stream);
  const auto needed = [&] {
    return grow(index, {view(), unchecked, begins_.data(), options, listed.data(), lists_.size()},
                stream);
  };
  const std::uint64_t places = needed();
  if (places <= lists_.size()) return;
  lists_ = DeviceBuffer<std::uint32_t>(places, stream);
  needed();
}

CoverView DeviceCover::view() const {
  return {seeds_.data(),
          radii_m_.data(),
          lists_.data(),
          begins_.data(),
          lengths_.data(),
          overlap_,
          static_cast<std::uint32_t>(seeds_.size())};
}

DeviceBuffer<Disk> DeviceCover::choose() {
  const std::size_t count = seeds_.size();
  DeviceBuffer<std::uint8_t> states(count, stream_);
  DeviceBuffer<std::uint32_t> blocked(count, stream_);
  states.fill_bytes(Choice::kOpen);
  blocked.fill_bytes(0);
  const Choice choice = {view(), states.data(), blocked.data()};
  for_each_warp(choice.cover.size, stream_, "choose disks", ShortenList{choice.cover});

  const DeviceBuffer<std::uint32_t> open = numbers_of_present(seeds_.data(), count, stream_);
  const DeviceBuffer<std::uint32_t> other(open.size(), stream_);
  const auto open_count = static_cast<std::uint32_t>(open.size());
  DeviceBuffer<std::uint32_t> counts(2, stream_);
  const std::uint32_t initial[] = {open_count, 0};
  counts.upload(initial);
  rounds_ = choose_in_rounds(choice, open_count, {open.data(), counts.data()},
                             {other.data(), counts.data() + 1}, stream_);
  return chosen_disks(choice, stream_);
}

}  // namespace adasplats::gpu
