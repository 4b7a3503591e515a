// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/splats/consistent/consistent_state.h"
#include "adasplats/splats/consistent/consistent_steps.h"
#include "adasplats/splats/consistent/element_steps.h"
#include "adasplats/splats/consistent/global_context.h"
#include "adasplats/splats/consistent/origin_check.h"
#include "adasplats/splats/model/canonical_order.h"
#include "adasplats/splats/reflectance/reflectances_on.h"

namespace adasplats {

/// The steps of the consistent method for all devices. `Backend` is a CpuBackend or GpuBackend with
/// the types and functions that differ between devices (Cells, Index, Rays, Cover and the members
/// called here). element_steps.h has the work for one element.
template <class Backend>
class ConsistentStepsOn final : public ConsistentSteps, public ShowsConsistentState {
 public:
  template <class Where>
  explicit ConsistentStepsOn(const Where& where) : backend_(where) {}

  std::size_t load(PointCloud cloud, const ClassTables& tables,
                   const GlobalContext* whole) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    std::vector<EmptyBeam> empty = std::exchange(cloud.empty_beams, {});
    std::ranges::replace(cloud.intensities, kLostIntensity,
                         std::numeric_limits<float>::quiet_NaN());
    std::vector<EmptyBeam> lost;
    std::ranges::copy_if(empty, std::back_inserter(lost), &EmptyBeam::lost);
    std::erase_if(empty, [](const EmptyBeam& beam) { return beam.lost; });
    const std::size_t beams = cloud.size() + (whole != nullptr ? whole->passing.size() : 0);
    beams_ = sample_beams(cloud, tables.removed, beams);
    if (whole != nullptr) append(beams_, sample_beams(whole->passing, {}, beams));
    if (whole != nullptr) {
      whole_ = {whole->typical, whole->rays, whole->response};
      empty_ = backend_.load_in_given_order(whole->empty);
      passing_ = backend_.load_in_given_order(whole->passing);
    } else if (!empty.empty()) {
      empty_ = backend_.load_in_given_order(ends_of(empty, empty_reach_m(cloud)));
    }
    if (!lost.empty() && !cloud.intensities.empty()) {
      PointCloud ends = ends_of(lost, farthest_m(cloud));
      ends.intensities.assign(ends.size(), kLostIntensity);
      lost_ = backend_.load_in_given_order(std::move(ends));
    }
    if (cloud.has_beams() && !cloud.intensities.empty())
      removed_ = backend_.load_in_given_order(points_of_classes(cloud, tables.removed));
    box_ = whole != nullptr ? whole->box : backend_.box_of(cloud);
    cloud_ = backend_.load(cloud, box_, tables.removed);
    backend_.wait("order the points");
    return cloud_.size();
  }

  void fuse(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    cells_ = backend_.fuse(cloud_, options.cell_m, box_);
    backend_.wait("fuse points");
  }

  std::vector<CellSpacing> spacings(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    const auto index = backend_.index(cells_);
    const auto planes = backend_.planes(cells_, index, options.planes_for_splitting());
    const auto with_beam = backend_.on_host(spacing_units(true));
    const auto without = backend_.on_host(spacing_units(false));
    const auto positions = backend_.on_host(cells_.positions);
    const auto found = backend_.on_host(planes);
    std::vector<CellSpacing> spacings(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const bool beam = with_beam[i] > 0;
      const float unit_m = beam ? with_beam[i] : without[i];
      spacings[i] = {positions[i], unit_m > 0 ? found[i].spacing_m / unit_m : 0, beam,
                     found[i].scale > options.split_scale, found[i].limited};
    }
    return spacings;
  }

  void fit_seeds(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    const TypicalSpacing typical = split_where_not_flat(options);
    is_sparse_ = typical.is_sparse();
    index_.emplace(backend_.index(cells_));
    AdaptivePlaneOptions planes = options.planes;
    planes.strict_shift = planes.strict_shift || is_sparse_;
    planes_ = backend_.planes(cells_, *index_, planes);
    seeds_ = backend_.template array<Disk>(cells_.size());
    limited_ = backend_.template array<std::uint8_t>(cells_.size());
    backend_.for_each(cells_.size(), "make seeds",
                      MakeSeed{points(), cells_.view(), typical, options, planes_.data(),
                               seeds_.data(), limited_.data()});
    backend_.wait("fit planes");
  }

  std::vector<MovedEvidence> check_origins(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    const std::size_t every = cells_.size() / kCheckedSeeds + 1;
    auto seeds = backend_.template array<Disk>(cells_.size() / every);
    backend_.for_each(seeds.size(), "choose seeds", ThinSeeds{seeds_.data(), every, seeds.data()});
    auto cloud = backend_.load_in_given_order(beams_);
    const auto& given = backend_.copied(beams_.sensor_positions);
    const auto rays =
        backend_.rays(cloud, points_of(cloud), options.min_range_m, RayEnds::at_surfaces);
    const float unit_m = origin_unit_m(beams_);
    std::vector<MovedEvidence> pieces(kOriginPieces);
    count_crossed(seeds, rays, [&](std::size_t k) -> CrossedSeeds& { return pieces[k].given; });
    for (std::size_t m = 0; m < kOriginMoves.size(); ++m) {
      // The rays read their origins from the cloud.
      backend_.for_each(cloud.size(), "move beams",
                        MoveOrigin{cloud.positions.data(), given.data(), unit_m * kOriginMoves[m],
                                   options.min_range_m, cloud.sensor_positions.data()});
      count_crossed(seeds, rays,
                    [&](std::size_t k) -> CrossedSeeds& { return pieces[k].moved[m]; });
    }
    backend_.wait("check the sensor positions");
    return pieces;
  }

  void order_rays(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    rays_.emplace(
        backend_.rays(cloud_, points_of(cloud_), options.min_range_m, RayEnds::at_surfaces));
    if (options.empty_beams && empty_.size() > 0)
      empty_rays_.emplace(backend_.rays(empty_, points_of(empty_), 0, RayEnds::nowhere));
    if (passing_.size() > 0)
      passing_rays_.emplace(
          backend_.rays(passing_, points_of(passing_), options.min_range_m, RayEnds::at_surfaces));
  }

  /// A later round also checks the surfaces behind seeds that this round removes.
  void balance_seeds(int round, const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    auto counts = count(seeds_, options.evidence_of_round(round, rays_of_all()));
    backend_.for_each(seeds_.size(), "check seeds",
                      ShrinkSeed{seeds_.data(), counts.view(), options.judge});
    backend_.wait("check seeds");
  }

  void cover(bool checked, const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    // No kinds: every point has a beam.
    const bool some_unchecked = checked && !cloud_.origin_kinds.empty();
    auto unchecked = backend_.template array<std::uint8_t>(some_unchecked ? cells_.size() : 0);
    backend_.for_each(unchecked.size(), "look at origins",
                      FlagWithoutBeam{points(), cells_.view(), unchecked.data()});
    cover_.emplace(backend_.cover(seeds_, unchecked, *index_, options.cover_options(checked)));
    backend_.wait("grow disks");
  }

  void limit_overhangs(int round, const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    chosen_ = backend_.choose(*cover_);
    auto counts = count(chosen_, options.evidence_of_round(round, rays_of_all()));
    backend_.for_each(
        chosen_.size(), "limit disks",
        LimitOverhang{cover_->limits(), chosen_.data(), counts.view(), options.max_contradicted});
    backend_.wait("limit disks");
  }

  void limit_unchosen() override {
    [[maybe_unused]] const auto entered = backend_.enter();
    backend_.for_each(chosen_.size(), "limit disks",
                      LimitUnchosen{cover_->limits(), chosen_.data()});
  }

  void choose() override {
    [[maybe_unused]] const auto entered = backend_.enter();
    chosen_ = backend_.choose(*cover_);
    backend_.wait("choose disks");
  }

  void settle(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    SettleOptions how = options.settle;
    how.strict_shift = how.strict_shift || is_sparse_;
    const auto sums = backend_.shifts(chosen_, *rays_, how);
    backend_.for_each(chosen_.size(), "settle disks",
                      SettleDisk{chosen_.data(), sums.data(), how, limited_.data()});
    backend_.wait("settle disks");
  }

  void fill_gaps(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    const auto missed =
        backend_.missed(chosen_, *rays_, cloud_.size(), RayReach{options.missed_m, options.met_m});
    backend_.for_each(chosen_.size(), "fill gaps",
                      PutBackSeed{chosen_.data(), seeds_.data(), cells_.view(), missed.data()});
    backend_.wait("fill gaps");
  }

  void refine_extents(int round, const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    const ExtentOptions how = options.extent_of_round(round, rays_of_all());
    if (extents_.size() != chosen_.size()) {
      extents_ = backend_.template array<DiskExtent>(chosen_.size());
      backend_.for_each(chosen_.size(), "refine disks",
                        BeginExtent{extents_.data(), options.extent});
    }
    const auto sums = backend_.extents(softened(), extents_, all_rays(), how);
    backend_.for_each(chosen_.size(), "refine disks",
                      RefineExtent{extents_.data(), sums.data(), how});
    backend_.wait("refine disks");
  }

  void soften(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    chosen_ = softened();
    backend_.for_each(chosen_.size(), "remove faint disks",
                      RemoveFaint{chosen_.data(), extents_.data(), options.extent});
    backend_.wait("remove faint disks");
  }

  ConsistentCounts counts() const override {
    [[maybe_unused]] const auto entered = backend_.enter();
    return {cloud_.size(),
            cells_.size(),
            backend_.count_present(seeds_),
            rays_ ? rays_->size() : 0,
            empty_rays_ ? empty_rays_->size() : 0,
            backend_.count_present(chosen_)};
  }

  std::size_t count_limited() const override {
    [[maybe_unused]] const auto entered = backend_.enter();
    return backend_
        .template sum<FlagCount>(chosen_.size(), "count limited splats",
                                 CountLimitedSplats{chosen_.data(), limited_.data()})
        .flags;
  }
  bool is_sparse() const override { return is_sparse_; }

  ConsistentSplats take_splats() override {
    [[maybe_unused]] const auto entered = backend_.enter();
    ConsistentSplats splats = backend_.splats(chosen_, extents_, cells_, cloud_);
    chosen_ = {};
    extents_ = {};
    cover_.reset();
    seeds_ = {};
    planes_ = {};
    index_.reset();
    cells_ = {};
    return splats;
  }

  Reflectances measure_reflectances(const std::vector<Disk>& disks,
                                    const std::vector<float>& fallback,
                                    const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    if (!rays_) order_rays(options);
    std::vector<RaysWithIntensities<Backend>> measured = {{&*rays_, &cloud_.intensities}};
    std::array<std::optional<typename Backend::Rays>, 2> others;
    for (std::size_t k = 0; k < others.size(); ++k) {
      const typename Backend::Cloud& cloud = k == 0 ? removed_ : lost_;
      if (cloud.size() == 0) continue;
      others[k].emplace(
          backend_.rays(cloud, points_of(cloud), options.min_range_m, RayEnds::at_surfaces));
      measured.push_back({&*others[k], &cloud.intensities});
    }
    const IntensityResponse* response = whole_ && whole_->response ? &*whole_->response : nullptr;
    return ReflectancesOn<Backend>(backend_, disks, fallback, response).run(measured);
  }

  ConsistentState state() const override {
    [[maybe_unused]] const auto entered = backend_.enter();
    ConsistentState state;
    state.fused = backend_.on_host(cells_);
    state.planes = backend_.on_host(planes_);
    state.seeds = backend_.on_host(seeds_);
    if (rays_) state.rays = backend_.on_host(rays_->points());
    if (cover_) state.radii_m = backend_.on_host(cover_->radii_m());
    state.chosen = backend_.on_host(chosen_);
    return state;
  }

  RayEvidence evidence(const std::vector<Disk>& disks,
                       const EvidenceOptions& options) const override {
    [[maybe_unused]] const auto entered = backend_.enter();
    return backend_.on_host(count(backend_.copied(disks), options));
  }

 private:
  template <class T>
  using Array = typename Backend::template Array<T>;

  static MeasuredPoints points_of(const typename Backend::Cloud& cloud) {
    return {cloud.positions.data(), data_or_null(cloud.sensor_positions),
            data_or_null(cloud.origin_kinds)};
  }
  MeasuredPoints points() const { return points_of(cloud_); }

  std::vector<const typename Backend::Rays*> all_rays() const {
    std::vector<const typename Backend::Rays*> rays = {&*rays_};
    if (empty_rays_) rays.push_back(&*empty_rays_);
    if (passing_rays_) rays.push_back(&*passing_rays_);
    return rays;
  }
  Array<Disk> softened() const {
    auto soft = backend_.template array<Disk>(chosen_.size());
    backend_.for_each(chosen_.size(), "soften disks",
                      SoftenDisk{chosen_.data(), extents_.data(), soft.data()});
    return soft;
  }
  auto count(const Array<Disk>& disks, const EvidenceOptions& options) const {
    return backend_.evidence(disks, all_rays(), options);
  }
  /// Counts seeds part by part along the curve.
  template <class PieceOf>
  void count_crossed(const Array<Disk>& seeds, const typename Backend::Rays& rays,
                     const PieceOf& piece_of) const {
    const std::array all = {&rays};
    auto counts = backend_.evidence(seeds, std::span<const typename Backend::Rays* const>(all),
                                    origin_evidence());
    for (std::size_t k = 0; k < kOriginPieces; ++k) {
      const std::size_t first = k * seeds.size() / kOriginPieces;
      const std::size_t end = (k + 1) * seeds.size() / kOriginPieces;
      piece_of(k) = backend_.template sum<CrossedSeeds>(end - first, "count seeds",
                                                        CountCrossed{first, counts.view()});
    }
  }
  std::size_t rays_of_all() const { return whole_ ? whole_->rays : rays_->size(); }

  /// spacing_unit_m() of every cell.
  Array<float> spacing_units(bool with_beam) const {
    auto units_m = backend_.template array<float>(cells_.size());
    backend_.for_each(cells_.size(), "find the spacing of cells",
                      FindSpacingUnit{points(), cells_.view(), with_beam, units_m.data()});
    return units_m;
  }
  double share_limited(const Array<LocalPlane>& planes) const {
    const auto limited = backend_.template sum<FlagCount>(planes.size(), "count limited planes",
                                                          CountLimitedPlanes{planes.data()});
    return static_cast<double>(limited.flags) / static_cast<double>(planes.size());
  }
  TypicalSpacing typical_spacing(const Array<LocalPlane>& planes) const {
    if (whole_) return whole_->typical;
    return {rounded_spacing(backend_.median_spacing(planes, spacing_units(true))),
            rounded_spacing(backend_.median_spacing(planes, spacing_units(false))),
            share_limited(planes)};
  }

  /// Splits cells where the surface is not flat. Returns the median spacings before the split.
  TypicalSpacing split_where_not_flat(const ConsistentOptions& options) {
    const auto index = backend_.index(cells_);
    const auto planes = backend_.planes(cells_, index, options.planes_for_splitting());
    const TypicalSpacing spacing = typical_spacing(planes);
    if (options.small_cell_m == 0) return spacing;
    auto split = backend_.template array<std::uint8_t>(cells_.size());
    backend_.for_each(cells_.size(), "split cells",
                      FlagNotFlat{planes.data(), options.split_scale, split.data()});
    cells_ = backend_.split(cloud_, cells_, split, options.small_cell_m, box_);
    return spacing;
  }

  /// From the GlobalContext, if the cloud is a tile.
  struct Whole {
    TypicalSpacing typical;
    std::size_t rays = 0;
    std::optional<IntensityResponse> response;
  };

  // In the order of construction: arrays free their memory before the backend ends.
  Backend backend_;
  std::optional<Whole> whole_;
  CurveBox box_;
  PointCloud beams_;  ///< sample_beams()
  typename Backend::Cloud cloud_;
  typename Backend::Cloud empty_;    ///< ends_of() empty beams
  typename Backend::Cloud passing_;  ///< GlobalContext::passing
  typename Backend::Cloud removed_;  ///< points of removed classes, if intensities are measured
  typename Backend::Cloud lost_;     ///< ends_of() lost beams, likewise
  typename Backend::Cells cells_;
  std::optional<typename Backend::Index> index_;  ///< of the cells
  Array<LocalPlane> planes_;
  Array<Disk> seeds_;
  Array<std::uint8_t> limited_;  ///< one per cell: MakeSeed, SettleDisk
  bool is_sparse_ = false;       ///< TypicalSpacing
  std::optional<typename Backend::Rays> rays_, empty_rays_, passing_rays_;
  std::optional<typename Backend::Cover> cover_;
  Array<Disk> chosen_;
  Array<DiskExtent> extents_;  ///< of chosen disks, while they are refined
};

}  // namespace adasplats
