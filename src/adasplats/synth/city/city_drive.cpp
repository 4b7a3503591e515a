// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/city/city_drive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace adasplats {
namespace {

constexpr double kSample_m = 0.25;
constexpr double kRightRadius_m = 4, kLeftRadius_m = 8;
constexpr double kChange_m = 12;        // length of a lane change, before and after a crossing
constexpr double kBlocksOfDrive = 0.3;  // side of the square of blocks per driven block
constexpr double kBlock_m = 160;        // mean length
constexpr double kStraightOn = 3;       // weight of going straight on, relative to a turn

/// East, north, west, south.
constexpr std::array<std::pair<int, int>, 4> kHeadings = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

struct Node {
  int i = 0, j = 0;
};

/// One block of a drive: from a node in one direction.
struct Leg {
  Node from;
  int heading = 0;

  Node to() const {
    return {from.i + kHeadings[heading].first, from.j + kHeadings[heading].second};
  }
  bool along_east() const { return heading % 2 == 0; }
  bool forth() const { return heading < 2; }
  CitySectionId street() const {
    const Node end = to();
    if (along_east()) return {CityAxis::east, from.j, std::min(from.i, end.i)};
    return {CityAxis::north, from.i, std::min(from.j, end.j)};
  }
};

/// A random walk over nodes 0 to `side` of both axes with at least `legs` legs.
std::vector<Leg> draw_legs(const CityGrid& grid, std::size_t legs) {
  const int side = std::max(
      2, static_cast<int>(std::ceil(std::sqrt(kBlocksOfDrive * static_cast<double>(legs)))));
  Random random = random_of(grid, CityPurpose::drive, 0, 0);
  std::map<CitySectionId, int> passes;
  std::vector<Leg> walk = {{{side / 2, side / 2}, 0}};
  while (walk.size() < legs) {
    ++passes[walk.back().street()];
    const Node here = walk.back().to();
    std::array<double, 4> weights{};
    double all = 0;
    for (int turn : {0, 1, 3}) {
      const Leg next = {here, (walk.back().heading + turn) % 4};
      const Node end = next.to();
      if (end.i < 0 || end.j < 0 || end.i > side || end.j > side) continue;
      const auto found = passes.find(next.street());
      const double times = found == passes.end() ? 0 : found->second;
      all += weights[next.heading] = (turn == 0 ? kStraightOn : 1) / (1 + 3 * times);
    }
    double draw = random.uniform() * all;
    int heading = 0;
    for (int k = 0; k < 4; ++k) {
      if (weights[k] <= 0) continue;
      heading = k;
      draw -= weights[k];
      if (draw < 0) break;
    }
    walk.push_back({here, heading});
  }
  return walk;
}

/// The driven line of a leg: u or v of the center of its rightmost lane.
class LegLine {
 public:
  LegLine(const CityGrid& grid, const Leg& leg) : leg_(leg) {
    const WorldStyle style = grid.style(leg.street());
    const double off = style.median + (style.lanes - 0.5) * style.lane_width;
    // Right of east is south; right of north is east.
    const double sign = leg.along_east() == leg.forth() ? -1 : 1;
    const double axis = leg.along_east() ? grid.node(CityAxis::north, leg.from.j)
                                         : grid.node(CityAxis::east, leg.from.i);
    across_ = axis + sign * off;
    const auto along = [&](const Node& node) {
      return leg.along_east() ? grid.node(CityAxis::east, node.i)
                              : grid.node(CityAxis::north, node.j);
    };
    begin_ = along(leg.from);
    end_ = along(leg.to());
  }

  double across() const { return across_; }
  double begin() const { return begin_; }
  double end() const { return end_; }
  double direction() const { return leg_.forth() ? 1 : -1; }
  Vec3d at(double along, double across) const {
    return leg_.along_east() ? Vec3d{along, across, 0} : Vec3d{across, along, 0};
  }
  Vec3d heading() const { return at(direction(), 0); }

 private:
  Leg leg_;
  double across_ = 0, begin_ = 0, end_ = 0;
};

/// The transition from one leg to the next.
struct Joint {
  bool turns = false;
  double end = 0, begin = 0;  ///< end position along this leg, begin position along the next
  Vec3d center;               ///< of the turn
  double radius = 0, from_rad = 0, sweep_rad = 0;
};

Joint joint_of(const LegLine& one, const LegLine& next, int turn) {
  if (turn == 0) return {.end = one.end(), .begin = next.begin()};
  const double radius = turn == 1 ? kLeftRadius_m : kRightRadius_m;
  Joint joint = {.turns = true, .radius = radius};
  // The lines meet where `along` of one equals `across` of the other.
  joint.end = next.across() - one.direction() * radius;
  joint.begin = one.across() + next.direction() * radius;
  const Vec3d meet = one.at(next.across(), one.across());
  joint.center = meet + radius * (next.heading() - one.heading());
  const Vec3d start = one.at(joint.end, one.across()) - joint.center;
  joint.from_rad = std::atan2(start.y, start.x);
  joint.sweep_rad = (turn == 1 ? 0.5 : -0.5) * std::numbers::pi;
  return joint;
}

}  // namespace

CityDrive::CityDrive(const CityGrid& grid, double length_m)
    : land_(grid.land()), length_m_(length_m) {
  const std::size_t blocks = 4 + static_cast<std::size_t>(1.2 * length_m / kBlock_m);
  const std::vector<Leg> legs = draw_legs(grid, blocks);
  LegLine line(grid, legs[0]);
  double begin = line.begin() + line.direction() * 30;
  double before = line.across();  // of the lane on the previous leg
  for (std::size_t k = 0; k + 1 < legs.size(); ++k) {
    const LegLine next(grid, legs[k + 1]);
    const Joint joint = joint_of(line, next, (legs[k + 1].heading - legs[k].heading + 4) % 4);
    const double direction = line.direction();
    const double after = joint.turns ? line.across() : next.across();
    const auto mix = [](double a, double b, double past) {
      const double t = std::clamp((past + kChange_m) / (2 * kChange_m), 0.0, 1.0);
      return a + (b - a) * t * t * (3 - 2 * t);
    };
    for (double s = begin; direction * (joint.end - s) > 0; s += direction * kSample_m) {
      const double past = direction * (s - line.begin());
      const double left = direction * (line.end() - s);
      double across = mix(before, line.across(), past);
      if (left < kChange_m) across = mix(line.across(), after, -left);
      const Vec3d position = line.at(s, across);
      append(grid.land(), position.x, position.y);
    }
    if (joint.turns) {
      const int steps =
          static_cast<int>(std::ceil(std::fabs(joint.sweep_rad) * joint.radius / kSample_m));
      for (int step = 0; step < steps; ++step) {
        const double angle = joint.from_rad + joint.sweep_rad * step / steps;
        append(grid.land(), joint.center.x + joint.radius * std::cos(angle),
               joint.center.y + joint.radius * std::sin(angle));
      }
    }
    before = joint.turns ? next.across() : line.across();
    line = next;
    begin = joint.begin;
    if (samples_.back().travelled_m > length_m + 2) break;
  }
}

void CityDrive::append(const CityLand& land, double u, double v) {
  Sample sample = {u, v, 0};
  if (!samples_.empty()) {
    const Sample& last = samples_.back();
    sample.travelled_m = last.travelled_m + length(land.at(u, v) - land.at(last.u, last.v));
  }
  samples_.push_back(sample);
}

Vec3d CityDrive::grid_position(double travelled_m) const {
  const auto next = std::ranges::upper_bound(samples_, travelled_m, {}, &Sample::travelled_m);
  if (next == samples_.begin()) return {samples_.front().u, samples_.front().v, 0};
  if (next == samples_.end()) return {samples_.back().u, samples_.back().v, 0};
  const Sample& one = *(next - 1);
  const double share = (travelled_m - one.travelled_m) / (next->travelled_m - one.travelled_m);
  return {one.u + share * (next->u - one.u), one.v + share * (next->v - one.v), 0};
}

Vec3d CityDrive::world_position(double travelled_m) const {
  const Vec3d position = grid_position(travelled_m);
  return land_.at(position.x, position.y);
}

TimedPose CityDrive::at(double travelled_m) const {
  const double here = std::clamp(travelled_m, 0.0, length_m_);
  const Vec3d ahead = world_position(here + 0.5) - world_position(here - 0.5);
  const double pitch = -std::atan2(ahead.z, std::hypot(ahead.x, ahead.y));
  return {
      here / kCityDriveSpeed_m_per_s,
      {rotation_from_yaw_pitch_roll(std::atan2(ahead.y, ahead.x), pitch, 0), world_position(here)}};
}

}  // namespace adasplats
