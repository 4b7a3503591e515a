// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "adasplats/baselines/imls.h"
#include "adasplats/core/error.h"

namespace adasplats {
namespace {

constexpr int kSide = ImlsField::kSide;
constexpr int kBits = 21;  // of a block coordinate in a key
constexpr std::int64_t kHalf = std::int64_t{1} << (kBits - 1);
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;

using Cell = std::array<std::int64_t, 3>;

std::uint64_t key_of(const Cell& block) {
  std::uint64_t key = 0;
  for (const std::int64_t c : block) key = key << kBits | static_cast<std::uint64_t>(c + kHalf);
  return key;
}

Cell block_of(std::uint64_t key) {
  Cell block{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t bits = key >> (kBits * (2 - axis)) & kMask;
    block[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(bits) - kHalf;
  }
  return block;
}

/// The block that contains a position (in voxels).
Cell block_at(Vec3d voxels) {
  Cell block{};
  for (int axis = 0; axis < 3; ++axis) {
    block[static_cast<std::size_t>(axis)] =
        static_cast<std::int64_t>(std::floor(voxels[axis] / kSide));
  }
  return block;
}

void check(const ImlsOptions& options, std::size_t points, std::size_t normals) {
  const auto require = [](bool good, const std::string& what) {
    if (!good) throw Error(ErrorKind::usage, what);
  };
  if (points != normals)
    throw std::logic_error("ImlsField: the numbers of points and normals differ");
  static_assert(kSide == 8, "as in the table of settings");
  check_settings(options);
  // Beyond 3 sigmas weights are below 0.0002, and weight() is only valid within.
  require(3 * options.sigma_voxels >= options.truncation_voxels,
          "sigma must be at least a third of the truncation");
}

/// exp(-u) for 0 <= u <= 9 with a relative error of 1e-4: (exp(-u / 16))^16 with a Taylor series.
/// Unlike std::exp it gives the same bits everywhere, and the compiler vectorises it.
inline float weight(float u) {
  const float t = u * (-1.0F / 16.0F);
  float e = 1.0F + t * (1.0F / 6.0F);
  e = 1.0F + t * (1.0F / 5.0F) * e;
  e = 1.0F + t * (1.0F / 4.0F) * e;
  e = 1.0F + t * (1.0F / 3.0F) * e;
  e = 1.0F + t * (1.0F / 2.0F) * e;
  e = 1.0F + t * e;
  e *= e;
  e *= e;
  e *= e;
  return e * e;
}

/// The two sums of eq. IMLS for the voxels of a block. Lengths are in voxels.
class Sums {
 public:
  explicit Sums(const ImlsOptions& options)
      : reach_(static_cast<float>(options.truncation_voxels)),
        squared_reach_(reach_ * reach_),
        per_squared_sigma_(
            static_cast<float>(1.0 / (options.sigma_voxels * options.sigma_voxels))) {}

  /// `point` from the block's lowest voxel.
  void add(Vec3f point, Vec3f normal) {
    if (point.z + reach_ < 0.0F || point.z - reach_ > kSide - 1) return;
    const int x_end = last(point.x), y_end = last(point.y);
    for (int x = first(point.x); x <= x_end; ++x) {
      const float dx = static_cast<float>(x) - point.x;
      for (int y = first(point.y); y <= y_end; ++y) {
        const float dy = static_cast<float>(y) - point.y;
        const float squared = dx * dx + dy * dy;
        if (squared > squared_reach_) continue;
        add_row((x * kSide + y) * kSide, squared, normal.x * dx + normal.y * dy, point.z, normal.z);
      }
    }
  }

  void finish(double voxel_m, ImlsField::Block& block) const {
    block.known.fill(0);
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      const bool known = weights_[i] > 0.0F;
      block.values[i] = known ? static_cast<float>(voxel_m) * (distances_[i] / weights_[i]) : 0.0F;
      block.known[i / 64] |= std::uint64_t{known} << (i % 64);
    }
  }

 private:
  int first(float c) const { return std::max(0, static_cast<int>(std::ceil(c - reach_))); }
  int last(float c) const { return std::min(kSide - 1, static_cast<int>(std::floor(c + reach_))); }

  void add_row(int start, float squared_xy, float distance_xy, float z0, float normal_z) {
    float* const distances = &distances_[static_cast<std::size_t>(start)];
    float* const weights = &weights_[static_cast<std::size_t>(start)];
    for (int z = 0; z < kSide; ++z) {
      const float dz = static_cast<float>(z) - z0;
      const float squared = squared_xy + dz * dz;
      const bool within = squared <= squared_reach_;
      const float w = within ? weight(squared * per_squared_sigma_) : 0.0F;
      distances[z] += w * (distance_xy + normal_z * dz);
      weights[z] += w;
    }
  }

  float reach_, squared_reach_, per_squared_sigma_;
  std::array<float, kSide * kSide * kSide> distances_{};
  std::array<float, kSide * kSide * kSide> weights_{};
};

}  // namespace

ImlsField::ImlsField(std::span<const Vec3f> points, std::span<const Vec3f> normals,
                     const ImlsOptions& options, const Executor& executor)
    : points_(points), normals_(normals), options_(options) {
  check(options, points.size(), normals.size());
  std::vector<std::uint64_t> keys(points.size());
  executor.for_chunks(keys.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3d position = in_voxels(i);
      // One block less than the maximum, for the neighbours.
      constexpr auto kMax = static_cast<double>((kHalf - 2) * kSide);
      const bool fits = std::fabs(position.x) < kMax && std::fabs(position.y) < kMax &&
                        std::fabs(position.z) < kMax;
      if (!fits)
        throw Error(ErrorKind::usage,
                    "the voxels are too small for the extents of the cloud; use larger ones");
      keys[i] = key_of(block_at(position));
    }
  });
  executor.sort_keys(keys, order_);
  for (std::uint32_t i = 0; i < keys.size(); ++i) {
    if (runs_.empty() || runs_.back().key != keys[i]) runs_.push_back({keys[i], i, i});
    runs_.back().end = i + 1;
  }
  find_blocks(executor);
}

Vec3d ImlsField::in_voxels(std::size_t point) const {
  return vec_cast<double>(points_[point]) / options_.voxel_m;
}

void ImlsField::find_blocks(const Executor& executor) {
  // The blocks, of the 27 around it, that a block's points reach, one bit each.
  std::vector<std::uint32_t> reached(runs_.size());
  const double reach = options_.truncation_voxels;
  executor.for_chunks(runs_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) {
      const Cell own = block_of(runs_[r].key);
      for (std::uint32_t i = runs_[r].begin; i < runs_[r].end; ++i) {
        const Vec3d position = in_voxels(order_[i]);
        const Cell low = block_at(position - Vec3d{reach, reach, reach});
        const Cell high = block_at(position + Vec3d{reach, reach, reach});
        for (std::int64_t x = low[0]; x <= high[0]; ++x)
          for (std::int64_t y = low[1]; y <= high[1]; ++y)
            for (std::int64_t z = low[2]; z <= high[2]; ++z)
              reached[r] |= 1U << ((x - own[0] + 1) * 9 + (y - own[1] + 1) * 3 + (z - own[2] + 1));
      }
    }
  });
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const Cell own = block_of(runs_[r].key);
    for (int n = 0; n < 27; ++n) {
      if ((reached[r] >> n & 1U) == 0) continue;
      blocks_.push_back(key_of({own[0] + n / 9 - 1, own[1] + n / 3 % 3 - 1, own[2] + n % 3 - 1}));
    }
  }
  std::sort(blocks_.begin(), blocks_.end());
  blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
}

ImlsField::Block ImlsField::block(std::size_t i) const {
  const Cell own = block_of(blocks_[i]);
  Block block;
  Vec3d corner;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t voxel = own[static_cast<std::size_t>(axis)] * kSide;
    block.corner[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(voxel);
    corner[axis] = static_cast<double>(voxel);
  }
  Sums sums(options_);
  for (std::int64_t x = own[0] - 1; x <= own[0] + 1; ++x)
    for (std::int64_t y = own[1] - 1; y <= own[1] + 1; ++y) {
      // The three blocks along z are consecutive in the order of the keys.
      const std::uint64_t low = key_of({x, y, own[2] - 1});
      const std::uint64_t high = key_of({x, y, own[2] + 1});
      auto run = std::lower_bound(runs_.begin(), runs_.end(), low,
                                  [](const Run& r, std::uint64_t key) { return r.key < key; });
      for (; run != runs_.end() && run->key <= high; ++run)
        for (std::uint32_t k = run->begin; k < run->end; ++k)
          sums.add(vec_cast<float>(in_voxels(order_[k]) - corner), normals_[order_[k]]);
    }
  sums.finish(options_.voxel_m, block);
  return block;
}

}  // namespace adasplats
