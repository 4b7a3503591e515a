// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "adasplats/calibrate/calibration_steps.h"
#include "adasplats/calibrate/plane_search_on.h"
#include "adasplats/calibrate/plane_sums_on.h"
#include "adasplats/calibrate/row_steps.h"

namespace adasplats {

/// The steps of calibrate(), once for all devices. `Backend` is CpuArrays or gpu::GpuBackend; what
/// one element does is in cell_steps.h, row_steps.h and sum_steps.h.
template <class Backend>
class CalibrationStepsOn final : public CalibrationSteps {
 public:
  template <class Where>
  explicit CalibrationStepsOn(const Where& where) : place_(where), search_(place_), sums_(place_) {}

  void load(const PointCloud& cloud, const ChosenPoints& few, const ChosenPoints& all,
            const std::vector<Vec3d>& axes, std::size_t lasers) override {
    [[maybe_unused]] const auto entered = place_.enter();
    positions_ = place_.lent(cloud.positions);
    sensors_ = place_.lent(cloud.sensor_positions);
    scan_indices_ = place_.lent(cloud.scan_indices);
    lasers_ = place_.lent(cloud.lasers);
    axes_ = place_.lent(axes);
    laser_count_ = lasers;
    scan_count_ = axes.size();
    load(few, set_of(PointSet::few));
    load(all, set_of(PointSet::all));
    place_.wait("load the points");
  }

  void correct(PointSet which, const ScanCorrections& corrections) override {
    [[maybe_unused]] const auto entered = place_.enter();
    take(corrections);
    Set& set = set_of(which);
    place_.resize(set.corrected, set.indices.size());
    place_.for_each(set.indices.size(), "correct points",
                    CorrectPoint{rays(), set.indices.data(), set.corrected.data()});
    place_.wait("correct points");
  }

  std::vector<ScanPlane> find_planes(PointSet which, const ScanPlaneOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    searched_ = which;
    const Set& set = set_of(which);
    search_.run(set.corrected.data(), set.scans.data(), set.indices.size(), options);
    return place_.on_host(search_.planes());
  }

  std::vector<double> left_out_residuals() override {
    [[maybe_unused]] const auto entered = place_.enter();
    const std::size_t planes = search_.planes().size();
    Array<std::uint32_t> counts = place_.template array<std::uint32_t>(planes);
    place_.for_each(planes, "judge planes", CountLeftOut{members(), counts.data()});
    const auto begins = place_.running_sums(counts);
    const std::vector<std::uint64_t>& begins_here = place_.on_host(begins);
    Array<double> residuals_m = place_.template array<double>(begins_here.back());
    place_.for_each(planes, "judge planes",
                    MeasureLeftOut{members(), set_of(searched_).corrected.data(), begins.data(),
                                   residuals_m.data()});
    return place_.on_host(std::move(residuals_m));
  }

  std::vector<DistanceSum> left_out_distances(double max_m, double max_weight) override {
    [[maybe_unused]] const auto entered = place_.enter();
    Array<DistanceSum> sums = place_.template array<DistanceSum>(search_.planes().size());
    place_.for_each(
        sums.size(), "judge planes",
        SumLeftOut{members(), set_of(searched_).corrected.data(), max_m, max_weight, sums.data()});
    return place_.on_host(std::move(sums));
  }

  void choose_rows(const RowOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    const Set& set = set_of(searched_);
    const bool has_lasers = options.ranges || options.elevations;
    sums_.choose(members(), search_.planes().size(), options, set.scans.data(), set.indices.data(),
                 lasers_.data(), scan_count_, has_lasers ? laser_count_ : 0);
    place_.wait("order points on planes");
  }

  PlaneBlocks sum_rows(const ScanCorrections& corrections, const RowOptions& options) override {
    [[maybe_unused]] const auto entered = place_.enter();
    take(corrections);
    return sums_.sum(rays(), pivots_.data(), options);
  }

  PlaneStep coupled(const PlaneStep& x) override {
    [[maybe_unused]] const auto entered = place_.enter();
    return sums_.coupled(x);
  }

 private:
  template <class T>
  using Array = typename Backend::template Array<T>;
  template <class T>
  using Lent = typename Backend::template Lent<T>;

  struct Set {
    Lent<std::uint32_t> indices, scans;
    std::uint32_t left_out_every = 0;
    Array<Vec3d> corrected;
  };

  Set& set_of(PointSet which) { return sets_[static_cast<std::size_t>(which)]; }

  void load(const ChosenPoints& points, Set& set) const {
    set.indices = place_.lent(points.indices);
    set.scans = place_.lent(points.scans);
    set.left_out_every = points.left_out_every;
  }

  void take(const ScanCorrections& corrections) {
    corrected_from_given_ = place_.copied(corrections.corrected_from_given);
    pivots_ = place_.copied(corrections.pivots);
    range_m_ = place_.copied(corrections.offsets.range_m);
    elevation_rad_ = place_.copied(corrections.offsets.elevation_rad);
  }

  RaysView rays() const {
    return {positions_.data(),     sensors_.data(),       scan_indices_.data(),
            data_or_null(lasers_), axes_.data(),          corrected_from_given_.data(),
            range_m_.data(),       elevation_rad_.data(), laser_count_};
  }

  PlaneMembers members() {
    return {search_.planes().data(), search_.order().data(), set_of(searched_).left_out_every};
  }

  Backend place_;
  PlaneSearchOn<Backend> search_;
  PlaneSumsOn<Backend> sums_;
  Lent<Vec3f> positions_, sensors_;
  Lent<std::uint32_t> scan_indices_;
  Lent<std::uint16_t> lasers_;
  Lent<Vec3d> axes_;
  std::size_t scan_count_ = 0, laser_count_ = 0;
  std::array<Set, 2> sets_;
  PointSet searched_ = PointSet::few;
  Array<RigidTransform> corrected_from_given_;
  Array<Vec3d> pivots_;
  Array<double> range_m_, elevation_rad_;
};

}  // namespace adasplats
