// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/ray_drop.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/core/maths/median.h"

namespace adasplats {
namespace {

constexpr std::size_t kN = kDropFeatures;
using Row = std::array<double, kN>;

double logistic(double x) { return 1 / (1 + std::exp(-x)); }

double product(const Row& a, const Row& b) {
  double sum = 0;
  for (std::size_t k = 0; k < kN; ++k) sum += a[k] * b[k];
  return sum;
}

/// Gradient and Hessian of the penalised negative log-likelihood.
struct Likelihood {
  Row gradient = {};
  std::array<Row, kN> hessian = {};

  /// A weak prior at zero: fixes the weight of a feature that does not vary (one reflectance).
  void add_penalty(const Row& weights) {
    constexpr double kPenalty = 1e-3;
    for (std::size_t k = 0; k < kN; ++k) {
      gradient[k] += kPenalty * weights[k];
      hessian[k][k] += kPenalty;
    }
  }
  void add(const Row& features, double expected, double found) {
    const double spread = expected * (1 - expected);
    for (std::size_t k = 0; k < kN; ++k) {
      gradient[k] += (expected - found) * features[k];
      for (std::size_t j = 0; j <= k; ++j) hessian[k][j] += spread * features[k] * features[j];
    }
  }
  double value = 0;
};

/// x of hessian * x = gradient by Cholesky's decomposition of the lower half.
Row newton_step(const Likelihood& at) {
  std::array<Row, kN> root = at.hessian;
  Row x = at.gradient;
  for (std::size_t k = 0; k < kN; ++k) {
    for (std::size_t j = 0; j <= k; ++j) {
      double sum = root[k][j];
      for (std::size_t i = 0; i < j; ++i) sum -= root[k][i] * root[j][i];
      root[k][j] = k == j ? std::sqrt(std::max(sum, 1e-12)) : sum / root[j][j];
    }
    for (std::size_t j = 0; j < k; ++j) x[k] -= root[k][j] * x[j];
    x[k] /= root[k][k];
  }
  for (std::size_t k = kN; k-- > 0;) {
    for (std::size_t j = k + 1; j < kN; ++j) x[k] -= root[j][k] * x[j];
    x[k] /= root[k][k];
  }
  return x;
}

Row row_of(const EchoConditions& echo, double usual_reflectance) {
  const DropFeatures features = drop_features(
      drop_conditions(echo.range_m, echo.cos_incidence, echo.reflectance, usual_reflectance));
  Row row{};
  std::copy_n(features.of, kN, row.begin());
  return row;
}

double usual_reflectance_of(std::span<const EchoConditions> echoes, double otherwise) {
  std::vector<float> known;
  for (const EchoConditions& echo : echoes) {
    if (std::isfinite(echo.reflectance)) known.push_back(echo.reflectance);
  }
  if (known.empty()) return otherwise;
  return static_cast<double>(upper_median_of(known));
}

void check_sizes(std::size_t echoes, std::size_t others) {
  if (echoes != others) throw std::logic_error("ray drop: expected one value per echo");
}

/// Negative log-likelihood of the observations, and its derivatives.
Likelihood likelihood_of(std::span<const Row> rows, std::span<const EchoConditions> echoes,
                         std::span<const std::uint8_t> dropped, const Row& weights) {
  Likelihood sum;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double x = product(weights, rows[i]) + static_cast<double>(echoes[i].drop_log_odds);
    sum.add(rows[i], logistic(x), dropped[i] != 0 ? 1.0 : 0.0);
    // log(1 + exp(x)) without overflow
    sum.value += std::max(x, 0.0) + std::log1p(std::exp(-std::fabs(x))) - (dropped[i] != 0 ? x : 0);
  }
  sum.add_penalty(weights);
  return sum;
}

double elevation_rad(Vec3f direction) {
  return std::atan2(static_cast<double>(direction.z),
                    std::hypot(static_cast<double>(direction.x), static_cast<double>(direction.y)));
}

double azimuth_rad(Vec3f direction) {
  return std::atan2(static_cast<double>(direction.y), static_cast<double>(direction.x));
}

bool is_known(Vec3f direction) { return !(direction == Vec3f{}); }

constexpr int kSectors = 360;

/// Observations of one sector from one sensor position.
struct SectorCount {
  std::uint32_t echoes = 0;
  std::uint32_t dropped = 0;
};

/// The sectors of one ring, by sensor position.
struct RingSectors {
  std::array<std::map<std::uint32_t, SectorCount>, kSectors> sectors;
  double elevations_deg = 0, echoes = 0;  // sum, count

  void add_elevation(double one_deg) {
    elevations_deg += one_deg;
    ++echoes;
  }
  float elevation_rad() const {
    return static_cast<float>(std::round(elevations_deg / echoes * 1e4) / 1e4 * kDegree);
  }
};

bool is_blocked(const std::map<std::uint32_t, SectorCount>& places) {
  std::size_t blocked = 0;
  for (const auto& [place, count] : places) blocked += 2 * count.dropped > count.echoes ? 1 : 0;
  return blocked >= kMinBlockedPlaces && 4 * blocked >= 3 * places.size();
}

/// Blocked sectors, neighbours joined.
void add_blocked(const RingSectors& ring, std::vector<BlockedSector>& blocked) {
  const auto edge_rad = [](int k) {
    return static_cast<float>((2.0 * k / kSectors - 1) * std::numbers::pi);
  };
  bool goes_on = false;
  for (int sector = 0; sector < kSectors; ++sector) {
    const bool found = is_blocked(ring.sectors[static_cast<std::size_t>(sector)]);
    if (found && goes_on)
      blocked.back().azimuth_end_rad = edge_rad(sector + 1);
    else if (found)
      blocked.push_back({ring.elevation_rad(), edge_rad(sector), edge_rad(sector + 1)});
    goes_on = found;
  }
}

}  // namespace

DropRules drop_rules(const RayDropModel& model) {
  DropRules rules;
  rules.on = true;
  rules.usual_reflectance = model.usual_reflectance;
  std::copy_n(model.weights.begin(), kN, rules.weights);
  rules.edges.on = !model.edge_runs.empty();
  std::copy_n(model.edge_runs.begin(), std::min<std::size_t>(model.edge_runs.size(), kMaxEdgeRun),
              rules.edges.shares);
  return rules;
}

double drop_probability(const RayDropModel& model, const EchoConditions& echo) {
  if (model.blocks(echo.direction)) return 1;
  return drop_chance(drop_rules(model), echo.range_m, echo.cos_incidence, echo.reflectance,
                     echo.drop_log_odds);
}

RayDropModel fit_ray_drop(std::span<const EchoConditions> echoes,
                          std::span<const std::uint8_t> dropped) {
  constexpr std::ptrdiff_t kLeast = 100;
  check_sizes(echoes.size(), dropped.size());
  const std::ptrdiff_t reported = std::count(dropped.begin(), dropped.end(), std::uint8_t{0});
  const std::ptrdiff_t lost = static_cast<std::ptrdiff_t>(dropped.size()) - reported;
  if (reported < kLeast || lost < kLeast) {
    throw Error(ErrorKind::data, std::to_string(reported) + " beams came back and " +
                                     std::to_string(lost) + " did not, expected at least " +
                                     std::to_string(kLeast) + " of each to fit a ray drop");
  }
  RayDropModel model;
  model.usual_reflectance = usual_reflectance_of(echoes, model.usual_reflectance);
  std::vector<Row> rows;
  rows.reserve(echoes.size());
  for (const EchoConditions& echo : echoes) rows.push_back(row_of(echo, model.usual_reflectance));
  // Starts from the share of drops, close enough for Newton's method; steps that overshoot are
  // halved.
  model.weights[0] = std::log(static_cast<double>(lost) / static_cast<double>(reported));
  Likelihood at = likelihood_of(rows, echoes, dropped, model.weights);
  constexpr int kMaxSteps = 50, kMaxHalvings = 20;
  for (int step = 0; step < kMaxSteps; ++step) {
    Row change = newton_step(at);
    const Row from = model.weights;
    const double before = at.value;
    for (int halving = 0; halving < kMaxHalvings; ++halving) {
      for (std::size_t k = 0; k < kN; ++k) model.weights[k] = from[k] - change[k];
      at = likelihood_of(rows, echoes, dropped, model.weights);
      if (at.value <= before) break;
      for (double& part : change) part /= 2;
    }
    if (before - at.value < 1e-9 * before) break;
  }
  return model;
}

std::vector<BlockedSector> find_blocked_sectors(std::span<const EchoConditions> echoes,
                                                std::span<const std::uint8_t> dropped,
                                                std::span<const std::uint32_t> places,
                                                std::span<const std::uint16_t> rings) {
  check_sizes(echoes.size(), dropped.size());
  check_sizes(echoes.size(), places.size());
  if (!rings.empty()) check_sizes(echoes.size(), rings.size());
  std::map<std::int64_t, RingSectors> by_ring;  // by ring or by hundredths of a degree
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const Vec3f direction = echoes[i].direction;
    if (!is_known(direction) || !is_finite(direction)) continue;
    const double elevation_deg = elevation_rad(direction) / kDegree;
    RingSectors& of_ring = by_ring[rings.empty() ? std::llround(elevation_deg * 100) : rings[i]];
    of_ring.add_elevation(rings.empty() ? std::round(elevation_deg * 100) / 100 : elevation_deg);
    const double turn = azimuth_rad(direction) / (2 * std::numbers::pi) + 0.5;
    const auto sector = std::min(static_cast<int>(turn * kSectors), kSectors - 1);
    SectorCount& count = of_ring.sectors[static_cast<std::size_t>(sector)][places[i]];
    ++count.echoes;
    count.dropped += dropped[i] != 0 ? 1 : 0;
  }
  std::vector<BlockedSector> blocked;
  for (const auto& [ring, of_ring] : by_ring) add_blocked(of_ring, blocked);
  std::ranges::stable_sort(blocked, {}, &BlockedSector::elevation_rad);
  return blocked;
}

}  // namespace adasplats
