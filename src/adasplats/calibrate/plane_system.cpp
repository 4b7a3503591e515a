// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/plane_system.h"

#include <algorithm>
#include <array>

#include "adasplats/core/maths/small_matrix.h"

namespace adasplats {
namespace {

double dot_of(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double dot_of(const PlaneStep& a, const PlaneStep& b) {
  return dot_of(a.poses, b.poses) + dot_of(a.lasers, b.lasers);
}

/// a = a * scale + b * factor.
void combine(std::vector<double>& a, double scale, const std::vector<double>& b, double factor) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = a[i] * scale + b[i] * factor;
}

void combine(PlaneStep& a, double scale, const PlaneStep& b, double factor) {
  combine(a.poses, scale, b.poses, factor);
  combine(a.lasers, scale, b.lasers, factor);
}

template <std::size_t N>
void add_full(const std::vector<UnknownsBlock<N>>& blocks, const std::vector<double>& x,
              std::vector<double>& y) {
  for (std::size_t u = 0; u < blocks.size(); ++u)
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t b = 0; b < N; ++b) y[u * N + a] += blocks[u].full[a * N + b] * x[u * N + b];
}

/// The factored reduced blocks: a block Jacobi preconditioner.
template <std::size_t N>
class Preconditioner {
 public:
  explicit Preconditioner(const std::vector<UnknownsBlock<N>>& blocks) : factors_(blocks.size()) {
    for (std::size_t u = 0; u < blocks.size(); ++u) {
      std::copy_n(blocks[u].reduced, N * N, factors_[u].begin());
      factor<N>(factors_[u]);
    }
  }

  std::vector<double> operator()(const std::vector<double>& r) const {
    std::vector<double> z(r.size());
    for (std::size_t u = 0; u < factors_.size(); ++u) {
      std::array<double, N> of_block{};
      std::copy_n(r.data() + u * N, N, of_block.begin());
      of_block = solved<N>(factors_[u], of_block);
      std::copy_n(of_block.begin(), N, z.data() + u * N);
    }
    return z;
  }

 private:
  std::vector<std::array<double, N * N>> factors_;
};

template <std::size_t N>
std::vector<double> rights_of(const std::vector<UnknownsBlock<N>>& blocks) {
  std::vector<double> rights;
  rights.reserve(blocks.size() * N);
  for (const UnknownsBlock<N>& block : blocks)
    rights.insert(rights.end(), block.right, block.right + N);
  return rights;
}

template <std::size_t N>
void add_prior(UnknownsBlock<N>& block, std::size_t unknown, double weight, double value) {
  block.full[unknown * (N + 1)] += weight;
  block.reduced[unknown * (N + 1)] += weight;
  block.right[unknown] += weight * value;
}

}  // namespace

void PlaneSystem::add_pose_prior(std::size_t scan, std::size_t unknown, double weight,
                                 double value) {
  add_prior(blocks_.poses[scan], unknown, weight, value);
}

void PlaneSystem::add_laser_prior(std::size_t laser, std::size_t unknown, double weight,
                                  double share, double value) {
  LaserBlock& block = blocks_.lasers[laser];
  add_prior(block, unknown, weight + share * block.full[unknown * (kLaserUnknowns + 1)], value);
}

double PlaneSystem::pulled_mean(const std::vector<double>& values, std::size_t stride) const {
  double sum = 0, weight = 0;
  for (std::size_t laser = 0; laser < pulls_.size(); ++laser) {
    sum += pulls_[laser] * values[laser * stride];
    weight += pulls_[laser];
  }
  return weight > 0 ? sum / weight : 0;
}

void PlaneSystem::pull_ranges_to_mean(double share, const std::vector<double>& ranges_m) {
  for (const LaserBlock& block : blocks_.lasers) pulls_.push_back(share * block.full[0]);
  const double mean_m = pulled_mean(ranges_m, 1);
  for (std::size_t laser = 0; laser < pulls_.size(); ++laser)
    add_prior(blocks_.lasers[laser], 0, pulls_[laser], mean_m - ranges_m[laser]);
}

PlaneStep PlaneSystem::solve(double tolerance, int max_iterations, PlaneProduct coupled) const {
  const Preconditioner<6> of_poses(blocks_.poses);
  const Preconditioner<kLaserUnknowns> of_lasers(blocks_.lasers);
  const auto preconditioned = [&](const PlaneStep& r) {
    return PlaneStep{of_poses(r.poses), of_lasers(r.lasers)};
  };
  PlaneStep residual{rights_of(blocks_.poses), rights_of(blocks_.lasers)};
  PlaneStep x{std::vector<double>(residual.poses.size()),
              std::vector<double>(residual.lasers.size())};
  PlaneStep z = preconditioned(residual), direction = z;
  double energy = dot_of(residual, z);
  const double enough = tolerance * tolerance * energy;
  for (int k = 0; k < max_iterations && energy > enough; ++k) {
    PlaneStep product = coupled(direction);
    const double mean = pulled_mean(direction.lasers, kLaserUnknowns);
    for (std::size_t laser = 0; laser < pulls_.size(); ++laser)
      product.lasers[laser * kLaserUnknowns] -= pulls_[laser] * mean;
    add_full(blocks_.poses, direction.poses, product.poses);
    add_full(blocks_.lasers, direction.lasers, product.lasers);
    const double curvature = dot_of(direction, product);
    if (!(curvature > 0)) break;
    const double length = energy / curvature;
    combine(x, 1, direction, length);
    combine(residual, 1, product, -length);
    z = preconditioned(residual);
    const double next = dot_of(residual, z);
    combine(direction, next / energy, z, 1);
    energy = next;
  }
  return x;
}

}  // namespace adasplats
