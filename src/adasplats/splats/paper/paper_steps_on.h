// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "adasplats/splats/paper/element_steps.h"
#include "adasplats/splats/paper/paper_steps.h"

namespace adasplats {

/// The steps of the paper's methods for all devices. `Backend` is a CpuBackend or GpuBackend with
/// the types and functions that differ between devices (Generation and the members called here).
/// element_steps.h has the work for one element.
template <class Backend>
class PaperStepsOn final : public PaperSteps {
 public:
  template <class Where>
  explicit PaperStepsOn(const Where& where) : backend_(where) {}

  std::size_t load(const PointCloud& cloud, const ClassTables& tables) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    cloud_ = backend_.load(cloud, tables.removed);
    groups_ = {};
    if (!tables.groups.empty()) {
      const auto& table = backend_.copied(tables.groups);
      groups_ = backend_.template array<SemanticGroup>(cloud_.size());
      backend_.for_each(cloud_.size(), "group points",
                        FindGroup{cloud_.classes.data(), table.data(), groups_.data()});
    }
    backend_.wait("load points");
    return cloud_.size();
  }

  std::size_t denoise(const PaperOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    const auto base = backend_.base(cloud_, {static_cast<std::uint32_t>(options.neighbors),
                                             options.radius_m, options.denoise_sigmas});
    auto flags = backend_.template array<std::uint8_t>(cloud_.size());
    backend_.for_each(
        flags.size(), "remove noise",
        FlagKept{base.votes.data(), base.memberships.data(), options.denoise_votes, flags.data()});
    const auto kept = backend_.flagged(flags);
    if (kept.size() < cloud_.size()) {
      cloud_ = backend_.gather(cloud_, kept);
      groups_ = backend_.gather(groups_, kept);
    }
    backend_.wait("remove noise");
    return cloud_.size();
  }

  std::size_t generate(const PaperOptions& options, StepSink step) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    generation_ = backend_.generate(cloud_, groups_, options, step);
    return generation_.disks.size();
  }

  Resampled resample(const PaperOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    auto made = backend_.resample(cloud_, generation_, options);
    cloud_ = std::move(made.cloud);
    groups_ = std::move(made.groups);
    backend_.wait("resample splats");
    return {cloud_.size(), made.new_points};
  }

  PaperSplats take_splats() override {
    [[maybe_unused]] const auto entered = backend_.enter();
    const auto of_seeds = [&](const auto& values) {
      return backend_.on_host(backend_.gather(values, generation_.seeds));
    };
    return {backend_.on_host(std::move(generation_.disks)),
            of_seeds(cloud_.classes),
            of_seeds(generation_.groups),
            of_seeds(cloud_.intensities),
            generation_.radius_m,
            generation_.error_m};
  }

 private:
  Backend backend_;  // first, so that it outlives the arrays
  typename Backend::Cloud cloud_;
  typename Backend::template Array<SemanticGroup> groups_;  ///< if known before a generation
  typename Backend::Generation generation_;
};

}  // namespace adasplats
