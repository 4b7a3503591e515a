// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "adasplats/splats/paper/element_steps.h"
#include "adasplats/splats/paper/paper_steps.h"

namespace adasplats {

/// The steps of the paper's methods, once for all devices. `Backend` is a CpuBackend or GpuBackend
/// that also has what is of another shape on each device (Generation and the members that are
/// called here); what one element does is in element_steps.h.
template <class Backend>
class PaperStepsOn final : public PaperSteps {
 public:
  template <class Where>
  explicit PaperStepsOn(const Where& where) : place_(where) {}

  std::size_t load(PointCloud cloud, const ClassTables& tables) override {
    [[maybe_unused]] const auto entered = place_.enter();
    cloud_ = place_.load(cloud, tables.removed);
    groups_ = {};
    if (!tables.groups.empty()) {
      const auto& table = place_.copied(tables.groups);
      groups_ = place_.template array<SemanticGroup>(cloud_.size());
      place_.for_each(cloud_.size(), "group points",
                      FindGroup{cloud_.classes.data(), table.data(), groups_.data()});
    }
    place_.wait("load points");
    return cloud_.size();
  }

  std::size_t denoise(const PaperOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    const auto base = place_.base(cloud_, {static_cast<std::uint32_t>(options.neighbors),
                                           options.radius_m, options.denoise_sigmas});
    auto flags = place_.template array<std::uint8_t>(cloud_.size());
    place_.for_each(
        flags.size(), "remove noise",
        FlagKept{base.votes.data(), base.memberships.data(), options.denoise_votes, flags.data()});
    const auto kept = place_.flagged(flags);
    if (kept.size() < cloud_.size()) {
      cloud_ = place_.gather(cloud_, kept);
      groups_ = place_.gather(groups_, kept);
    }
    place_.wait("remove noise");
    return cloud_.size();
  }

  std::size_t generate(const PaperOptions& options, StepSink step) override {
    [[maybe_unused]] const auto entered = place_.enter();
    generation_ = place_.generate(cloud_, groups_, options, step);
    return generation_.disks.size();
  }

  Resampled resample(const PaperOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    auto made = place_.resample(cloud_, generation_, options);
    cloud_ = std::move(made.cloud);
    groups_ = std::move(made.groups);
    place_.wait("resample splats");
    return {cloud_.size(), made.new_points};
  }

  PaperSplats take_splats() override {
    [[maybe_unused]] const auto entered = place_.enter();
    const auto of_seeds = [&](const auto& values) {
      return place_.on_host(place_.gather(values, generation_.seeds));
    };
    return {place_.on_host(std::move(generation_.disks)),
            of_seeds(cloud_.classes),
            of_seeds(generation_.groups),
            of_seeds(cloud_.intensities),
            generation_.radius_m,
            generation_.error_m};
  }

 private:
  Backend place_;  // before what is there, which ends before it
  typename Backend::Cloud cloud_;
  typename Backend::template Array<SemanticGroup> groups_;  ///< where known before a generation
  typename Backend::Generation generation_;
};

}  // namespace adasplats
