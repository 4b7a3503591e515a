// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "adasplats/calibrate/cell_steps.h"
#include "adasplats/calibrate/plane_system.h"
#include "adasplats/calibrate/row_steps.h"
#include "adasplats/core/host_device.h"

namespace adasplats {

// Sums of rows over planes, scans and lasers. The derivative of a row by its plane is q = (1, u,
// v); by its scan it is B q, and the 6x3 matrix B is the same for all rows of a plane and a scan.
// So an entry (one plane and one scan) needs only the moments of q.

/// Entries: the rows of one plane and one scan or laser.
struct EntriesView {
  const std::uint64_t* keys;  ///< plane << bits | scan or laser, ascending
  std::size_t count;
  int bits;
  const std::uint32_t* begins;        ///< of the rows
  const std::uint32_t* plane_begins;  ///< of the entries; number of planes + 1
  const std::uint32_t* by_unknown;    ///< the entries, scan by scan or laser by laser

  ADASPLATS_HD std::size_t plane_of(std::size_t e) const { return keys[e] >> bits; }
  ADASPLATS_HD std::size_t unknown_of(std::size_t e) const {
    return keys[e] & ((std::uint64_t{1} << bits) - 1);
  }
};

/// A chunk of the entries of one scan or laser; sums add the chunks in order.
struct EntryChunk {
  std::uint32_t unknown, begin, end;  ///< in EntriesView::by_unknown
};

/// Lower bound of i << bits in `count` sorted keys.
struct FindFirst {
  const std::uint64_t* keys;
  std::uint32_t count;
  int bits;
  std::uint32_t* begins;

  ADASPLATS_HD void operator()(std::size_t i) const {
    begins[i] = first_not_less(keys, 0, count, std::uint64_t{i} << bits);
  }
};

struct KeyOfUnknown {
  EntriesView entries;
  std::uint64_t* keys;

  ADASPLATS_HD void operator()(std::size_t e) const { keys[e] = entries.unknown_of(e); }
};

/// Keys of rows by plane and laser, and by scan and laser; rows without a laser come last.
struct KeyOfLaser {
  const std::uint64_t* keys;  ///< by plane and scan
  int scan_bits;
  const std::uint32_t* points;
  const std::uint32_t* indices;
  const std::uint16_t* lasers;  ///< of the cloud
  std::size_t scans, laser_count;
  int laser_bits;
  std::uint64_t* by_plane;
  std::uint64_t* by_scan;

  ADASPLATS_HD void operator()(std::size_t r) const {
    const std::size_t known = lasers[indices[points[r]]];
    const std::size_t laser = known < laser_count ? known : laser_count;
    by_plane[r] = keys[r] >> scan_bits << laser_bits | laser;
    const std::uint64_t scan = keys[r] & ((std::uint64_t{1} << scan_bits) - 1);
    by_scan[r] = laser < laser_count ? scan * laser_count + laser : scans * laser_count;
  }
};

/// Weighted moments of q, upper triangle by rows, and of q times the residual.
struct PoseMoments {
  double matrix[6];
  double right[3];
};

struct SumPoseEntry {
  EntriesView entries;
  const PlaneRow* rows;
  std::size_t row_count;
  PoseMoments* moments;

  ADASPLATS_HD void operator()(std::size_t e) const {
    const std::size_t end = e + 1 < entries.count ? entries.begins[e + 1] : row_count;
    PoseMoments m{};
    for (std::size_t r = entries.begins[e]; r < end; ++r) {
      const PlaneRow row = rows[r];
      const double weighted_u = row.weight * row.u_m, weighted_v = row.weight * row.v_m;
      m.matrix[0] += row.weight;
      m.matrix[1] += weighted_u;
      m.matrix[2] += weighted_v;
      m.matrix[3] += weighted_u * row.u_m;
      m.matrix[4] += weighted_u * row.v_m;
      m.matrix[5] += weighted_v * row.v_m;
      m.right[0] += row.weight * row.residual_m;
      m.right[1] += weighted_u * row.residual_m;
      m.right[2] += weighted_v * row.residual_m;
    }
    moments[e] = m;
  }
};

/// A plane's own matrix, factored: L L^T, lower triangle by rows.
struct PlaneFactor {
  double lower[6];
  double right[3];  ///< whitened
  double scale;     ///< of the weights of its rows

  /// Solves L v = (x, y, z) in place.
  ADASPLATS_HD void whiten(double& x, double& y, double& z) const {
    x = x / lower[0];
    y = (y - lower[1] * x) / lower[2];
    z = (z - lower[3] * x - lower[4] * y) / lower[5];
  }
};

struct FactorPlane {
  static constexpr std::size_t kGrain = 256;

  EntriesView entries;
  const PoseMoments* moments;
  double max_weight;
  PlaneFactor* factors;

  ADASPLATS_HD void operator()(std::size_t plane) const {
    PoseMoments sum{};
    for (std::uint32_t e = entries.plane_begins[plane]; e < entries.plane_begins[plane + 1]; ++e) {
      for (int k = 0; k < 6; ++k) sum.matrix[k] += moments[e].matrix[k];
      for (int k = 0; k < 3; ++k) sum.right[k] += moments[e].right[k];
    }
    PlaneFactor factor{};
    factor.scale = sum.matrix[0] > max_weight ? max_weight / sum.matrix[0] : 1;
    double own[6];
    for (int k = 0; k < 6; ++k) own[k] = factor.scale * sum.matrix[k];
    // Regularises a plane with coincident or collinear points.
    for (const int k : {0, 3, 5}) own[k] += 1e-9;
    double* const l = factor.lower;
    l[0] = root_of(own[0]);
    l[1] = own[1] / l[0];
    l[2] = root_of(own[3] - l[1] * l[1]);
    l[3] = own[2] / l[0];
    l[4] = (own[4] - l[3] * l[1]) / l[2];
    l[5] = root_of(own[5] - l[3] * l[3] - l[4] * l[4]);
    for (int k = 0; k < 3; ++k) factor.right[k] = factor.scale * sum.right[k];
    factor.whiten(factor.right[0], factor.right[1], factor.right[2]);
    factors[plane] = factor;
  }

 private:
  ADASPLATS_HD static double root_of(double square) {
    return std::sqrt(square > 1e-12 ? square : 1e-12);
  }
};

/// Coupling of a scan with a plane: the whitened moments, 3x3, row-major.
struct PoseCoupling {
  double whitened[9];
};

/// Scales moments by the weight of their plane; `right` becomes the scan's contribution to the
/// right-hand side.
struct WhitenPoseEntry {
  EntriesView entries;
  const PlaneFactor* factors;
  bool has_poses;  ///< poses are estimated
  PoseMoments* moments;
  PoseCoupling* couplings;

  ADASPLATS_HD void operator()(std::size_t e) const {
    if (!has_poses) {
      moments[e] = {};
      couplings[e] = {};
      return;
    }
    const PlaneFactor factor = factors[entries.plane_of(e)];
    PoseMoments m = moments[e];
    for (double& value : m.matrix) value *= factor.scale;
    for (double& value : m.right) value *= factor.scale;
    const double* const s = m.matrix;
    double w[9] = {s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5]};
    for (int column = 0; column < 3; ++column)
      factor.whiten(w[column], w[3 + column], w[6 + column]);
    for (int k = 0; k < 3; ++k)
      m.right[k] = w[k] * factor.right[0] + w[3 + k] * factor.right[1] +
                   w[6 + k] * factor.right[2] - m.right[k];
    moments[e] = m;
    for (int k = 0; k < 9; ++k) couplings[e].whitened[k] = w[k];
  }
};

/// The columns of B: the first in full, of the others only the upper half (rotation).
struct PlaneWrenches {
  Vec3d turning[3];
  Vec3d normal;

  ADASPLATS_HD PlaneWrenches(const ScanPlane& plane, Vec3d pivot)
      : turning{cross(plane.center - pivot, plane.normal), cross(plane.axes[0], plane.normal),
                cross(plane.axes[1], plane.normal)},
        normal(plane.normal) {}

  /// Element `unknown` of column k.
  ADASPLATS_HD double at(int unknown, int k) const {
    if (unknown < 3) return turning[k][unknown];
    return k == 0 ? normal[unknown - 3] : 0.0;
  }
};

/// Sums of entries of one scan, without its own block.
struct SumPoseChunk {
  static constexpr std::size_t kGrain = 16;

  EntriesView entries;
  const EntryChunk* chunks;
  const ScanPlane* planes;
  const Vec3d* pivots;
  const PoseMoments* moments;
  const PoseCoupling* couplings;
  PoseBlock* blocks;

  ADASPLATS_HD void operator()(std::size_t c) const {
    const EntryChunk chunk = chunks[c];
    PoseBlock block;
    for (std::uint32_t k = chunk.begin; k < chunk.end; ++k) {
      const std::uint32_t e = entries.by_unknown[k];
      const PlaneWrenches wrenches(planes[entries.plane_of(e)], pivots[chunk.unknown]);
      double full[9], reduced[9];
      set_squares(moments[e], couplings[e], full, reduced);
      add_square(wrenches, full, block.full);
      add_square(wrenches, reduced, block.reduced);
      for (int a = 0; a < 6; ++a)
        for (int j = 0; j < 3; ++j) block.right[a] += wrenches.at(a, j) * moments[e].right[j];
    }
    blocks[c] = block;
  }

 private:
  ADASPLATS_HD static void set_squares(const PoseMoments& moments, const PoseCoupling& coupling,
                                       double (&full)[9], double (&reduced)[9]) {
    const double* const s = moments.matrix;
    const double* const w = coupling.whitened;
    const double square[9] = {s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5]};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        full[i * 3 + j] = square[i * 3 + j];
        reduced[i * 3 + j] =
            square[i * 3 + j] - (w[i] * w[j] + w[3 + i] * w[3 + j] + w[6 + i] * w[6 + j]);
      }
    }
  }

  /// Adds B m B^T.
  ADASPLATS_HD static void add_square(const PlaneWrenches& b, const double (&m)[9],
                                      double* square) {
    for (int row = 0; row < 6; ++row) {
      double along[3];
      for (int j = 0; j < 3; ++j)
        along[j] = b.at(row, 0) * m[j] + b.at(row, 1) * m[3 + j] + b.at(row, 2) * m[6 + j];
      for (int column = 0; column < 6; ++column)
        square[row * 6 + column] +=
            along[0] * b.at(column, 0) + along[1] * b.at(column, 1) + along[2] * b.at(column, 2);
    }
  }
};

/// Number of unknowns of a laser as an int, for loops.
inline constexpr int kOfLaser = static_cast<int>(kLaserUnknowns);

/// Coupling of a laser with a plane (whitened, 3 x kOfLaser, row-major) and the laser's own block.
struct LaserEntry {
  double whitened[3 * kOfLaser];
  double full[kOfLaser * kOfLaser], right[kOfLaser];
};

struct SumLaserEntry {
  EntriesView entries;
  const std::uint32_t* row_order;
  const PlaneRow* rows;
  std::size_t row_count, laser_count;
  const PlaneFactor* factors;
  LaserEntry* sums;

  ADASPLATS_HD void operator()(std::size_t e) const {
    LaserEntry sum{};
    const PlaneFactor factor = factors[entries.plane_of(e)];
    const std::size_t end = e + 1 < entries.count ? entries.begins[e + 1] : row_count;
    for (std::size_t at = entries.begins[e]; at < end && entries.unknown_of(e) < laser_count;
         ++at) {
      const PlaneRow row = rows[row_order[at]];
      const double weight = factor.scale * row.weight;
      for (int a = 0; a < kOfLaser; ++a) {
        const double weighted = weight * row.by_laser[a];
        sum.whitened[a] += weighted;
        sum.whitened[kOfLaser + a] += weighted * row.u_m;
        sum.whitened[2 * kOfLaser + a] += weighted * row.v_m;
        for (int b = 0; b < kOfLaser; ++b) sum.full[a * kOfLaser + b] += weighted * row.by_laser[b];
        sum.right[a] -= weighted * row.residual_m;
      }
    }
    double* const w = sum.whitened;
    for (int a = 0; a < kOfLaser; ++a) {
      factor.whiten(w[a], w[kOfLaser + a], w[2 * kOfLaser + a]);
      sum.right[a] += w[a] * factor.right[0] + w[kOfLaser + a] * factor.right[1] +
                      w[2 * kOfLaser + a] * factor.right[2];
    }
    sums[e] = sum;
  }
};

struct SumLaserChunk {
  static constexpr std::size_t kGrain = 64;

  EntriesView entries;
  const EntryChunk* chunks;
  const LaserEntry* sums;
  LaserBlock* blocks;

  ADASPLATS_HD void operator()(std::size_t c) const {
    LaserBlock block;
    for (std::uint32_t k = chunks[c].begin; k < chunks[c].end; ++k) {
      const LaserEntry& entry = sums[entries.by_unknown[k]];
      const double* const w = entry.whitened;
      for (int a = 0; a < kOfLaser; ++a) {
        block.right[a] += entry.right[a];
        for (int b = 0; b < kOfLaser; ++b) {
          block.full[a * kOfLaser + b] += entry.full[a * kOfLaser + b];
          block.reduced[a * kOfLaser + b] +=
              entry.full[a * kOfLaser + b] - (w[a] * w[b] + w[kOfLaser + a] * w[kOfLaser + b] +
                                              w[2 * kOfLaser + a] * w[2 * kOfLaser + b]);
        }
      }
    }
    blocks[c] = block;
  }
};

/// Coupling of one scan (rows of 6 x kOfLaser) and one laser (columns) by their common rows.
struct Crossing {
  double values[6 * kOfLaser];
};

struct SumCrossing {
  static constexpr std::size_t kGrain = 64;

  const std::uint32_t* begins;     ///< of rows, by scan, then laser; number of pairs + 1
  const std::uint32_t* row_order;  ///< by scan and laser
  const PlaneRow* rows;
  const std::uint64_t* keys;
  int scan_bits;
  const ScanPlane* planes;
  const PlaneFactor* factors;
  const Vec3d* pivots;
  std::size_t laser_count;
  bool has_poses;
  Crossing* crossings;

  ADASPLATS_HD void operator()(std::size_t i) const {
    Crossing sum{};
    const Vec3d pivot = pivots[i / laser_count];
    for (std::uint32_t at = begins[i]; has_poses && at < begins[i + 1]; ++at) {
      const std::uint32_t r = row_order[at];
      const PlaneRow row = rows[r];
      const std::uint64_t plane = keys[r] >> scan_bits;
      const PlaneWrenches wrenches(planes[plane], pivot);
      const double weight = factors[plane].scale * row.weight;
      for (int a = 0; a < 6; ++a) {
        const double by_pose =
            wrenches.at(a, 0) + row.u_m * wrenches.at(a, 1) + row.v_m * wrenches.at(a, 2);
        for (int b = 0; b < kOfLaser; ++b)
          sum.values[a * kOfLaser + b] += by_pose * (weight * row.by_laser[b]);
      }
    }
    crossings[i] = sum;
  }
};

/// Adds up the blocks of chunks, `width` numbers each, number by number.
struct AddChunks {
  static constexpr std::size_t kGrain = 64;

  const double* parts;
  const std::uint32_t* chunk_begins;  ///< number of unknowns + 1
  std::size_t width;
  double* sums;

  ADASPLATS_HD void operator()(std::size_t i) const {
    const std::size_t unknown = i / width, k = i % width;
    double sum = 0;
    for (std::uint32_t c = chunk_begins[unknown]; c < chunk_begins[unknown + 1]; ++c)
      sum += parts[c * width + k];
    sums[i] = sum;
  }
};

// Product with the coupling of scans and lasers: first the contributions of all of them to a
// plane...

struct PlaneVector {
  double values[3];
};

struct CouplePlane {
  static constexpr std::size_t kGrain = 128;

  EntriesView poses, lasers;  ///< `lasers` may be empty
  const ScanPlane* planes;
  const Vec3d* pivots;
  const PoseCoupling* pose_couplings;
  const LaserEntry* laser_entries;
  std::size_t laser_count;
  const double* of_poses;
  const double* of_lasers;
  PlaneVector* results;

  ADASPLATS_HD void operator()(std::size_t plane) const {
    PlaneVector sum{};
    add_poses(plane, sum);
    if (lasers.count > 0) add_lasers(plane, sum);
    results[plane] = sum;
  }

 private:
  ADASPLATS_HD void add_poses(std::size_t plane, PlaneVector& sum) const {
    for (std::uint32_t e = poses.plane_begins[plane]; e < poses.plane_begins[plane + 1]; ++e) {
      const std::size_t scan = poses.unknown_of(e);
      const double* const x = of_poses + 6 * scan;
      const Vec3d turn = {x[0], x[1], x[2]}, shift = {x[3], x[4], x[5]};
      const PlaneWrenches wrenches(planes[plane], pivots[scan]);
      const double t[3] = {dot(wrenches.turning[0], turn) + dot(wrenches.normal, shift),
                           dot(wrenches.turning[1], turn), dot(wrenches.turning[2], turn)};
      const double* const w = pose_couplings[e].whitened;
      for (int r = 0; r < 3; ++r)
        sum.values[r] += w[3 * r] * t[0] + w[3 * r + 1] * t[1] + w[3 * r + 2] * t[2];
    }
  }

  ADASPLATS_HD void add_lasers(std::size_t plane, PlaneVector& sum) const {
    for (std::uint32_t e = lasers.plane_begins[plane]; e < lasers.plane_begins[plane + 1]; ++e) {
      const std::size_t laser = lasers.unknown_of(e);
      if (laser >= laser_count) continue;
      const double* const x = of_lasers + kOfLaser * laser;
      const double* const w = laser_entries[e].whitened;
      for (int r = 0; r < 3; ++r)
        for (int a = 0; a < kOfLaser; ++a) sum.values[r] += w[kOfLaser * r + a] * x[a];
    }
  }
};

/// ...then the contributions of the planes to scans and lasers, subtracted chunk by chunk...
struct CouplePoseChunk {
  static constexpr std::size_t kGrain = 64;

  EntriesView entries;
  const EntryChunk* chunks;
  const ScanPlane* planes;
  const Vec3d* pivots;
  const PoseCoupling* couplings;
  const PlaneVector* of_planes;
  double* parts;  ///< six per chunk

  ADASPLATS_HD void operator()(std::size_t c) const {
    const EntryChunk chunk = chunks[c];
    Vec3d turning, shifting;
    for (std::uint32_t k = chunk.begin; k < chunk.end; ++k) {
      const std::uint32_t e = entries.by_unknown[k];
      const std::size_t plane = entries.plane_of(e);
      const double* const w = couplings[e].whitened;
      const double* const z = of_planes[plane].values;
      double f[3];
      for (int j = 0; j < 3; ++j) f[j] = w[j] * z[0] + w[3 + j] * z[1] + w[6 + j] * z[2];
      const PlaneWrenches wrenches(planes[plane], pivots[chunk.unknown]);
      turning = turning - (f[0] * wrenches.turning[0] + f[1] * wrenches.turning[1] +
                           f[2] * wrenches.turning[2]);
      shifting = shifting - f[0] * wrenches.normal;
    }
    for (int axis = 0; axis < 3; ++axis) {
      parts[c * 6 + static_cast<std::size_t>(axis)] = turning[axis];
      parts[c * 6 + 3 + static_cast<std::size_t>(axis)] = shifting[axis];
    }
  }
};

struct CoupleLaserChunk {
  static constexpr std::size_t kGrain = 64;

  EntriesView entries;
  const EntryChunk* chunks;
  const LaserEntry* sums;
  const PlaneVector* of_planes;
  double* parts;  ///< kOfLaser per chunk

  ADASPLATS_HD void operator()(std::size_t c) const {
    double sum[kOfLaser] = {};
    for (std::uint32_t k = chunks[c].begin; k < chunks[c].end; ++k) {
      const std::uint32_t e = entries.by_unknown[k];
      const double* const w = sums[e].whitened;
      const double* const z = of_planes[entries.plane_of(e)].values;
      for (int a = 0; a < kOfLaser; ++a)
        sum[a] -= w[a] * z[0] + w[kOfLaser + a] * z[1] + w[2 * kOfLaser + a] * z[2];
    }
    for (int a = 0; a < kOfLaser; ++a) parts[c * kOfLaser + static_cast<std::size_t>(a)] = sum[a];
  }
};

/// ...and the sum over the chunks of each unknown.
struct FinishPose {
  static constexpr std::size_t kGrain = 64;

  AddChunks chunks;
  const Crossing* crossings;
  std::size_t laser_count;
  const double* of_lasers;

  ADASPLATS_HD void operator()(std::size_t i) const {
    chunks(i);
    const std::size_t scan = i / 6, a = i % 6;
    double sum = chunks.sums[i];
    for (std::size_t laser = 0; laser < laser_count; ++laser) {
      const double* const cross = crossings[scan * laser_count + laser].values + a * kOfLaser;
      for (int b = 0; b < kOfLaser; ++b)
        sum += cross[b] * of_lasers[laser * kOfLaser + static_cast<std::size_t>(b)];
    }
    chunks.sums[i] = sum;
  }
};

struct FinishLaser {
  static constexpr std::size_t kGrain = 16;

  AddChunks chunks;
  const Crossing* crossings;
  std::size_t scans, laser_count;
  const double* of_poses;

  ADASPLATS_HD void operator()(std::size_t i) const {
    chunks(i);
    const std::size_t laser = i / kOfLaser, b = i % kOfLaser;
    double sum = chunks.sums[i];
    for (std::size_t scan = 0; scan < scans; ++scan) {
      const double* const cross = crossings[scan * laser_count + laser].values + b;
      for (std::size_t a = 0; a < 6; ++a) sum += cross[a * kOfLaser] * of_poses[scan * 6 + a];
    }
    chunks.sums[i] = sum;
  }
};

}  // namespace adasplats
