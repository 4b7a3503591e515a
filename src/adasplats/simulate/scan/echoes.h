// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "adasplats/core/maths/elementary.h"
#include "adasplats/core/maths/ray.h"
#include "adasplats/simulate/scan/returns.h"

namespace adasplats {

// From the hits of one firing to the pulses at the receiver, for CPU and GPU: the only
// implementation of returns_of(). Functions take `class_of(primitive)`; arrays have an entry per
// ray of a firing.

/// The echo along one sub-ray.
struct Echo {
  float range_m;
  float weight;
  std::uint32_t primitive;
  std::uint16_t class_id;
};

/// A pulse at the receiver: consecutive echoes of one class.
struct Pulse {
  float first_m;  ///< its rising edge
  float last_m;   ///< of its last echo so far
  float energy;   ///< of all its echoes
  std::uint16_t class_id;
};

ADASPLATS_HD inline bool lie_apart(float near_m, float far_m, double max_m) {
  return static_cast<double>(far_m) - static_cast<double>(near_m) > max_m;
}

/// Number of the `depth` hits of one ray that are averaged: D' of kernel_mean().
template <class ClassOf>
ADASPLATS_HD inline int overlapping_hits(const Hit* hits, int depth, double depth_gap_m,
                                         const ClassOf& class_of) {
  if (depth == 1) return 1;
  int count = 1;
  const std::uint16_t first_class = class_of(hits[0].primitive);
  while (count < depth && hits[count].valid() &&
         !lie_apart(hits[count - 1].t, hits[count].t, depth_gap_m) &&
         class_of(hits[count].primitive) == first_class)
    ++count;
  return count;
}

/// The weighted mean of the paper (section "SimKITTI32"): P = sum(beta_i P_i) / sum(beta_i), beta_i
/// = exp(-|d_i - D/2| / (D/2)). Our interpretation: d_i counts the hits of the ray from 1, and D is
/// the number of averaged hits ("we reset D to the maximum number of intersections"), not the
/// requested depth. The mean includes the first hit and the following ones while they have its
/// class and are within the gap of the previous one. All are on one ray, so the mean of the points
/// is that of the ranges. `primitive` is that of the greatest weight; of two, the nearer.
ADASPLATS_HD inline Hit kernel_mean(const Hit* hits, int count) {
  if (count == 1) return hits[0];  // beta_1 / beta_1: exactly the hit
  const double half = static_cast<double>(count) / 2.0;
  double sum = 0;
  double weight_sum = 0;
  double greatest = 0;
  Hit mean;
  for (int i = 0; i < count; ++i) {
    const double away = static_cast<double>(i + 1) - half;
    const double beta = exp_of(-(away < 0 ? -away : away) / half);
    sum += beta * static_cast<double>(hits[i].t);
    weight_sum += beta;
    if (beta > greatest) {
      mean.primitive = hits[i].primitive;
      greatest = beta;
    }
  }
  mean.t = static_cast<float>(sum / weight_sum);
  return mean;
}

/// Fills the echoes of a firing, sorted by range and then by ray; returns their number.
template <class ClassOf>
ADASPLATS_HD inline int echoes_of(const Hit* hits, const float* weights, const BeamOptions& options,
                                  const ClassOf& class_of, Echo* echoes) {
  int count = 0;
  for (int ray = 0; ray < options.sub_rays; ++ray) {
    const Hit* const of_ray = hits + ray * options.depth;
    if (!of_ray[0].valid()) continue;
    const Hit mean =
        kernel_mean(of_ray, overlapping_hits(of_ray, options.depth, options.depth_gap_m, class_of));
    const Echo echo{mean.t, weights[ray], mean.primitive, class_of(mean.primitive)};
    int place = count++;
    for (; place > 0 && echoes[place - 1].range_m > echo.range_m; --place)
      echoes[place] = echoes[place - 1];
    echoes[place] = echo;
  }
  return count;
}

/// The echoes of the rising edge of one pulse.
struct PulseEdge {
  const Echo* echoes;
  const std::uint8_t* pulse_of;
  int count;
  int number;
  float first_m;
  double depth_gap_m;

  ADASPLATS_HD bool holds(int i) const {
    return pulse_of[i] == number && !lie_apart(first_m, echoes[i].range_m, depth_gap_m);
  }
  /// The primitive with the highest energy; of two, the nearer.
  ADASPLATS_HD std::uint32_t strongest_primitive() const {
    std::uint32_t strongest = Hit::kNone;
    float greatest = -1;
    for (int i = 0; i < count; ++i) {
      if (!holds(i)) continue;
      float energy = 0;
      for (int j = 0; j < count; ++j)
        if (holds(j) && echoes[j].primitive == echoes[i].primitive) energy += echoes[j].weight;
      if (energy > greatest) {
        strongest = echoes[i].primitive;
        greatest = energy;
      }
    }
    return strongest;
  }
};

/// A receiver triggers on the rising edge: echoes later than the gap after the first echo of a
/// pulse add to its energy, not to its range.
ADASPLATS_HD inline Return return_of_pulse(const Pulse& pulse, const PulseEdge& edge) {
  double sum = 0;
  double weight_sum = 0;
  for (int i = 0; i < edge.count; ++i) {
    if (!edge.holds(i)) continue;
    const auto weight = static_cast<double>(edge.echoes[i].weight);
    sum += weight * static_cast<double>(edge.echoes[i].range_m);
    weight_sum += weight;
  }
  // If all weights are zero, the range is that of the edge.
  const float range_m = weight_sum > 0 ? static_cast<float>(sum / weight_sum) : pulse.first_m;
  return {range_m, edge.strongest_primitive(), pulse.energy};
}

/// Inserts `value` into `count` ascending returns, after those of the same range.
ADASPLATS_HD inline void insert_by_range(Return* returns, int count, Return value) {
  for (; count > 0 && returns[count - 1].range_m > value.range_m; --count)
    returns[count] = returns[count - 1];
  returns[count] = value;
}

/// The pulses of the echoes as returns, by range. An echo belongs to the pulse of the previous echo
/// of its class: if two classes share a range, each keeps one pulse.
template <int kMost>
ADASPLATS_HD inline int pulses_of(const Echo* echoes, int echo_count, const BeamOptions& options,
                                  Return* returns) {
  Pulse pulses[kMost];           // NOLINT: filled as far as it is read
  std::uint8_t pulse_of[kMost];  // NOLINT: of each echo
  int count = 0;
  for (int i = 0; i < echo_count; ++i) {
    const Echo& echo = echoes[i];
    int pulse = 0;
    while (pulse < count && (pulses[pulse].class_id != echo.class_id ||
                             lie_apart(pulses[pulse].last_m, echo.range_m, options.separation_m)))
      ++pulse;
    if (pulse == count) pulses[count++] = {echo.range_m, echo.range_m, 0, echo.class_id};
    pulses[pulse].last_m = echo.range_m;
    pulses[pulse].energy += echo.weight;
    pulse_of[i] = static_cast<std::uint8_t>(pulse);
  }
  // Pulses are sorted by their first echo, but the means of overlapping ones may be out of order.
  for (int i = 0; i < count; ++i) {
    const PulseEdge edge{echoes, pulse_of, echo_count, i, pulses[i].first_m, options.depth_gap_m};
    insert_by_range(returns, i, return_of_pulse(pulses[i], edge));
  }
  return count;
}

/// Index in `left` (ascending) of the next return to report after `reported` ones, the first of
/// which was at `first`.
ADASPLATS_HD inline int next_reported(const Return* first, int reported, const Return* left,
                                      int left_count, ReturnMode mode) {
  if (mode == ReturnMode::first) return 0;
  if (mode == ReturnMode::last) return left_count - 1;
  if (reported == 1 && left[left_count - 1].range_m > first->range_m) return left_count - 1;
  int strongest = 0;
  for (int i = 1; i < left_count; ++i)
    if (left[i].energy > left[strongest].energy) strongest = i;
  return strongest;
}

/// reported_returns() of `count` pulses.
ADASPLATS_HD inline int select_returns(Return* pulses, int count, const BeamOptions& options) {
  int reported = 0;
  int end = count;
  while (reported < end && reported < options.returns) {
    Return* const left = pulses + reported;
    const int next = next_reported(pulses, reported, left, end - reported, options.mode);
    const Return chosen = left[next];
    for (int i = next; i > 0; --i) left[i] = left[i - 1];
    left[0] = chosen;
    ++reported;
    // A pulse that the receiver cannot separate from the chosen one is not a separate return.
    int kept = reported;
    for (int i = reported; i < end; ++i) {
      const float other_m = pulses[i].range_m;
      const bool nearer = other_m < chosen.range_m;
      if (lie_apart(nearer ? other_m : chosen.range_m, nearer ? chosen.range_m : other_m,
                    options.separation_m))
        pulses[kept++] = pulses[i];
    }
    end = kept;
  }
  return reported;
}

/// returns_of() with at most kMost rays per firing; `out` holds up to kMost returns. Returns their
/// number.
template <int kMost, class ClassOf>
ADASPLATS_HD inline int firing_returns(const Hit* hits, const float* weights,
                                       const BeamOptions& options, const ClassOf& class_of,
                                       Return* out) {
  if (kMost == 1 || options.sub_rays == 1) {  // the case of nearly all scans
    if (!hits[0].valid()) return 0;
    const Hit mean =
        kernel_mean(hits, overlapping_hits(hits, options.depth, options.depth_gap_m, class_of));
    out[0] = {mean.t, mean.primitive, weights[0]};
    return 1;
  }
  if constexpr (kMost > 1) {
    Echo echoes[kMost];  // NOLINT: filled as far as it is read
    const int echo_count = echoes_of(hits, weights, options, class_of, echoes);
    return select_returns(out, pulses_of<kMost>(echoes, echo_count, options, out), options);
  }
  return 0;
}

}  // namespace adasplats
