// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <optional>
#include <utility>

#include "adasplats/gpu/base/launch.cuh"
#include "adasplats/gpu/consistent/consistent_cells.h"
#include "adasplats/gpu/consistent/consistent_cover.cuh"
#include "adasplats/gpu/consistent/consistent_cuda.h"
#include "adasplats/gpu/consistent/consistent_planes.h"
#include "adasplats/gpu/consistent/consistent_rays.h"
#include "adasplats/gpu/consistent/consistent_seeds.h"
#include "adasplats/gpu/neighbors/cloud_on_device.h"
#include "adasplats/gpu/neighbors/neighborhoods.h"
#include "adasplats/splats/consistent/consistent_state.h"

namespace adasplats::gpu {
namespace {

void judge(DeviceBuffer<Disk>& seeds, const DeviceEvidence& evidence, const JudgeOptions& options,
           cudaStream_t stream) {
  for_each(seeds.size(), stream, "judge seeds",
           [disks = seeds.data(), counts = evidence.view(), options] __device__(std::uint64_t i) {
             const DiskEvidence own = counts.of(i);
             if (disks[i].radius > 0 && own.seen()) {
               disks[i].radius = judged_radius(own, disks[i].radius, options);
             }
           });
}

void limit_chosen(const CoverView& cover, const DeviceBuffer<Disk>& chosen,
                  const DeviceEvidence& evidence, double most_contradicted, cudaStream_t stream) {
  for_each(chosen.size(), stream, "limit disks",
           [cover, disks = chosen.data(), counts = evidence.view(),
            most_contradicted] __device__(std::uint64_t i) {
             const DiskEvidence own = counts.of(i);
             const float radius_m = disks[i].radius;
             if (!(radius_m > 0) || !own.seen()) return;
             cover.limit(i,
                         overhang_limit(own, radius_m, cover.seeds[i].radius, most_contradicted));
           });
}

void limit_others(const CoverView& cover, const DeviceBuffer<Disk>& chosen, cudaStream_t stream) {
  for_each(chosen.size(), stream, "limit disks",
           [cover, disks = chosen.data()] __device__(std::uint64_t i) {
             if (!(disks[i].radius > 0)) cover.limit(i, cover.seeds[i].radius);
           });
}

void settle_all(DeviceBuffer<Disk>& disks, const DeviceBuffer<ShiftSums>& sums,
                const SettleOptions& options, cudaStream_t stream) {
  for_each(disks.size(), stream, "settle disks",
           [all = disks.data(), from = sums.data(), options] __device__(std::uint64_t i) {
             all[i] = settled(all[i], from[i], options);
           });
}

void put_back(DeviceBuffer<Disk>& chosen, const DeviceBuffer<Disk>& seeds, const CellsView& cells,
              const DeviceBuffer<std::uint8_t>& missed, cudaStream_t stream) {
  for_each(chosen.size(), stream, "fill gaps",
           [disks = chosen.data(), from = seeds.data(), cells,
            is_missed = missed.data()] __device__(std::uint64_t cell) {
             if (disks[cell].radius > 0) return;
             for (const std::uint32_t i : cells.points_of(cell)) {
               if (is_missed[i] != 0) {
                 disks[cell] = from[cell];
                 return;
               }
             }
           });
}

DeviceBuffer<std::uint8_t> cells_to_split(const DeviceBuffer<LocalPlane>& planes,
                                          std::uint8_t split_scale, cudaStream_t stream) {
  DeviceBuffer<std::uint8_t> split(planes.size(), stream);
  for_each(planes.size(), stream, "split cells",
           [from = planes.data(), split_scale, to = split.data()] __device__(std::uint64_t i) {
             to[i] = from[i].scale <= split_scale;
           });
  return split;
}

std::size_t count_disks(const DeviceBuffer<Disk>& disks, cudaStream_t stream) {
  DeviceBuffer<std::uint32_t> count(1, stream);
  count.fill_bytes(0);
  for_each(disks.size(), stream, "count disks",
           [from = disks.data(), to = count.data()] __device__(std::uint64_t i) {
             if (from[i].radius > 0) atomicAdd(to, 1U);
           });
  return count.download().front();
}

class CudaConsistentSteps final : public ConsistentSteps, public ShowsConsistentState {
 public:
  /// The device must be the current one.
  explicit CudaConsistentSteps(int device) : device_(device), pool_(device) {}

  std::size_t load(PointCloud cloud, const ClassTables& tables) override {
    const DeviceGuard guard(device_);
    cloud_ = load_in_order(cloud, tables.removed, stream());
    stream_.wait("order the points");
    return cloud_.size();
  }

  void fuse(const ConsistentOptions& options) override {
    const DeviceGuard guard(device_);
    cells_ = fuse_on_device(cloud_.positions.data(), cloud_.size(), options.cell_m, stream());
    stream_.wait("fuse points");
  }

  void fit_seeds(const ConsistentOptions& options) override {
    const DeviceGuard guard(device_);
    const TypicalSpacing typical = split_where_not_flat(options);
    index_.emplace(cells_.positions.data(), cells_.size(), stream());
    planes_ = planes_on_device(cells_.view(), *index_, options.planes, stream());
    seeds_ = seeds_of_planes(points(), cells_.view(), typical, options, planes_, stream());
    stream_.wait("fit planes");
  }

  void order_rays(const ConsistentOptions& options) override {
    const DeviceGuard guard(device_);
    rays_.emplace(points(), cloud_.size(), options.least_range_m, stream());
  }

  void balance_seeds(int round, const ConsistentOptions& options) override {
    const DeviceGuard guard(device_);
    judge(seeds_, count(seeds_, options.evidence_of_round(round, rays_->size())), options.judge,
          stream());
    stream_.wait("judge seeds");
  }

  void cover(bool checked, const ConsistentOptions& options) override {
    const DeviceGuard guard(device_);
    const DeviceBuffer<std::uint8_t> unchecked =
        checked && !cloud_.origin_kinds.empty()
            ? cells_without_beam(points(), cells_.view(), stream())
            : DeviceBuffer<std::uint8_t>();
    cover_.emplace(seeds_.data(), unchecked.data(), *index_, options.cover_options(checked),
                   stream());
    stream_.wait("grow disks");
  }

  void limit_overhangs(int round, const ConsistentOptions& options) override {
    const DeviceGuard guard(device_);
    chosen_ = cover_->choose();
    limit_chosen(cover_->view(), chosen_,
                 count(chosen_, options.evidence_of_round(round, rays_->size())),
                 options.most_contradicted, stream());
    stream_.wait("limit disks");
  }

  void limit_unchosen() override {
    const DeviceGuard guard(device_);
    limit_others(cover_->view(), chosen_, stream());
  }

  void choose() override {
    const DeviceGuard guard(device_);
    chosen_ = cover_->choose();
    stream_.wait("choose disks");
  }

  void settle(const ConsistentOptions& options) override {
    const DeviceGuard guard(device_);
    settle_all(chosen_, rays_->shifts(chosen_.data(), chosen_.size(), options.settle),
               options.settle, stream());
    stream_.wait("settle disks");
  }

  void fill_gaps(const ConsistentOptions& options) override {
    const DeviceGuard guard(device_);
    put_back(chosen_, seeds_, cells_.view(),
             rays_->missed(chosen_.data(), chosen_.size(), options.missed_m), stream());
    stream_.wait("fill gaps");
  }

  ConsistentCounts counts() const override {
    const DeviceGuard guard(device_);
    return {cells_.size(), count_disks(seeds_, stream()), rays_ ? rays_->size() : 0,
            count_disks(chosen_, stream())};
  }

  ConsistentSplats take_splats() override {
    const DeviceGuard guard(device_);
    return splats_of(chosen_, cells_, cloud_, stream());
  }

  ConsistentState state() const override {
    const DeviceGuard guard(device_);
    ConsistentState state;
    state.fused = cells_.download();
    state.planes = planes_.download();
    state.seeds = seeds_.download();
    if (rays_) state.rays = rays_->numbers().download();
    if (cover_) state.radii_m = cover_->radii_m().download();
    state.chosen = chosen_.download();
    return state;
  }

  RayEvidence evidence(const std::vector<Disk>& disks,
                       const EvidenceOptions& options) const override {
    const DeviceGuard guard(device_);
    return count(DeviceBuffer<Disk>(std::span(disks), stream()), options).download();
  }

 private:
  cudaStream_t stream() const { return stream_.get(); }

  MeasuredPoints points() const {
    return {cloud_.positions.data(), cloud_.sensor_positions.data(), cloud_.origin_kinds.data()};
  }

  DeviceEvidence count(const DeviceBuffer<Disk>& disks, const EvidenceOptions& options) const {
    return rays_->evidence(disks.data(), disks.size(), options);
  }

  /// Gives the median spacings of the cells before.
  TypicalSpacing split_where_not_flat(const ConsistentOptions& options) {
    const DevicePointIndex index(cells_.positions.data(), cells_.size(), stream());
    const auto planes =
        planes_on_device(cells_.view(), index, options.planes_for_splitting(), stream());
    const auto spacing_of = [&](bool with_beam) {
      return median_spacing(planes, spacing_units(points(), cells_.view(), with_beam, stream()),
                            stream());
    };
    const TypicalSpacing spacing = {spacing_of(true), spacing_of(false)};
    if (options.small_cell_m == 0) return spacing;
    const auto split = cells_to_split(planes, options.split_scale, stream());
    cells_ = split_on_device(cloud_.positions.data(), cells_, split.data(), options.small_cell_m,
                             stream());
    return spacing;
  }

  // In the order in which they are made; memory goes back to the stream before it ends.
  int device_;
  MemoryPoolGuard pool_;
  Stream stream_;
  DeviceCloud cloud_;
  DeviceCells cells_;
  std::optional<DevicePointIndex> index_;  ///< of the cells
  DeviceBuffer<LocalPlane> planes_;
  DeviceBuffer<Disk> seeds_;
  std::optional<DeviceRays> rays_;
  std::optional<DeviceCover> cover_;
  DeviceBuffer<Disk> chosen_;
};

}  // namespace

std::unique_ptr<ConsistentSteps> make_cuda_consistent_steps(int device, const Executor&) {
  const DeviceGuard guard(device);
  return std::make_unique<CudaConsistentSteps>(device);
}

}  // namespace adasplats::gpu
