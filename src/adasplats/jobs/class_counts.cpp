// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/class_counts.h"

#include <vector>

#include "adasplats/cloud/sequence/kitti_sequence.h"
#include "adasplats/core/progress_meter.h"

namespace adasplats {
namespace {

constexpr std::size_t kClasses = 1 << 16;

struct Counts {
  std::map<std::uint16_t, ClassCount> by_class;

  void operator+=(const Counts& other) {
    for (const auto& [id, count] : other.by_class) {
      by_class[id].original += count.original;
      by_class[id].simulated += count.simulated;
    }
  }
};

std::vector<std::size_t> labels_in(std::span<const std::filesystem::path> files) {
  std::vector<std::size_t> of_class(kClasses);
  for (const std::filesystem::path& file : files)
    for (const std::uint32_t label : read_kitti_labels(file)) ++of_class[label & 0xffff];
  return of_class;
}

}  // namespace

std::map<std::uint16_t, ClassCount> count_classes(std::span<const std::filesystem::path> originals,
                                                  std::span<const std::filesystem::path> simulated,
                                                  const Executor& executor) {
  constexpr std::size_t kScansAtOnce = 8;
  const ProgressPass pass(executor, originals.size());
  const auto of_scans = [&](std::size_t begin, std::size_t end) {
    const std::vector<std::size_t> in_originals = labels_in(originals.subspan(begin, end - begin));
    const std::vector<std::size_t> in_simulated = labels_in(simulated.subspan(begin, end - begin));
    Counts counts;
    for (std::size_t id = 0; id < kClasses; ++id) {
      if (in_originals[id] == 0 && in_simulated[id] == 0) continue;
      counts.by_class[static_cast<std::uint16_t>(id)] = {in_originals[id], in_simulated[id]};
    }
    return counts;
  };
  return executor.sum_chunks(originals.size(), kScansAtOnce, Counts{}, of_scans).by_class;
}

}  // namespace adasplats
