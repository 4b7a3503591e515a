// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/view/street_pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "adasplats/core/maths/vec3.h"

namespace adasplats {
namespace {

constexpr float kCell_m = 1;
/// Maximum cells per side; of larger scenes, only the part around the median position is used.
constexpr int kMaxCells = 2000;
/// Thickness of the ground with its noise and slope.
constexpr float kGround_m = 0.35F;
/// Points higher above the ground do not block a cell.
constexpr float kPassage_m = 2.2F;
constexpr std::uint32_t kMinPoints = 3;
constexpr int kOpenReach = 3;    ///< neighbouring cells that should be open, too
constexpr int kDenseReach = 20;  ///< neighbouring cells for the density of points
constexpr int kHeadings = 36;
constexpr int kSightCells = 45;

struct Cell {
  float low = HUGE_VALF;
  std::uint32_t points = 0;
  std::uint32_t obstacles = 0;
};

/// A horizontal grid of cells around the median position.
class Ground {
 public:
  explicit Ground(std::span<const Vec3f> positions) {
    set_box(positions);
    cells_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (const Vec3f p : positions) {
      if (Cell* const cell = at(p)) {
        cell->low = std::min(cell->low, p.z);
        ++cell->points;
      }
    }
    for (const Vec3f p : positions) {
      Cell* const cell = at(p);
      if (cell == nullptr) continue;
      const float above = p.z - cell->low;
      if (above > kGround_m && above < kPassage_m) ++cell->obstacles;
    }
  }

  int width() const { return width_; }
  int height() const { return height_; }
  const Cell& cell(int x, int y) const {
    return cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
  }
  bool is_inside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  bool is_open(int x, int y) const {
    if (!is_inside(x, y)) return false;
    const Cell& c = cell(x, y);
    return c.points >= kMinPoints && 20 * c.obstacles < c.points;
  }
  Vec3d middle_of(int x, int y) const {
    return {static_cast<double>(low_.x) + (x + 0.5) * static_cast<double>(kCell_m),
            static_cast<double>(low_.y) + (y + 0.5) * static_cast<double>(kCell_m),
            static_cast<double>(cell(x, y).low)};
  }

 private:
  void set_box(std::span<const Vec3f> positions) {
    std::vector<float> values(positions.size());
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    for (int axis = 0; axis < 2; ++axis) {
      float low = HUGE_VALF, high = -HUGE_VALF;
      for (std::size_t i = 0; i < positions.size(); ++i) {
        values[i] = positions[i][axis];
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
      std::nth_element(values.begin(), middle, values.end());
      constexpr float kReach_m = 0.5F * kMaxCells * kCell_m;
      low = std::max(low, *middle - kReach_m);
      high = std::min(high, *middle + kReach_m);
      low_[axis] = low;
      (axis == 0 ? width_ : height_) =
          std::clamp(static_cast<int>((high - low) / kCell_m) + 1, 1, kMaxCells);
    }
  }

  Cell* at(Vec3f p) {
    const float x = std::floor((p.x - low_.x) / kCell_m), y = std::floor((p.y - low_.y) / kCell_m);
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(width_) && y < static_cast<float>(height_)))
      return nullptr;
    return &cells_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x)];
  }

  Vec3f low_;
  int width_ = 0, height_ = 0;
  std::vector<Cell> cells_;
};

/// Sums of a value over squares of cells.
class SquareSums {
 public:
  template <class Of>
  SquareSums(const Ground& ground, Of&& of)
      : width_(ground.width()), height_(ground.height()), sums_(index(0, height_ + 1)) {
    for (int y = 0; y < height_; ++y) {
      double row = 0;
      for (int x = 0; x < width_; ++x) {
        row += of(x, y);
        sums_[index(x + 1, y + 1)] = sums_[index(x + 1, y)] + row;
      }
    }
  }
  double around(int x, int y, int reach) const {
    const int x0 = std::max(0, x - reach), x1 = std::min(width_, x + reach + 1);
    const int y0 = std::max(0, y - reach), y1 = std::min(height_, y + reach + 1);
    return sums_[index(x1, y1)] - sums_[index(x0, y1)] - sums_[index(x1, y0)] +
           sums_[index(x0, y0)];
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) +
           static_cast<std::size_t>(x);
  }
  int width_, height_;
  std::vector<double> sums_;
};

/// Number of open cells ahead, in five lanes side by side.
double openness(const Ground& ground, int x, int y, double yaw_rad) {
  double sum = 0;
  for (int side = -2; side <= 2; ++side) {
    for (int k = 1; k <= kSightCells; ++k) {
      const double u = x + 0.5 + k * std::cos(yaw_rad) - side * std::sin(yaw_rad);
      const double v = y + 0.5 + k * std::sin(yaw_rad) + side * std::cos(yaw_rad);
      if (ground.is_open(static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)))) ++sum;
    }
  }
  return sum;
}

double best_heading(const Ground& ground, int x, int y) {
  double best_rad = 0, max = -1;
  for (int k = 0; k < kHeadings; ++k) {
    const double yaw_rad = 2 * std::numbers::pi * k / kHeadings;
    // The follow camera also shows what is behind.
    const double found =
        openness(ground, x, y, yaw_rad) + 0.4 * openness(ground, x, y, yaw_rad + std::numbers::pi);
    if (found > max) {
      max = found;
      best_rad = yaw_rad;
    }
  }
  return best_rad;
}

}  // namespace

std::optional<RigidTransform> street_pose(std::span<const Vec3f> positions, double eye_height_m) {
  if (positions.empty()) return {};
  const Ground ground(positions);
  const SquareSums open(ground, [&](int x, int y) { return ground.is_open(x, y) ? 1.0 : 0.0; });
  // The square root keeps a wall scanned from near from outweighing a street.
  const SquareSums dense(ground, [&](int x, int y) { return std::sqrt(ground.cell(x, y).points); });
  double best = 0;
  int at_x = -1, at_y = -1;
  for (int y = 0; y < ground.height(); ++y) {
    for (int x = 0; x < ground.width(); ++x) {
      if (!ground.is_open(x, y)) continue;
      const double score = open.around(x, y, kOpenReach) * dense.around(x, y, kDenseReach);
      if (score <= best) continue;
      best = score;
      at_x = x;
      at_y = y;
    }
  }
  if (at_x < 0) return {};
  RigidTransform pose;
  pose.rotation = rotation_from_yaw_pitch_roll(best_heading(ground, at_x, at_y), 0, 0);
  pose.translation = ground.middle_of(at_x, at_y) + Vec3d{0, 0, eye_height_m};
  return pose;
}

}  // namespace adasplats
