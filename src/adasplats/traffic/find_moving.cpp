// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/traffic/find_moving.h"

#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <utility>

#include "adasplats/traffic/ground_heights.h"

namespace adasplats {
namespace {

/// Distances in scans to the scans that are tested for free space: near ones for fast objects, far
/// ones for slow ones.
constexpr std::array<std::size_t, 10> kOffsets = {1, 2, 3, 4, 6, 8, 11, 15, 20, 26};

/// So many scans are read at once, by several threads.
constexpr std::size_t kAtOnce = 16;

/// Consecutive scans that are in memory.
class Window {
 public:
  Window(const KittiSequence& drive, std::span<const std::size_t> scans,
         const SeenSpaceOptions& options)
      : drive_(drive), scans_(scans), options_(options) {}

  /// Reads scans up to number `k` of the chosen ones; `ground` gets their points.
  void read_to(std::size_t k, GroundHeights& ground, const Executor& executor) {
    const std::size_t before = entries_.size(), end = std::min(scans_.size(), k + 1);
    if (end <= end_) return;
    entries_.resize(before + end - end_);
    std::vector<ScanHeights> heights(end - end_);
    executor.for_chunks(heights.size(), 1, [&](std::size_t n, std::size_t) {
      const std::size_t index = scans_[end_ + n];
      Entry& entry = entries_[before + n];
      entry.scan = read_all_returns(drive_, index);
      heights[n] = ScanHeights(drive_, index, entry.scan);
      entry.seen.emplace(drive_, index, entry.scan, options_);
    });
    for (const ScanHeights& of_scan : heights) ground.add(of_scan);
    end_ = end;
  }
  void forget_before(std::size_t k) {
    for (; begin_ < k && begin_ < end_; ++begin_) entries_.pop_front();
  }
  const KittiScan& scan(std::size_t k) const { return entries_[k - begin_].scan; }
  /// What the scans around `k` saw.
  std::vector<const SeenSpace*> others_of(std::size_t k) const {
    std::vector<const SeenSpace*> others;
    for (const std::size_t offset : kOffsets) {
      if (k >= offset) others.push_back(&*entries_[k - offset - begin_].seen);
      if (k + offset < end_) others.push_back(&*entries_[k + offset - begin_].seen);
    }
    return others;
  }

 private:
  struct Entry {
    KittiScan scan;
    std::optional<SeenSpace> seen;
  };
  const KittiSequence& drive_;
  std::span<const std::size_t> scans_;
  const SeenSpaceOptions& options_;
  std::size_t begin_ = 0, end_ = 0;  ///< of the chosen scans
  std::deque<Entry> entries_;
};

}  // namespace

std::vector<BoxTrack> find_moving(const KittiSequence& drive, std::span<const std::size_t> scans,
                                  const FindMovingOptions& options, const Executor& executor,
                                  ProgressSink& progress) {
  progress.begin_step("find moving objects", scans.size());
  Window window(drive, scans, options.seen);
  GroundHeights ground;
  std::vector<LoosePoints> loose(scans.size());
  for (std::size_t begin = 0; begin < scans.size(); begin += kAtOnce) {
    window.forget_before(begin - std::min(begin, kOffsets.back()));
    window.read_to(begin + kAtOnce - 1 + kOffsets.back(), ground, executor);
    const std::size_t count = std::min(kAtOnce, scans.size() - begin);
    executor.for_chunks(count, 1, [&](std::size_t n, std::size_t) {
      const std::size_t k = begin + n;
      loose[k] = loose_points(drive, scans[k], window.scan(k), window.others_of(k), options.loose,
                              executor);
    });
    progress.advance(begin + count);
  }
  const auto height_below = [&](Vec3d point) { return ground.at(point.x, point.y); };
  std::vector<BoxTrack> found = find_boxes(loose, height_below, options.boxes, executor);
  progress.end_step();
  return found;
}

}  // namespace adasplats
