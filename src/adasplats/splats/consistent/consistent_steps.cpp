// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/consistent/consistent_steps.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "adasplats/neighbors/point_index.h"
#include "adasplats/splats/consistent/cell_attributes.h"
#include "adasplats/splats/consistent/consistent_state.h"
#include "adasplats/splats/consistent/seed_disk.h"
#include "adasplats/splats/consistent/surface_cover.h"
#include "adasplats/splats/model/canonical_order.h"
#include "adasplats/splats/rays/measured_rays.h"
#include "adasplats/splats/rays/present_disks.h"
#include "adasplats/splats/rays/ray_check.h"
#include "adasplats/surface/adaptive_planes.h"
#include "adasplats/surface/fused_points.h"

namespace adasplats {
namespace {

MeasuredPoints measured_points(const PointCloud& cloud) {
  return {cloud.positions.data(),
          cloud.sensor_positions.empty() ? nullptr : cloud.sensor_positions.data(),
          cloud.origin_kinds.empty() ? nullptr : cloud.origin_kinds.data()};
}

double median_spacing(const std::vector<LocalPlane>& planes, const std::vector<float>& units_m) {
  std::vector<float> spacings;
  spacings.reserve(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    if (units_m[i] > 0) spacings.push_back(planes[i].spacing_m / units_m[i]);
  }
  if (spacings.empty()) return 0;
  const auto middle = spacings.begin() + static_cast<std::ptrdiff_t>(spacings.size() / 2);
  std::nth_element(spacings.begin(), middle, spacings.end());
  return static_cast<double>(*middle);
}

/// The steps on the CPU's threads.
class CpuConsistentSteps final : public ConsistentSteps, public ShowsConsistentState {
 public:
  explicit CpuConsistentSteps(const Executor& executor) : executor_(executor) {}

  std::size_t load(PointCloud cloud, const ClassTables& tables) override;
  void fuse(const ConsistentOptions& options) override;
  void fit_seeds(const ConsistentOptions& options) override;
  void order_rays(const ConsistentOptions& options) override;
  void balance_seeds(int round, const ConsistentOptions& options) override;
  void cover(bool checked, const ConsistentOptions& options) override;
  void limit_overhangs(int round, const ConsistentOptions& options) override;
  void limit_unchosen() override;
  void choose() override;
  void settle(const ConsistentOptions& options) override;
  void fill_gaps(const ConsistentOptions& options) override;
  ConsistentCounts counts() const override;
  ConsistentSplats take_splats() override;

  ConsistentState state() const override;
  RayEvidence evidence(const std::vector<Disk>& disks,
                       const EvidenceOptions& options) const override {
    return collect_evidence(disks, *rays_, options, executor_);
  }

 private:
  TypicalSpacing split_where_not_flat(const ConsistentOptions& options);
  std::vector<float> spacing_units_m(bool with_beam) const;
  std::vector<std::uint8_t> cells_without_beam() const;
  void make_seeds(const TypicalSpacing& typical, const ConsistentOptions& options);

  const Executor& executor_;
  PointCloud cloud_;
  FusedPoints fused_;
  std::optional<PointIndex> index_;  // of the cells
  std::vector<LocalPlane> planes_;
  std::vector<Disk> seeds_;
  std::optional<MeasuredRays> rays_;
  std::optional<SurfaceCover> cover_;
  std::vector<Disk> chosen_;
};

std::size_t CpuConsistentSteps::load(PointCloud cloud, const ClassTables& tables) {
  std::vector<std::uint32_t> order = canonical_order(cloud, executor_);
  if (!tables.removed.empty() && !cloud.classes.empty()) {
    std::erase_if(order, [&](std::uint32_t i) { return tables.removed[cloud.classes[i]] != 0; });
  }
  cloud_ = gather(cloud, order);
  return cloud_.size();
}

void CpuConsistentSteps::fuse(const ConsistentOptions& options) {
  fused_ = fuse_points(cloud_.positions, options.cell_m, executor_);
}

std::vector<float> CpuConsistentSteps::spacing_units_m(bool with_beam) const {
  std::vector<float> units_m(fused_.size());
  executor_.for_chunks(fused_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      units_m[i] = spacing_unit_m(measured_points(cloud_), fused_.points_of(i), with_beam);
    }
  });
  return units_m;
}

/// One flag a cell; none where every point has its beam.
std::vector<std::uint8_t> CpuConsistentSteps::cells_without_beam() const {
  if (cloud_.origin_kinds.empty()) return {};
  std::vector<std::uint8_t> without(fused_.size());
  executor_.for_chunks(fused_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      without[i] = has_beam(measured_points(cloud_), fused_.points_of(i)) ? 0 : 1;
    }
  });
  return without;
}

/// Splits cells around which no plane is larger than the smallest scales: leaves, poles, wires are
/// smaller than a cell. Gives the median spacings of the cells before.
TypicalSpacing CpuConsistentSteps::split_where_not_flat(const ConsistentOptions& options) {
  const PointIndex index = PointIndex::from_sorted(fused_.positions, executor_);
  const auto planes = adaptive_planes(fused_, index, options.planes_for_splitting(), executor_);
  const TypicalSpacing spacing = {median_spacing(planes, spacing_units_m(true)),
                                  median_spacing(planes, spacing_units_m(false))};
  if (options.small_cell_m == 0) return spacing;
  std::vector<bool> split(planes.size());
  for (std::size_t i = 0; i < planes.size(); ++i) split[i] = planes[i].scale <= options.split_scale;
  fused_ = split_cells(cloud_.positions, fused_, split, options.small_cell_m, executor_);
  return spacing;
}

void CpuConsistentSteps::make_seeds(const TypicalSpacing& typical,
                                    const ConsistentOptions& options) {
  const MeasuredPoints points = measured_points(cloud_);
  seeds_.resize(planes_.size());
  executor_.for_chunks(planes_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      LocalPlane& plane = planes_[i];
      const auto members = fused_.points_of(i);
      plane.normal = seed_normal(plane.normal, points, members);
      const double largest_m = largest_seed_m(points, members, typical, options);
      const auto spacing_m = static_cast<double>(plane.spacing_m);
      seeds_[i] = {plane.center, seed_radius(spacing_m, largest_m, options), plane.normal};
    }
  });
}

void CpuConsistentSteps::fit_seeds(const ConsistentOptions& options) {
  const TypicalSpacing typical = split_where_not_flat(options);
  index_.emplace(PointIndex::from_sorted(fused_.positions, executor_));
  planes_ = adaptive_planes(fused_, *index_, options.planes, executor_);
  make_seeds(typical, options);
}

void CpuConsistentSteps::order_rays(const ConsistentOptions& options) {
  rays_.emplace(cloud_, options.least_range_m, executor_);
}

/// What stands behind seeds that went is judged better in the next round.
void CpuConsistentSteps::balance_seeds(int round, const ConsistentOptions& options) {
  const RayEvidence counts =
      collect_evidence(seeds_, *rays_, options.evidence_of_round(round, rays_->size()), executor_);
  executor_.for_chunks(seeds_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const DiskEvidence own = evidence_of(counts, i);
      if (seeds_[i].radius > 0 && own.seen()) {
        seeds_[i].radius = judged_radius(own, seeds_[i].radius, options.judge);
      }
    }
  });
}

void CpuConsistentSteps::cover(bool checked, const ConsistentOptions& options) {
  cover_.emplace(seeds_, *index_, options.cover_options(checked), executor_,
                 checked ? cells_without_beam() : std::vector<std::uint8_t>());
}

void CpuConsistentSteps::limit_overhangs(int round, const ConsistentOptions& options) {
  chosen_ = cover_->choose(executor_);
  const RayEvidence counts =
      collect_evidence(chosen_, *rays_, options.evidence_of_round(round, rays_->size()), executor_);
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    const DiskEvidence own = evidence_of(counts, i);
    if (!(chosen_[i].radius > 0) || !own.seen()) continue;
    cover_->limit(i, overhang_limit(own, chosen_[i].radius, cover_->seed_radius(i),
                                    options.most_contradicted));
  }
}

/// What is chosen next instead of limited disks was not checked in its large size.
void CpuConsistentSteps::limit_unchosen() {
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    if (!(chosen_[i].radius > 0)) cover_->limit(i, cover_->seed_radius(i));
  }
}

void CpuConsistentSteps::choose() { chosen_ = cover_->choose(executor_); }

void CpuConsistentSteps::settle(const ConsistentOptions& options) {
  settle_disks(chosen_, *rays_, options.settle, executor_);
}

/// Seeds come back at cells whose rays find nothing where they ended: chosen disks cover the
/// middles of all seeds, not all that is between them.
void CpuConsistentSteps::fill_gaps(const ConsistentOptions& options) {
  const PresentDisks present(chosen_, executor_);
  std::vector<std::uint8_t> missed(cloud_.size());
  RayCasting casting;
  casting.beyond_m = options.missed_m;
  present.cast(*rays_, casting, executor_,
               [&](std::size_t i, const Ray&, std::span<const Hit> hits) {
                 if (hits.empty()) missed[rays_->point(i)] = 1;
               });
  for (std::size_t cell = 0; cell < chosen_.size(); ++cell) {
    if (chosen_[cell].radius > 0) continue;
    for (const std::uint32_t i : fused_.points_of(cell)) {
      if (missed[i] != 0) chosen_[cell] = seeds_[cell];
    }
  }
}

ConsistentCounts CpuConsistentSteps::counts() const {
  const auto with_radius = [](const std::vector<Disk>& disks) {
    return static_cast<std::size_t>(
        std::count_if(disks.begin(), disks.end(), [](const Disk& d) { return d.radius > 0; }));
  };
  return {fused_.size(), with_radius(seeds_), rays_ ? rays_->size() : 0, with_radius(chosen_)};
}

ConsistentSplats CpuConsistentSteps::take_splats() {
  ConsistentSplats splats;
  std::vector<std::uint16_t> classes;  // of one cell
  for (std::size_t cell = 0; cell < chosen_.size(); ++cell) {
    if (!(chosen_[cell].radius > 0)) continue;
    splats.disks.push_back(chosen_[cell]);
    const auto points = fused_.points_of(cell);
    if (!cloud_.classes.empty()) {
      classes.clear();
      for (const std::uint32_t i : points) classes.push_back(cloud_.classes[i]);
      std::sort(classes.begin(), classes.end());
      splats.classes.push_back(majority_class(classes));
    }
    if (!cloud_.intensities.empty()) {
      splats.intensities.push_back(mean_intensity(cloud_.intensities.data(), points));
    }
  }
  return splats;
}

ConsistentState CpuConsistentSteps::state() const {
  ConsistentState state = {fused_, planes_, seeds_, {}, {}, chosen_};
  for (std::size_t i = 0; rays_ && i < rays_->size(); ++i) state.rays.push_back(rays_->point(i));
  for (std::size_t i = 0; cover_ && i < fused_.size(); ++i) {
    state.radii_m.push_back(cover_->radius_m(i));
  }
  return state;
}

}  // namespace

std::unique_ptr<ConsistentSteps> make_cpu_consistent_steps(const Executor& executor) {
  return std::make_unique<CpuConsistentSteps>(executor);
}

}  // namespace adasplats
