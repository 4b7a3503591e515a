// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "adasplats/core/host_device.h"
#include "adasplats/scene/intersect.h"

namespace adasplats {

struct CoverOptions {              // sources of the numbers: docs/research/consistent.md
  std::uint32_t neighbors = 160;   ///< maximum number of seeds that a disk can grow over
  double tolerance_m = 0.02;       ///< a disk grows over seeds within this distance of its plane...
  double min_normal_cosine = 0.9;  ///< ...with normals aligned like this
  double edge_m = 0.25;            ///< seeds farther from the plane are other objects: no edge
  double largest_radius_m = 0.5;
  /// In each of this many directions a disk reaches no farther than the seeds that it grows over
  /// (plus half a seed), so it overhangs no edge. 0: no such limit, for clouds whose rays separate
  /// edges from unseen surfaces. 0, 1, 2, 4, 8 or 16.
  int sectors = 0;
  int unchecked_sectors = 16;      ///< the same for seeds without rays
  double overlap = 0.6;            ///< a disk covers the seeds within this share of its radius
  double covered_within_m = 0.04;  ///< and within this distance of its plane

  /// Distance beyond which no seed matters to a disk with this radius before it grows.
  double reach_m(float radius_m) const {
    constexpr double kRounding = 1.001;
    const double along_m = std::max(largest_radius_m, static_cast<double>(radius_m));
    const double height_m = std::max({edge_m, tolerance_m, covered_within_m});
    return kRounding * std::sqrt(along_m * along_m + height_m * height_m);
  }
};

/// Position of a point relative to a disk.
struct DiskOffset {
  float height_m;  ///< above or below the plane, not negative
  float along_m;   ///< from the centre, in the plane
};

ADASPLATS_HD inline DiskOffset disk_offset(const Disk& disk, Vec3f point) {
  const Vec3f offset = point - disk.center;
  const float height_m = dot(offset, disk.normal);
  return {std::fabs(height_m),
          std::sqrt(std::max(0.0F, dot(offset, offset) - height_m * height_m))};
}

/// Whether a disk may grow over another seed.
ADASPLATS_HD inline bool grows_over(const Disk& disk, const Disk& other, const DiskOffset& place,
                                    const CoverOptions& options) {
  const auto height_m = static_cast<double>(place.height_m);
  const auto cosine = static_cast<double>(std::fabs(dot(other.normal, disk.normal)));
  return height_m < options.tolerance_m && cosine > options.min_normal_cosine;
}

/// Whether a disk must end before another seed; `grows` tells whether it grows over it.
ADASPLATS_HD inline bool ends_at(const DiskOffset& place, bool grows, const CoverOptions& options) {
  return !grows && static_cast<double>(place.height_m) < options.edge_m;
}

/// Whether a disk that covers up to `covered_m` from its centre can cover a seed.
ADASPLATS_HD inline bool may_cover(const DiskOffset& place, float covered_m,
                                   const CoverOptions& options) {
  return place.along_m <= covered_m &&
         static_cast<double>(place.height_m) < options.covered_within_m;
}

/// The sixteenth of a turn that a vector points into, counter-clockwise from (1, 0); a border
/// belongs to the sector that it begins. Uses only comparisons: an arc tangent differs in its last
/// bits on a GPU.
ADASPLATS_HD inline int sixteenth_of_turn(float x, float y) {
  constexpr float kTan = 0.41421356F;  // of an eighth of pi: sqrt(2) - 1
  // Rotate by quarter turns, which is exact, into the first quadrant.
  int quarter = 0;
  float a = x, b = y;
  if (x <= 0 && y > 0) {
    quarter = 1, a = y, b = -x;
  } else if (x < 0 && y <= 0) {
    quarter = 2, a = -x, b = -y;
  } else if (x >= 0 && y < 0) {
    quarter = 3, a = -y, b = x;
  }
  const int sixteenth = b < a ? (b < kTan * a ? 0 : 1) : (a > kTan * b ? 2 : 3);
  return 4 * quarter + sixteenth;
}

/// How far seeds reach from a disk's centre, for each of equal sectors of its plane.
class SectorReach {
 public:
  static constexpr int kMaxSectors = 16;

  /// A sector is a whole number of sixteenths of a turn.
  static bool is_valid_count(int sectors) {
    return sectors == 0 || (sectors > 0 && sectors <= kMaxSectors && kMaxSectors % sectors == 0);
  }

  ADASPLATS_HD SectorReach(const Disk& disk, int sectors)
      : center_(disk.center), sectors_(sectors) {
    for (float& reach_m : reach_m_) reach_m = 0;
    if (sectors_ == 0) return;
    const Vec3f axis = std::fabs(disk.normal.z) < 0.9F ? Vec3f{0, 0, 1} : Vec3f{1, 0, 0};
    right_ = normalized(cross(disk.normal, axis));
    up_ = cross(disk.normal, right_);
  }

  ADASPLATS_HD void add(Vec3f point, float along_m) {
    if (sectors_ == 0) return;
    const Vec3f offset = point - center_;
    const int sixteenth = sixteenth_of_turn(dot(offset, right_), dot(offset, up_));
    float& reach_m = reach_m_[sixteenth * sectors_ / kMaxSectors];
    reach_m = std::max(reach_m, along_m);
  }

  ADASPLATS_HD int sectors() const { return sectors_; }
  ADASPLATS_HD float& reach_m(int sector) { return reach_m_[sector]; }

  /// The minimum over all sectors; without sectors there is no limit.
  ADASPLATS_HD float min_m() const {
    float min_m = std::numeric_limits<float>::max();
    for (int i = 0; i < sectors_; ++i) min_m = std::min(min_m, reach_m_[i]);
    return min_m;
  }

 private:
  Vec3f center_, right_, up_;
  float reach_m_[kMaxSectors];
  int sectors_;
};

/// The radius of a disk that grew over seeds up to `reach_m` from its centre.
ADASPLATS_HD inline float grown_radius(const Disk& disk, float reach_m,
                                       const SectorReach& sectors) {
  return std::max(disk.radius, std::min(reach_m, sectors.min_m() + 0.5F * disk.radius));
}

/// The distance from its centre up to which a disk of this radius covers seeds.
ADASPLATS_HD inline float covered_reach(double overlap, float radius_m) {
  return static_cast<float>(overlap) * radius_m;
}

/// Maximum radii of the disks of all seeds, in host or device memory.
struct CoverLimits {
  Disk* seeds = nullptr;
  float* radii_m = nullptr;

  /// Limits the radius of disk `i`; 0 removes the disk.
  ADASPLATS_HD void limit(std::size_t i, float limit_m) const {
    radii_m[i] = std::min(radii_m[i], limit_m);
    seeds[i].radius = std::min(seeds[i].radius, limit_m);
  }
};

}  // namespace adasplats
