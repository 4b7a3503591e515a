// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/neighbors/cloud_on_device.h"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/gpu/paper/paper_cuda_steps.h"
#include "adasplats/gpu/paper/paper_generation.h"
#include "adasplats/gpu/paper/paper_resample.h"
#include "adasplats/gpu/paper/paper_shapes.h"

namespace adasplats::gpu {
namespace {

DeviceBuffer<SemanticGroup> groups_by_class(const DeviceCloud& cloud,
                                            const std::vector<SemanticGroup>& groups,
                                            cudaStream_t stream) {
  const DeviceBuffer<SemanticGroup> table(std::span<const SemanticGroup>(groups), stream);
  DeviceBuffer<SemanticGroup> result(cloud.size(), stream);
  for_each(cloud.size(), stream, "group points",
           [classes = cloud.classes.data(), table = table.data(),
            to = result.data()] __device__(std::uint64_t i) { to[i] = table[classes[i]]; });
  return result;
}

DeviceBuffer<std::uint32_t> without_noise(const DeviceBase& base, double removing_share,
                                          cudaStream_t stream) {
  DeviceBuffer<std::uint8_t> stays(base.votes.size(), stream);
  for_each(stays.size(), stream, "remove noise",
           [removing_share, votes = base.votes.data(), memberships = base.memberships.data(),
            to = stays.data()] __device__(std::uint64_t i) {
             to[i] = is_noise(votes[i], memberships[i], removing_share) ? 0 : 1;
           });
  return flagged(stays.data(), stays.size(), stream);
}

class CudaPaperSteps final : public PaperSteps {
 public:
  /// The device must be the current one.
  explicit CudaPaperSteps(int device) : device_(device), pool_(device) {}
  ~CudaPaperSteps() override {
    // The pool gives back what is free when the guard ends.
    cloud_ = {};
    groups_ = {};
    generation_ = {};
    static_cast<void>(cudaStreamSynchronize(stream_.get()));
  }
  CudaPaperSteps(const CudaPaperSteps&) = delete;
  CudaPaperSteps& operator=(const CudaPaperSteps&) = delete;

  std::size_t load(PointCloud cloud, const ClassTables& tables) override {
    const DeviceGuard guard(device_);
    cloud_ = load_in_order(cloud, tables.removed, stream_.get());
    groups_ = {};
    if (!tables.groups.empty()) groups_ = groups_by_class(cloud_, tables.groups, stream_.get());
    stream_.wait("load points");
    return cloud_.size();
  }

  std::size_t denoise(const PaperOptions& options) override {
    const DeviceGuard guard(device_);
    const DevicePointIndex index(cloud_.positions.data(), cloud_.size(), stream_.get());
    const DeviceBase base = base_neighborhoods(
        cloud_.positions.data(), index,
        {static_cast<std::uint32_t>(options.neighbors), options.radius_m, options.denoise_sigmas},
        stream_.get());
    const auto kept = without_noise(base, options.denoise_votes, stream_.get());
    if (kept.size() < cloud_.size()) {
      cloud_ = gather(cloud_, kept, stream_.get());
      groups_ = gather(groups_, kept, stream_.get());
    }
    stream_.wait("remove noise");
    return cloud_.size();
  }

  std::size_t generate(const PaperOptions& options, StepSink step) override {
    const DeviceGuard guard(device_);
    generation_ = generate_splats(cloud_, groups_, options, stream_.get(), step);
    return generation_.disks.size();
  }

  Resampled resample(const PaperOptions& options) override {
    const DeviceGuard guard(device_);
    DeviceResampled made = gpu::resample(cloud_, generation_, options, stream_.get());
    cloud_ = std::move(made.cloud);
    groups_ = std::move(made.groups);
    stream_.wait("resample splats");
    return {cloud_.size(), made.new_points};
  }

  PaperSplats take_splats() override {
    const DeviceGuard guard(device_);
    const auto of_seeds = [&](const auto& values) {
      return gather(values, generation_.seeds, stream_.get()).download();
    };
    PaperSplats splats;
    splats.disks = generation_.disks.download();
    splats.classes = of_seeds(cloud_.classes);
    splats.groups = of_seeds(generation_.groups);
    splats.intensities = of_seeds(cloud_.intensities);
    splats.radius_m = generation_.radius_m;
    splats.error_m = generation_.error_m;
    return splats;
  }

 private:
  int device_;
  MemoryPoolGuard pool_;
  Stream stream_;  // before all buffers, which end before it
  DeviceCloud cloud_;
  DeviceBuffer<SemanticGroup> groups_;  ///< one a point, where known before a generation
  DeviceGeneration generation_;
};

}  // namespace

std::unique_ptr<PaperSteps> make_cuda_paper_steps(int device) {
  const DeviceGuard guard(device);
  return std::make_unique<CudaPaperSteps>(device);
}

}  // namespace adasplats::gpu
