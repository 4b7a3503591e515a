// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "adasplats/core/maths/ray.h"

namespace adasplats {

/// What one ray meets in a scene of soft disks, and where it most likely ends. Hits may come in any
/// order. They are kept up to the distance that few rays reach or where one outweighs all farther
/// ones, at most kMost. The ray stops at hit k with the probability w_k = a_k prod_{j<k} (1 - a_j)
/// for opacities a.
class SoftHits {
 public:
  static constexpr int kMost = 8;
  static constexpr float kFewPass = 0.1F;  ///< share of rays that is not followed farther
  /// Behind a hit with a higher opacity no other surface is more likely: fewer rays pass it than
  /// stop there.
  static constexpr float kSolid = 0.51F;
  /// Hits that are closer together are one surface: a few standard deviations of range noise and
  /// of the disks' positions.
  static constexpr float kSurface_m = 0.12F;

  /// Distance up to which hits matter, at most `t_max`.
  ADASPLATS_HD float reach(float t_max) const { return reach_ < t_max ? reach_ : t_max; }

  ADASPLATS_HD void offer(Hit hit, float opacity) {
    if (hit.t > reach_) return;
    if (opacity > kSolid) end_at(hit.t + kSurface_m);
    // Loops of constant length with constant indices, so that a GPU keeps the hits in registers.
    for (int k = 0; k < kMost; ++k) {
      if (!(hit < hits_[k])) continue;
      std::swap(hit, hits_[k]);
      std::swap(opacity, opacities_[k]);
    }
    // More hits make no product larger, so what ends here ends with all hits, too.
    float passes = 1, end_m = 0;
    for (int k = 0; k < kMost; ++k) {
      if (passes < kFewPass || hits_[k].t > reach_) {
        hits_[k] = Hit{};
        opacities_[k] = 0;
      }
      passes *= 1 - opacities_[k];
      if (hits_[k].valid()) end_m = hits_[k].t;
    }
    if (passes < kFewPass || hits_[kMost - 1].valid()) end_at(end_m);
  }

  /// offer() for hits in ascending order, which is faster; not to be mixed. Returns false if no
  /// farther hit matters.
  ADASPLATS_HD bool append(Hit hit, float opacity) {
    if (hit.t > reach_) return false;
    hits_[count_] = hit;
    opacities_[count_] = opacity;
    passes_ *= 1 - opacity;
    if (opacity > kSolid) end_at(hit.t + kSurface_m);
    return ++count_ < kMost && !(passes_ < kFewPass);
  }

  /// The surface with the highest probability that the ray ends there: the weighted mean of its
  /// hits, and the disk with the highest weight. Not valid() if the ray rather passes all disks.
  ADASPLATS_HD Hit most_likely() const {
    float weights[kMost] = {};
    float passes = 1;
    for (int k = 0; k < kMost; ++k) {
      if (!hits_[k].valid()) break;
      weights[k] = passes * opacities_[k];
      passes *= 1 - opacities_[k];
    }
    Hit likely;
    float most = passes;
    float left = 1;  // share of rays that reach the hit
    for (int first = 0; first < kMost; ++first) {
      if (!hits_[first].valid() || left * 1.0001F < most) break;
      left *= 1 - opacities_[first];
      float weight = 0, moment = 0, heaviest = 0;
      std::uint32_t primitive = Hit::kNone;
      for (int k = first; k < kMost; ++k) {
        if (!(hits_[k].t <= hits_[first].t + kSurface_m)) break;
        weight += weights[k];
        moment += weights[k] * (hits_[k].t - hits_[first].t);
        if (!(weights[k] > heaviest)) continue;
        heaviest = weights[k];
        primitive = hits_[k].primitive;
      }
      if (!(weight > most)) continue;
      most = weight;
      likely = {hits_[first].t + moment / weight, primitive};
    }
    return likely;
  }

 private:
  ADASPLATS_HD void end_at(float t) {
    if (t < reach_) reach_ = t;
  }

  Hit hits_[kMost];              ///< ascending; the last ones may be none
  float opacities_[kMost] = {};  ///< 0 for none
  float reach_ = std::numeric_limits<float>::infinity();
  int count_ = 0;     ///< of append()
  float passes_ = 1;  ///< of append()
};

}  // namespace adasplats
