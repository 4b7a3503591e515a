// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "adasplats/scene/intersect.h"
#include "adasplats/splats/reflectance/element_steps.h"
#include "adasplats/splats/reflectance/reflectance.h"
#include "adasplats/splats/reflectance/response_tables.h"

namespace adasplats {

/// Measured rays and the intensities of their points, in the backend's memory.
template <class Backend>
struct RaysWithIntensities {
  const typename Backend::Rays* rays;
  const typename Backend::template Array<float>* intensities;
};

/// Rays of nearer points have no direction.
inline constexpr double kMinReflectanceRange_m = 1e-3;

/// Casts every measured ray into a model and fits the reflectance of every disk and the response of
/// the sensor to the intensities, by alternating least squares in five rounds. Uses the rays with a
/// first hit within 0.2 m + 0.5 % of the range of the measured point. A disk with few rays is drawn
/// to the disks with a similar normal in the same 0.4 m cell (with the weight of three rays), and
/// those to the mean of all. Rays with kLostIntensity also show which disks lose more returns than
/// others at the same range and incidence. Sums are integers: the same bytes on any number of
/// threads and on every device.
///
/// `Backend` is RaysOnCpu or its GPU counterpart; element_steps.h has the work for one element.
/// Memory: 32 bytes per ray.
template <class Backend>
class ReflectancesOn {
 public:
  /// `fallback`: values for disks in cells without rays, one per disk; NaN: the mean of all.
  /// `response`: of the sensor, with the nodes of result(); nullptr: it is fitted.
  ReflectancesOn(const Backend& backend, const std::vector<Disk>& disks,
                 const std::vector<float>& fallback, const IntensityResponse* response = nullptr)
      : backend_(backend),
        disks_(disks),
        fallback_(fallback),
        is_response_known_(response != nullptr) {
    gains_.of_ranges.fill(1.0F);
    gains_.of_cosines.fill(1.0F);
    if (response == nullptr) return;
    if (response->range_gains.size() != gains_.of_ranges.size() ||
        response->incidence_gains.size() != gains_.of_cosines.size())
      throw std::logic_error("ReflectancesOn: a response with other nodes");
    std::ranges::copy(response->range_gains, gains_.of_ranges.begin());
    std::ranges::copy(response->incidence_gains, gains_.of_cosines.begin());
  }

  /// Returns the fallback and an empty response if fewer than 1000 rays meet the model near their
  /// points.
  Reflectances run(std::span<const RaysWithIntensities<Backend>> measured) {
    if (disks_.empty()) return {fallback_, {}};
    const auto& disks = backend_.copied(disks_);
    observe(disks, measured);
    if (ray_count_ < (is_response_known_ ? 1 : kMinRays)) return {fallback_, {}};
    order_cells(disks);
    sums_ = backend_.template array<ValueSums>(disks_.size());
    values_ = backend_.template array<float>(disks_.size());
    const auto& fallback = backend_.copied(fallback_);
    fit_values(fallback.data());
    for (int turn = 0; turn < (is_response_known_ ? 0 : kTurns); ++turn) {
      fit_gains();
      fit_values(fallback.data());
    }
    measure_losses();
    backend_.wait("measure reflectances");
    return result();
  }

 private:
  template <class T>
  using Array = typename Backend::template Array<T>;

  /// Chosen: some 35 rays per node of the tables. With fewer, noise dominates.
  static constexpr std::uint64_t kMinRays = 1000;
  /// Rounds of both fits. Chosen: each needs a pass over all rays.
  static constexpr int kTurns = 5;

  double largest_of(const Array<float>& values) const {
    const LargestOf found = backend_.template sum<LargestOf>(
        values.size(), "find the largest value", FindLargest{values.data()});
    return static_cast<double>(found.value);
  }

  /// Makes the observations, sorted by disk.
  void observe(const Array<Disk>& disks, std::span<const RaysWithIntensities<Backend>> measured) {
    double largest = 0;
    std::size_t rays = 0;
    for (const auto& part : measured) {
      largest = std::max(largest, largest_of(*part.intensities));
      rays += part.rays->size();
    }
    intensity_unit_ = power_of_two_above(largest);
    auto counts = backend_.template zeros<std::uint32_t>(disks.size());
    auto unordered = backend_.template array<Observation>(rays);
    std::vector<std::pair<const typename Backend::Rays*, ObserveRay>> parts;
    Observation* to = unordered.data();
    for (const auto& part : measured) {
      const ObserveRay observe = {
          disks.data(), part.intensities->data(), 1 / intensity_unit_, ResponseNodes{}, to,
          counts.data()};
      parts.emplace_back(part.rays, observe);
      to += part.rays->size();
    }
    backend_.observe(disks, parts);
    ray_count_ =
        backend_.template sum<RayCount>(counts.size(), "count rays", AddCounts{counts.data()}).rays;
    begins_ = backend_.running_sums(counts);
    observations_ = backend_.template array<Observation>(ray_count_);
    backend_.for_each(
        unordered.size(), "order observations",
        PutByDisk{unordered.data(), begins_.data(), counts.data(), observations_.data()});
    backend_.wait("cast measured rays");
  }

  void order_cells(const Array<Disk>& disks) {
    auto keys = backend_.template array<std::uint64_t>(disks.size());
    backend_.for_each(disks.size(), "find cells of disks", FindCell{disks.data(), keys.data()});
    order_ = backend_.sort(keys);
    cells_ = backend_.run_begins(keys);
    backend_.wait("find cells of disks");
  }

  void fit_values(const float* fallback) {
    const double gain_unit =
        power_of_two_above(static_cast<double>(*std::ranges::max_element(gains_.of_ranges) *
                                               *std::ranges::max_element(gains_.of_cosines)));
    backend_.for_each(
        disks_.size(), "fit reflectances",
        SumOfDisk{observations_.data(), begins_.data(), gains_, 1 / gain_unit, sums_.data()});
    const ValueSums all =
        backend_.template sum<ValueSums>(disks_.size(), "fit reflectances", AddSums{sums_.data()});
    const double usual = all.square > 0 ? static_cast<double>(all.product) /
                                              (static_cast<double>(all.square) * gain_unit)
                                        : 0.0;
    backend_.for_each(cells_.size() - 1, "fit reflectances",
                      SetReflectances{order_.data(), cells_.data(), sums_.data(), gain_unit, usual,
                                      fallback, 1 / intensity_unit_, values_.data()});
  }

  /// Fits one table after the other.
  void fit_gains() {
    const double value_unit = power_of_two_above(largest_of(values_));
    const auto per_factor = [&](const auto& gains) {
      return 1 / (value_unit *
                  power_of_two_above(static_cast<double>(*std::ranges::max_element(gains))));
    };
    gains_.of_ranges =
        solved(backend_.template sum<RangeSums>(ray_count_, "fit the response",
                                                AddToRanges{observations_.data(), values_.data(),
                                                            gains_, per_factor(gains_.of_cosines)}),
               ResponseNodes::kUnitRange);
    gains_.of_cosines = solved(
        backend_.template sum<CosineSums>(ray_count_, "fit the response",
                                          AddToCosines{observations_.data(), values_.data(), gains_,
                                                       per_factor(gains_.of_ranges)}),
        ResponseNodes::kUnitCosine);
  }

  void measure_losses() {
    const auto by_range = backend_.template sum<LossSums<ResponseNodes::kRanges>>(
        ray_count_, "count lost beams", AddLossByRange{observations_.data()});
    if (std::ranges::all_of(by_range.lost, [](std::int64_t lost) { return lost == 0; })) return;
    LossRates rates = {rates_of(by_range, 20), {}};
    rates.of_cosines.fill(1.0F);
    rates.of_cosines =
        rates_of(backend_.template sum<LossSums<ResponseNodes::kCosines>>(
                     ray_count_, "count lost beams", AddLossByCosine{observations_.data(), rates}),
                 1);
    drop_log_odds_ = backend_.template array<float>(disks_.size());
    backend_.for_each(
        disks_.size(), "count lost beams",
        SetDropLogOdds{observations_.data(), begins_.data(), rates, drop_log_odds_.data()});
  }

  /// Lost over expected beams. One lost beam and `expected` ones are added to each node.
  template <std::size_t N>
  static std::array<float, N> rates_of(const LossSums<N>& sums, double expected) {
    std::array<float, N> rates;
    for (std::size_t k = 0; k < N; ++k)
      rates[k] =
          static_cast<float>((static_cast<double>(sums.lost[k]) + 1) /
                             (kShareUnit * static_cast<double>(sums.expected[k]) + expected));
    return rates;
  }

  Reflectances result() const {
    constexpr ResponseNodes kNodes;
    Reflectances result;
    result.values = backend_.on_host(values_);
    for (float& value : result.values)
      value = static_cast<float>(static_cast<double>(value) * intensity_unit_);
    result.response = {{kNodes.ranges_m.begin(), kNodes.ranges_m.end()},
                       {gains_.of_ranges.begin(), gains_.of_ranges.end()},
                       {kNodes.cosines.begin(), kNodes.cosines.end()},
                       {gains_.of_cosines.begin(), gains_.of_cosines.end()}};
    if (drop_log_odds_.size() > 0) result.drop_log_odds = backend_.on_host(drop_log_odds_);
    return result;
  }

  const Backend& backend_;
  const std::vector<Disk>& disks_;
  const std::vector<float>& fallback_;
  bool is_response_known_;
  double intensity_unit_ = 1;
  std::uint64_t ray_count_ = 0;
  ResponseGains gains_;
  Array<Observation> observations_;  ///< disk by disk
  Array<std::uint64_t> begins_;      ///< of the disks
  Array<std::uint32_t> order_;       ///< disks, cell by cell
  Array<std::uint32_t> cells_;       ///< where they begin
  Array<ValueSums> sums_;            ///< of the disks
  Array<float> values_;              ///< of the disks, divided by the unit of intensities
  Array<float> drop_log_odds_;       ///< of the disks; empty: no lost beams
};

}  // namespace adasplats
