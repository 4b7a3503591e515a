// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

/// The steps of the consistent method, once for all devices. `Backend` is a CpuBackend or
/// GpuBackend that also has what is of another shape on each device (Cells, Index, Rays, Cover and
/// the members that are called here); what one element does is in element_steps.h.
template <class Backend>
class ConsistentStepsOn final : public ConsistentSteps, public ShowsConsistentState {
 public:
  template <class Where>
  explicit ConsistentStepsOn(const Where& where) : place_(where) {}

  std::size_t load(PointCloud cloud, const ClassTables& tables,
                   const GlobalContext* whole) override {
    [[maybe_unused]] const auto entered = place_.enter();
    const std::vector<EmptyBeam> empty = std::exchange(cloud.empty_beams, {});
    const std::size_t beams = cloud.size() + (whole != nullptr ? whole->passing.size() : 0);
    beams_ = sample_beams(cloud, tables.removed, beams);
    if (whole != nullptr) append(beams_, sample_beams(whole->passing, {}, beams));
    if (whole != nullptr) {
      whole_ = {whole->typical, whole->rays, whole->response};
      empty_ = place_.load_as_it_is(whole->empty);
      passing_ = place_.load_as_it_is(whole->passing);
    } else if (!empty.empty()) {
      empty_ = place_.load_as_it_is(ends_of(empty, empty_reach_m(cloud)));
    }
    if (cloud.has_beams() && !cloud.intensities.empty())
      removed_ = place_.load_as_it_is(points_of_classes(cloud, tables.removed));
    box_ = whole != nullptr ? whole->box : place_.box_of(cloud);
    cloud_ = place_.load(cloud, box_, tables.removed);
    place_.wait("order the points");
    return cloud_.size();
  }

  void fuse(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    cells_ = place_.fuse(cloud_, options.cell_m, box_);
    place_.wait("fuse points");
  }

  std::vector<CellSpacing> spacings(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    const auto index = place_.index(cells_);
    const auto planes = place_.planes(cells_, index, options.planes_for_splitting());
    const auto with_beam = place_.on_host(spacing_units(true));
    const auto without = place_.on_host(spacing_units(false));
    const auto places = place_.on_host(cells_.positions);
    const auto found = place_.on_host(planes);
    std::vector<CellSpacing> spacings(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool beam = with_beam[i] > 0;
      const float unit_m = beam ? with_beam[i] : without[i];
      spacings[i] = {places[i], unit_m > 0 ? found[i].spacing_m / unit_m : 0, beam};
    }
    return spacings;
  }

  void fit_seeds(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    const TypicalSpacing typical = split_where_not_flat(options);
    index_.emplace(place_.index(cells_));
    planes_ = place_.planes(cells_, *index_, options.planes);
    seeds_ = place_.template array<Disk>(cells_.size());
    place_.for_each(
        cells_.size(), "make seeds",
        MakeSeed{points(), cells_.view(), typical, options, planes_.data(), seeds_.data()});
    place_.wait("fit planes");
  }

  std::vector<MovedEvidence> check_origins(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    const std::size_t every = cells_.size() / kCheckedSeeds + 1;
    auto seeds = place_.template array<Disk>(cells_.size() / every);
    place_.for_each(seeds.size(), "choose seeds", ThinSeeds{seeds_.data(), every, seeds.data()});
    auto cloud = place_.load_as_it_is(beams_);
    const auto& given = place_.copied(beams_.sensor_positions);
    const auto rays =
        place_.rays(cloud, points_of(cloud), options.min_range_m, RayEnds::at_surfaces);
    const float unit_m = origin_unit_m(beams_);
    std::vector<MovedEvidence> pieces(kOriginPieces);
    count_crossed(seeds, rays, [&](std::size_t k) -> CrossedSeeds& { return pieces[k].given; });
    for (std::size_t m = 0; m < kOriginMoves.size(); ++m) {
      // Rays read where they start from their cloud.
      place_.for_each(cloud.size(), "move beams",
                      MoveOrigin{cloud.positions.data(), given.data(), unit_m * kOriginMoves[m],
                                 options.min_range_m, cloud.sensor_positions.data()});
      count_crossed(seeds, rays,
                    [&](std::size_t k) -> CrossedSeeds& { return pieces[k].moved[m]; });
    }
    place_.wait("check where beams started");
    return pieces;
  }

  void order_rays(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    rays_.emplace(
        place_.rays(cloud_, points_of(cloud_), options.min_range_m, RayEnds::at_surfaces));
    if (options.empty_beams && empty_.size() > 0)
      empty_rays_.emplace(place_.rays(empty_, points_of(empty_), 0, RayEnds::nowhere));
    if (passing_.size() > 0)
      passing_rays_.emplace(
          place_.rays(passing_, points_of(passing_), options.min_range_m, RayEnds::at_surfaces));
  }

  /// What stands behind seeds that went is judged better in the next round.
  void balance_seeds(int round, const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    auto counts = count(seeds_, options.evidence_of_round(round, rays_of_all()));
    place_.for_each(seeds_.size(), "judge seeds",
                    JudgeSeed{seeds_.data(), counts.view(), options.judge});
    place_.wait("judge seeds");
  }

  void cover(bool checked, const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    // None where every point has its beam.
    const bool some_unchecked = checked && !cloud_.origin_kinds.empty();
    auto unchecked = place_.template array<std::uint8_t>(some_unchecked ? cells_.size() : 0);
    place_.for_each(unchecked.size(), "look at origins",
                    FlagWithoutBeam{points(), cells_.view(), unchecked.data()});
    cover_.emplace(place_.cover(seeds_, unchecked, *index_, options.cover_options(checked)));
    place_.wait("grow disks");
  }

  void limit_overhangs(int round, const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    chosen_ = place_.choose(*cover_);
    auto counts = count(chosen_, options.evidence_of_round(round, rays_of_all()));
    place_.for_each(
        chosen_.size(), "limit disks",
        LimitOverhang{cover_->limits(), chosen_.data(), counts.view(), options.max_contradicted});
    place_.wait("limit disks");
  }

  void limit_unchosen() override {
    [[maybe_unused]] const auto entered = place_.enter();
    place_.for_each(chosen_.size(), "limit disks", LimitUnchosen{cover_->limits(), chosen_.data()});
  }

  void choose() override {
    [[maybe_unused]] const auto entered = place_.enter();
    chosen_ = place_.choose(*cover_);
    place_.wait("choose disks");
  }

  void settle(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    const auto sums = place_.shifts(chosen_, *rays_, options.settle);
    place_.for_each(chosen_.size(), "settle disks",
                    SettleDisk{chosen_.data(), sums.data(), options.settle});
    place_.wait("settle disks");
  }

  void fill_gaps(const ConsistentOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    const auto missed =
        place_.missed(chosen_, *rays_, cloud_.size(), RayReach{options.missed_m, options.met_m});
    place_.for_each(chosen_.size(), "fill gaps",
                    PutBackSeed{chosen_.data(), seeds_.data(), cells_.view(), missed.data()});
    place_.wait("fill gaps");
  }

  ConsistentCounts counts() const override {
    [[maybe_unused]] const auto entered = place_.enter();
    return {cells_.size(), place_.count_present(seeds_), rays_ ? rays_->size() : 0,
            empty_rays_ ? empty_rays_->size() : 0, place_.count_present(chosen_)};
  }

  ConsistentSplats take_splats() override {
    [[maybe_unused]] const auto entered = place_.enter();
    ConsistentSplats splats = place_.splats(chosen_, cells_, cloud_);
    chosen_ = {};
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
    [[maybe_unused]] const auto entered = place_.enter();
    if (!rays_) order_rays(options);
    std::vector<RaysWithIntensities<Backend>> measured = {{&*rays_, &cloud_.intensities}};
    std::optional<typename Backend::Rays> others;
    if (removed_.size() > 0) {
      others.emplace(
          place_.rays(removed_, points_of(removed_), options.min_range_m, RayEnds::at_surfaces));
      measured.push_back({&*others, &removed_.intensities});
    }
    const IntensityResponse* response = whole_ && whole_->response ? &*whole_->response : nullptr;
    return ReflectancesOn<Backend>(place_, disks, fallback, response).run(measured);
  }

  ConsistentState state() const override {
    [[maybe_unused]] const auto entered = place_.enter();
    ConsistentState state;
    state.fused = place_.on_host(cells_);
    state.planes = place_.on_host(planes_);
    state.seeds = place_.on_host(seeds_);
    if (rays_) state.rays = place_.on_host(rays_->points());
    if (cover_) state.radii_m = place_.on_host(cover_->radii_m());
    state.chosen = place_.on_host(chosen_);
    return state;
  }

  RayEvidence evidence(const std::vector<Disk>& disks,
                       const EvidenceOptions& options) const override {
    [[maybe_unused]] const auto entered = place_.enter();
    return place_.on_host(count(place_.copied(disks), options));
  }

 private:
  template <class T>
  using Array = typename Backend::template Array<T>;

  static MeasuredPoints points_of(const typename Backend::Cloud& cloud) {
    return {cloud.positions.data(), data_or_null(cloud.sensor_positions),
            data_or_null(cloud.origin_kinds)};
  }
  MeasuredPoints points() const { return points_of(cloud_); }

  auto count(const Array<Disk>& disks, const EvidenceOptions& options) const {
    std::vector<const typename Backend::Rays*> rays = {&*rays_};
    if (empty_rays_) rays.push_back(&*empty_rays_);
    if (passing_rays_) rays.push_back(&*passing_rays_);
    return place_.evidence(disks, std::span<const typename Backend::Rays* const>(rays), options);
  }
  /// Counts seeds piece by piece, as they stand along the curve.
  template <class PieceOf>
  void count_crossed(const Array<Disk>& seeds, const typename Backend::Rays& rays,
                     const PieceOf& piece_of) const {
    const std::array all = {&rays};
    auto counts = place_.evidence(seeds, std::span<const typename Backend::Rays* const>(all),
                                  origin_evidence());
    for (std::size_t k = 0; k < kOriginPieces; ++k) {
      const std::size_t first = k * seeds.size() / kOriginPieces;
      const std::size_t end = (k + 1) * seeds.size() / kOriginPieces;
      piece_of(k) = place_.template sum<CrossedSeeds>(end - first, "count seeds",
                                                      CountCrossed{first, counts.view()});
    }
  }
  std::size_t rays_of_all() const { return whole_ ? whole_->rays : rays_->size(); }

  /// spacing_unit_m() of every cell.
  Array<float> spacing_units(bool with_beam) const {
    auto units_m = place_.template array<float>(cells_.size());
    place_.for_each(cells_.size(), "find the spacing of cells",
                    FindSpacingUnit{points(), cells_.view(), with_beam, units_m.data()});
    return units_m;
  }
  TypicalSpacing typical_spacing(const Array<LocalPlane>& planes) const {
    if (whole_) return whole_->typical;
    return {rounded_spacing(place_.median_spacing(planes, spacing_units(true))),
            rounded_spacing(place_.median_spacing(planes, spacing_units(false)))};
  }

  /// Splits cells where nothing is flat. Gives the median spacings of the cells before.
  TypicalSpacing split_where_not_flat(const ConsistentOptions& options) {
    const auto index = place_.index(cells_);
    const auto planes = place_.planes(cells_, index, options.planes_for_splitting());
    const TypicalSpacing spacing = typical_spacing(planes);
    if (options.small_cell_m == 0) return spacing;
    auto split = place_.template array<std::uint8_t>(cells_.size());
    place_.for_each(cells_.size(), "split cells",
                    FlagNotFlat{planes.data(), options.split_scale, split.data()});
    cells_ = place_.split(cloud_, cells_, split, options.small_cell_m, box_);
    return spacing;
  }

  /// What was said of the whole of which the cloud is a piece.
  struct Whole {
    TypicalSpacing typical;
    std::size_t rays = 0;
    std::optional<IntensityResponse> response;
  };

  // In the order in which they are made; memory goes back to the place before it ends.
  Backend place_;
  std::optional<Whole> whole_;
  CurveBox box_;
  PointCloud beams_;  ///< sample_beams()
  typename Backend::Cloud cloud_;
  typename Backend::Cloud empty_;    ///< ends_of() empty beams
  typename Backend::Cloud passing_;  ///< GlobalContext::passing
  typename Backend::Cloud removed_;  ///< points of removed classes, where intensities are measured
  typename Backend::Cells cells_;
  std::optional<typename Backend::Index> index_;  ///< of the cells
  Array<LocalPlane> planes_;
  Array<Disk> seeds_;
  std::optional<typename Backend::Rays> rays_, empty_rays_, passing_rays_;
  std::optional<typename Backend::Cover> cover_;
  Array<Disk> chosen_;
};

}  // namespace adasplats
