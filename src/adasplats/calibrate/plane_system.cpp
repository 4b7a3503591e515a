// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/calibrate/plane_system.h"

#include <algorithm>

#include "adasplats/core/maths/small_cholesky.h"

namespace adasplats {
namespace {

constexpr std::size_t kParts = 16;        // of the sum over planes: added in their order
constexpr std::size_t kUnknownGrain = 1;  // scans or lasers of a chunk

template <std::size_t N>
double dot_of(const std::vector<std::array<double, N>>& a,
              const std::vector<std::array<double, N>>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < N; ++k) sum += a[i][k] * b[i][k];
  return sum;
}

double dot_of(const PlaneSystem::Step& a, const PlaneSystem::Step& b) {
  return dot_of(a.poses, b.poses) + dot_of(a.lasers, b.lasers);
}

/// a = a * scale + b * factor.
template <std::size_t N>
void combine(std::vector<std::array<double, N>>& a, double scale,
             const std::vector<std::array<double, N>>& b, double factor) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < N; ++k) a[i][k] = a[i][k] * scale + b[i][k] * factor;
}

void combine(PlaneSystem::Step& a, double scale, const PlaneSystem::Step& b, double factor) {
  combine(a.poses, scale, b.poses, factor);
  combine(a.lasers, scale, b.lasers, factor);
}

template <std::size_t N>
void add_to(std::array<double, N>& a, const std::array<double, N>& b) {
  for (std::size_t k = 0; k < N; ++k) a[k] += b[k];
}

}  // namespace

/// Sums of some of the planes.
struct PlaneSystem::Part {
  std::vector<Block<6>> pose_blocks;
  std::vector<Block<2>> laser_blocks;
  std::vector<Cross> crosses;
  std::vector<Entry<6>> pose_entries;
  std::vector<Entry<2>> laser_entries;
  std::vector<std::uint32_t> pose_ends, laser_ends;  ///< of the planes, in the entries
  std::vector<std::array<double, 3>> plane_rights;

  Part(std::size_t scans, std::size_t lasers)
      : pose_blocks(scans), laser_blocks(lasers), crosses(scans * lasers) {}
};

/// Sums of one plane after the other.
class PlaneSystem::PlaneSum {
 public:
  PlaneSum(Part& part, std::size_t scans, std::size_t lasers)
      : part_(part), lasers_(lasers), pose_at_(scans, kNone), laser_at_(lasers, kNone) {}

  void add(std::uint32_t plane, const std::vector<PlaneResidual>& residuals) {
    const std::size_t first_pose = part_.pose_entries.size();
    const std::size_t first_laser = part_.laser_entries.size();
    own_ = {};
    right_ = {};
    for (const PlaneResidual& residual : residuals) add_residual(plane, residual);
    const auto forget = [](auto& entries, std::size_t first, auto& at) {
      for (std::size_t e = first; e < entries.size(); ++e) at[entries[e].unknowns] = kNone;
    };
    forget(part_.pose_entries, first_pose, pose_at_);
    forget(part_.laser_entries, first_laser, laser_at_);
    whiten(first_pose, first_laser);
    part_.pose_ends.push_back(static_cast<std::uint32_t>(part_.pose_entries.size()));
    part_.laser_ends.push_back(static_cast<std::uint32_t>(part_.laser_entries.size()));
    part_.plane_rights.push_back(right_);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  template <std::size_t N>
  static Entry<N>& entry_of(std::vector<Entry<N>>& entries, std::vector<std::uint32_t>& at,
                            std::uint32_t plane, std::uint32_t unknowns) {
    std::uint32_t& place = at[unknowns];
    if (place == kNone) {
      place = static_cast<std::uint32_t>(entries.size());
      entries.push_back({plane, unknowns, {}});
    }
    return entries[place];
  }

  template <std::size_t N>
  static void add_rows(Block<N>& block, Entry<N>& entry, const std::array<double, N>& row,
                       const PlaneResidual& residual) {
    const double weight = residual.weight;
    for (std::size_t a = 0; a < N; ++a) {
      block.right[a] -= weight * row[a] * residual.residual_m;
      for (std::size_t b = 0; b < N; ++b) block.matrix[a * N + b] += weight * row[a] * row[b];
      for (std::size_t k = 0; k < 3; ++k)
        entry.values[k * N + a] -= weight * residual.by_plane[k] * row[a];
    }
  }

  void add_residual(std::uint32_t plane, const PlaneResidual& residual) {
    const double weight = residual.weight;
    for (std::size_t a = 0; a < 3; ++a) {
      right_[a] += weight * residual.by_plane[a] * residual.residual_m;
      for (std::size_t b = 0; b < 3; ++b)
        own_[a * 3 + b] += weight * residual.by_plane[a] * residual.by_plane[b];
    }
    add_rows(part_.pose_blocks[residual.scan],
             entry_of(part_.pose_entries, pose_at_, plane, residual.scan), residual.by_pose,
             residual);
    if (residual.laser == PlaneResidual::kNoLaser) return;
    add_rows(part_.laser_blocks[residual.laser],
             entry_of(part_.laser_entries, laser_at_, plane, residual.laser), residual.by_laser,
             residual);
    Cross& cross = part_.crosses[residual.scan * lasers_ + residual.laser];
    for (std::size_t a = 0; a < 6; ++a)
      for (std::size_t b = 0; b < 2; ++b)
        cross[a * 2 + b] += weight * residual.by_pose[a] * residual.by_laser[b];
  }

  /// Solves the lower half of the plane's own matrix into what stands beside it.
  void whiten(std::size_t first_pose, std::size_t first_laser) {
    for (std::size_t a = 0; a < 3; ++a) own_[a * 4] += 1e-9;
    factor<3>(own_);
    const auto solve_rows = [&](auto& entries, std::size_t first, std::size_t n) {
      for (std::size_t e = first; e < entries.size(); ++e) {
        double* const values = entries[e].values.data();
        for (std::size_t a = 0; a < 3; ++a) {
          for (std::size_t i = 0; i < n; ++i) {
            double value = values[a * n + i];
            for (std::size_t k = 0; k < a; ++k) value -= own_[a * 3 + k] * values[k * n + i];
            values[a * n + i] = value / own_[a * 4];
          }
        }
      }
    };
    solve_rows(part_.pose_entries, first_pose, 6);
    solve_rows(part_.laser_entries, first_laser, 2);
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t k = 0; k < a; ++k) right_[a] -= own_[a * 3 + k] * right_[k];
      right_[a] /= own_[a * 4];
    }
  }

  Part& part_;
  std::size_t lasers_;
  std::vector<std::uint32_t> pose_at_, laser_at_;  ///< entries of the plane in hand
  std::array<double, 9> own_{};
  std::array<double, 3> right_{};
};

PlaneSystem::PlaneSystem(std::size_t scans, std::size_t lasers, const Executor& executor)
    : executor_(executor),
      scans_(scans),
      lasers_(lasers),
      pose_blocks_(scans),
      laser_blocks_(lasers),
      crosses_(scans * lasers) {}

template <std::size_t N>
void PlaneSystem::index(Entries<N>& entries, std::size_t unknowns) {
  entries.begins.assign(unknowns + 1, 0);
  for (const Entry<N>& entry : entries.all) ++entries.begins[entry.unknowns + 1];
  for (std::size_t u = 0; u < unknowns; ++u) entries.begins[u + 1] += entries.begins[u];
  std::vector<std::uint32_t> next(entries.begins.begin(), entries.begins.end() - 1);
  entries.of_unknowns.resize(entries.all.size());
  for (std::size_t e = 0; e < entries.all.size(); ++e)
    entries.of_unknowns[next[entries.all[e].unknowns]++] = static_cast<std::uint32_t>(e);
}

void PlaneSystem::add_planes(std::size_t count, ResidualsOf residuals_of) {
  planes_ = count;
  const std::size_t of_part = std::max<std::size_t>(1, (count + kParts - 1) / kParts);
  std::vector<Part> parts;
  for (std::size_t begin = 0; begin < count; begin += of_part) parts.emplace_back(scans_, lasers_);
  executor_.for_chunks(count, of_part, [&](std::size_t begin, std::size_t end) {
    Part& part = parts[begin / of_part];
    PlaneSum sum(part, scans_, lasers_);
    std::vector<PlaneResidual> residuals;
    for (std::size_t plane = begin; plane < end; ++plane) {
      residuals.clear();
      residuals_of(plane, residuals);
      sum.add(static_cast<std::uint32_t>(plane), residuals);
    }
  });
  pose_entries_.plane_begins.push_back(0);
  laser_entries_.plane_begins.push_back(0);
  for (Part& part : parts) {
    const auto take = [&](auto& entries, auto& own, const std::vector<std::uint32_t>& ends) {
      const auto shift = static_cast<std::uint32_t>(entries.all.size());
      for (const std::uint32_t end : ends) entries.plane_begins.push_back(shift + end);
      entries.all.insert(entries.all.end(), own.begin(), own.end());
      own = {};
    };
    take(pose_entries_, part.pose_entries, part.pose_ends);
    take(laser_entries_, part.laser_entries, part.laser_ends);
    const auto add_blocks = [](auto& blocks, const auto& own) {
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        add_to(blocks[i].matrix, own[i].matrix);
        add_to(blocks[i].right, own[i].right);
      }
    };
    add_blocks(pose_blocks_, part.pose_blocks);
    add_blocks(laser_blocks_, part.laser_blocks);
    for (std::size_t i = 0; i < crosses_.size(); ++i) add_to(crosses_[i], part.crosses[i]);
    plane_rights_.insert(plane_rights_.end(), part.plane_rights.begin(), part.plane_rights.end());
  }
  index(pose_entries_, scans_);
  index(laser_entries_, lasers_);
}

void PlaneSystem::add_pose_prior(std::size_t scan, std::size_t unknown, double weight,
                                 double value) {
  pose_blocks_[scan].matrix[unknown * 7] += weight;
  pose_blocks_[scan].right[unknown] += weight * value;
}

void PlaneSystem::add_laser_prior(std::size_t laser, std::size_t unknown, double weight,
                                  double share, double value) {
  weight += share * laser_blocks_[laser].matrix[unknown * 3];
  laser_blocks_[laser].matrix[unknown * 3] += weight;
  laser_blocks_[laser].right[unknown] += weight * value;
}

namespace {

/// Of one scan or laser: what the planes take away of its own block, and of its right side.
template <std::size_t N, class Entries, class Rights>
void subtract_planes(std::size_t unknowns, const Entries& entries, const Rights& rights,
                     std::array<double, N * N>& matrix, std::array<double, N>& right) {
  for (std::uint32_t k = entries.begins[unknowns]; k < entries.begins[unknowns + 1]; ++k) {
    const auto& entry = entries.all[entries.of_unknowns[k]];
    const std::array<double, 3>& of_plane = rights[entry.plane];
    for (std::size_t r = 0; r < 3; ++r) {
      const double* const row = entry.values.data() + r * N;
      for (std::size_t a = 0; a < N; ++a) {
        right[a] -= row[a] * of_plane[r];
        for (std::size_t b = 0; b < N; ++b) matrix[a * N + b] -= row[a] * row[b];
      }
    }
  }
}

template <std::size_t N>
void add_product(std::array<double, N>& y, const std::array<double, N * N>& matrix,
                 const std::array<double, N>& x) {
  for (std::size_t a = 0; a < N; ++a)
    for (std::size_t b = 0; b < N; ++b) y[a] += matrix[a * N + b] * x[b];
}

}  // namespace

PlaneSystem::Step PlaneSystem::times(const Step& x) const {
  std::vector<std::array<double, 3>> of_planes(planes_);
  executor_.for_chunks(planes_, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t plane = begin; plane < end; ++plane) {
      std::array<double, 3> sum{};
      const auto add_entries = [&](const auto& entries, const auto& values) {
        for (std::uint32_t e = entries.plane_begins[plane]; e < entries.plane_begins[plane + 1];
             ++e) {
          const auto& entry = entries.all[e];
          const auto& of_entry = values[entry.unknowns];
          for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t a = 0; a < of_entry.size(); ++a)
              sum[r] += entry.values[r * of_entry.size() + a] * of_entry[a];
        }
      };
      add_entries(pose_entries_, x.poses);
      add_entries(laser_entries_, x.lasers);
      of_planes[plane] = sum;
    }
  });
  Step y{std::vector<PoseStep>(scans_), std::vector<LaserStep>(lasers_)};
  const auto subtract = [&](std::size_t unknowns, const auto& entries, auto& of_unknowns) {
    for (std::uint32_t k = entries.begins[unknowns]; k < entries.begins[unknowns + 1]; ++k) {
      const auto& entry = entries.all[entries.of_unknowns[k]];
      const std::array<double, 3>& z = of_planes[entry.plane];
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t a = 0; a < of_unknowns.size(); ++a)
          of_unknowns[a] -= entry.values[r * of_unknowns.size() + a] * z[r];
    }
  };
  executor_.for_chunks(scans_, kUnknownGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t scan = begin; scan < end; ++scan) {
      PoseStep& own = y.poses[scan];
      add_product(own, pose_blocks_[scan].matrix, x.poses[scan]);
      for (std::size_t laser = 0; laser < lasers_; ++laser) {
        const Cross& cross = crosses_[scan * lasers_ + laser];
        for (std::size_t a = 0; a < 6; ++a)
          own[a] += cross[a * 2] * x.lasers[laser][0] + cross[a * 2 + 1] * x.lasers[laser][1];
      }
      subtract(scan, pose_entries_, own);
    }
  });
  executor_.for_chunks(lasers_, kUnknownGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t laser = begin; laser < end; ++laser) {
      LaserStep& own = y.lasers[laser];
      add_product(own, laser_blocks_[laser].matrix, x.lasers[laser]);
      for (std::size_t scan = 0; scan < scans_; ++scan) {
        const Cross& cross = crosses_[scan * lasers_ + laser];
        for (std::size_t a = 0; a < 6; ++a)
          for (std::size_t b = 0; b < 2; ++b) own[b] += cross[a * 2 + b] * x.poses[scan][a];
      }
      subtract(laser, laser_entries_, own);
    }
  });
  return y;
}

PlaneSystem::Step PlaneSystem::solve(double tolerance, int most_iterations) const {
  Step residual{std::vector<PoseStep>(scans_), std::vector<LaserStep>(lasers_)};
  std::vector<Block<6>> poses = pose_blocks_;
  std::vector<Block<2>> lasers = laser_blocks_;
  const auto reduce = [&](auto& blocks, const auto& entries, auto& rights) {
    executor_.for_chunks(blocks.size(), kUnknownGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t u = begin; u < end; ++u) {
        subtract_planes(u, entries, plane_rights_, blocks[u].matrix, blocks[u].right);
        rights[u] = blocks[u].right;
      }
    });
  };
  reduce(poses, pose_entries_, residual.poses);
  reduce(lasers, laser_entries_, residual.lasers);
  for (Block<6>& block : poses) factor<6>(block.matrix);
  for (Block<2>& block : lasers) factor<2>(block.matrix);
  const auto preconditioned = [&](const Step& r) {
    Step z = r;
    for (std::size_t s = 0; s < scans_; ++s) z.poses[s] = solved<6>(poses[s].matrix, r.poses[s]);
    for (std::size_t l = 0; l < lasers_; ++l)
      z.lasers[l] = solved<2>(lasers[l].matrix, r.lasers[l]);
    return z;
  };
  Step x{std::vector<PoseStep>(scans_), std::vector<LaserStep>(lasers_)};
  Step z = preconditioned(residual), direction = z;
  double energy = dot_of(residual, z);
  const double enough = tolerance * tolerance * energy;
  for (int k = 0; k < most_iterations && energy > enough; ++k) {
    const Step product = times(direction);
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
