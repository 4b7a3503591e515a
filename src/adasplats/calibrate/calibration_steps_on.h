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

/// The steps of calibrate() for all devices. `Backend` is CpuArrays or gpu::GpuBackend; the code
/// for one element is in cell_steps.h, row_steps.h and sum_steps.h.
template <class Backend>
class CalibrationStepsOn final : public CalibrationSteps {
 public:
  template <class Where>
  explicit CalibrationStepsOn(const Where& where)
      : backend_(where), search_(backend_), sums_(backend_) {}

  void load(const PointCloud& cloud, const ChosenPoints& few, const ChosenPoints& all,
            const std::vector<Vec3d>& axes, std::size_t lasers) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    positions_ = backend_.lent(cloud.positions);
    sensors_ = backend_.lent(cloud.sensor_positions);
    scan_indices_ = backend_.lent(cloud.scan_indices);
    lasers_ = backend_.lent(cloud.lasers);
    axes_ = backend_.lent(axes);
    laser_count_ = lasers;
    scan_count_ = axes.size();
    load(few, set_of(PointSet::few));
    load(all, set_of(PointSet::all));
    backend_.wait("load the points");
  }

  void correct(PointSet which, const ScanCorrections& corrections) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    take(corrections);
    Set& set = set_of(which);
    backend_.resize(set.corrected, set.indices.size());
    backend_.for_each(set.indices.size(), "correct points",
                      CorrectPoint{rays(), set.indices.data(), set.corrected.data()});
    backend_.wait("correct points");
  }

  std::vector<ScanPlane> find_planes(PointSet which, const ScanPlaneOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    searched_ = which;
    const Set& set = set_of(which);
    search_.run(set.corrected.data(), set.scans.data(), set.indices.size(), options);
    return backend_.on_host(search_.planes());
  }

  std::vector<double> left_out_residuals() override {
    [[maybe_unused]] const auto entered = backend_.enter();
    const std::size_t planes = search_.planes().size();
    Array<std::uint32_t> counts = backend_.template array<std::uint32_t>(planes);
    backend_.for_each(planes, "judge planes", CountLeftOut{members(), counts.data()});
    const auto begins = backend_.running_sums(counts);
    const std::vector<std::uint64_t>& begins_here = backend_.on_host(begins);
    Array<double> residuals_m = backend_.template array<double>(begins_here.back());
    backend_.for_each(planes, "judge planes",
                      MeasureLeftOut{members(), set_of(searched_).corrected.data(), begins.data(),
                                     residuals_m.data()});
    return backend_.on_host(std::move(residuals_m));
  }

  std::vector<DistanceSum> left_out_distances(double max_m, double max_weight) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    Array<DistanceSum> sums = backend_.template array<DistanceSum>(search_.planes().size());
    backend_.for_each(
        sums.size(), "judge planes",
        SumLeftOut{members(), set_of(searched_).corrected.data(), max_m, max_weight, sums.data()});
    return backend_.on_host(std::move(sums));
  }

  void choose_rows(const RowOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    const Set& set = set_of(searched_);
    const bool has_lasers = options.ranges || options.elevations || options.azimuths;
    sums_.choose(members(), search_.planes().size(), options, set.scans.data(), set.indices.data(),
                 lasers_.data(), scan_count_, has_lasers ? laser_count_ : 0);
    backend_.wait("order points on planes");
  }

  PlaneBlocks sum_rows(const ScanCorrections& corrections, const RowOptions& options) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    take(corrections);
    return sums_.sum(rays(), pivots_.data(), options);
  }

  PlaneStep coupled(const PlaneStep& x) override {
    [[maybe_unused]] const auto entered = backend_.enter();
    return sums_.coupled(x);
  }

 private:
  template <class T>
  using Array = typename Backend::template Array<T>;
  template <class T>
  using Lent = typename Backend::template Lent<T>;

  struct Set {
    Lent<std::uint32_t> indices, scans;
    std::uint32_t left_out_every = 1, left_out_end = 0;
    Array<Vec3d> corrected;
  };

  Set& set_of(PointSet which) { return sets_[static_cast<std::size_t>(which)]; }

  void load(const ChosenPoints& points, Set& set) const {
    set.indices = backend_.lent(points.indices);
    set.scans = backend_.lent(points.scans);
    set.left_out_every = points.left_out_every;
    set.left_out_end = points.left_out_end;
  }

  void take(const ScanCorrections& corrections) {
    corrected_from_given_ = backend_.copied(corrections.corrected_from_given);
    pivots_ = backend_.copied(corrections.pivots);
    range_m_ = backend_.copied(corrections.offsets.range_m);
    elevation_rad_ = backend_.copied(corrections.offsets.elevation_rad);
    azimuth_rad_ = backend_.copied(corrections.offsets.azimuth_rad);
  }

  RaysView rays() const {
    return {positions_.data(),     sensors_.data(),       scan_indices_.data(),
            data_or_null(lasers_), axes_.data(),          corrected_from_given_.data(),
            range_m_.data(),       elevation_rad_.data(), azimuth_rad_.data(),
            laser_count_};
  }

  PlaneMembers members() {
    const Set& set = set_of(searched_);
    return {search_.planes().data(), search_.order().data(), set.left_out_every, set.left_out_end};
  }

  Backend backend_;
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
  Array<double> range_m_, elevation_rad_, azimuth_rad_;
};

}  // namespace adasplats
