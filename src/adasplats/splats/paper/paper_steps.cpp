// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/paper/paper_steps.h"

#include <utility>

#include "adasplats/splats/model/canonical_order.h"
#include "adasplats/splats/paper/resample.h"

namespace adasplats {
namespace {

class CpuPaperSteps final : public PaperSteps {
 public:
  explicit CpuPaperSteps(const Executor& executor) : executor_(executor) {}

  std::size_t load(PointCloud cloud, const ClassTables& tables) override {
    std::vector<std::uint32_t> order = canonical_order(cloud, executor_);
    if (!tables.removed.empty())
      std::erase_if(order, [&](std::uint32_t i) { return tables.removed[cloud.classes[i]] != 0; });
    cloud_ = gather(cloud, order);
    if (!tables.groups.empty())
      for (const std::uint16_t id : cloud_.classes) groups_.push_back(tables.groups[id]);
    return cloud_.size();
  }

  std::size_t denoise(const PaperOptions& options) override {
    const std::vector<std::uint32_t> kept = ranks_without_noise(options);
    if (kept.size() < cloud_.size()) keep(kept);
    return cloud_.size();
  }

  std::size_t generate(const PaperOptions& options, StepSink step) override {
    generation_ = generate_splats(cloud_, groups_, options, executor_, step);
    return generation_.disks.size();
  }

  Resampled resample(const PaperOptions& options) override {
    ResampledCloud made = adasplats::resample(cloud_, generation_, options, executor_);
    cloud_ = std::move(made.cloud);
    groups_ = std::move(made.groups);
    keep(canonical_order(cloud_, executor_));
    return {cloud_.size(), made.new_points};
  }

  PaperSplats take_splats() override {
    PaperSplats splats;
    splats.disks = std::move(generation_.disks);
    splats.radius_m = generation_.radius_m;
    splats.error_m = generation_.error_m;
    for (const std::uint32_t seed : generation_.seeds) {
      if (!cloud_.classes.empty()) splats.classes.push_back(cloud_.classes[seed]);
      if (!generation_.groups.empty()) splats.groups.push_back(generation_.groups[seed]);
      if (!cloud_.intensities.empty()) splats.intensities.push_back(cloud_.intensities[seed]);
    }
    return splats;
  }

 private:
  std::vector<std::uint32_t> ranks_without_noise(const PaperOptions& options) const {
    const PointIndex index = PointIndex::from_sorted(cloud_.positions, executor_);
    const BaseNeighborhoods base = base_neighborhoods(
        cloud_.positions, index,
        {static_cast<std::uint32_t>(options.neighbors), options.radius_m, options.denoise_sigmas},
        executor_);
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < cloud_.size(); ++i)
      if (!is_noise(base.votes[i], base.memberships[i], options.denoise_votes)) kept.push_back(i);
    return kept;
  }

  /// Keeps these points, in this order.
  void keep(std::span<const std::uint32_t> points) {
    cloud_ = gather(cloud_, points);
    if (groups_.empty()) return;
    std::vector<SemanticGroup> groups;
    groups.reserve(points.size());
    for (const std::uint32_t i : points) groups.push_back(groups_[i]);
    groups_ = std::move(groups);
  }

  const Executor& executor_;
  PointCloud cloud_;
  std::vector<SemanticGroup> groups_;  ///< one a point, where they are known before a generation
  Generation generation_;
};

}  // namespace

std::unique_ptr<PaperSteps> make_cpu_paper_steps(const Executor& executor) {
  return std::make_unique<CpuPaperSteps>(executor);
}

}  // namespace adasplats
