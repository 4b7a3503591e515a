// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/calibrate/sum_steps.h"

namespace adasplats {

/// Entries of planes and scans or lasers, and the chunks of the sums over them.
template <class Backend>
struct EntriesOn {
  template <class T>
  using Array = typename Backend::template Array<T>;

  int bits = 0;
  Array<std::uint64_t> keys;
  Array<std::uint32_t> begins, plane_begins, by_unknown;
  Array<EntryChunk> chunks;
  Array<std::uint32_t> chunk_begins;  ///< of scans or lasers; their number + 1

  std::size_t size() const { return keys.size(); }
  EntriesView view() const {
    return {keys.data(), keys.size(), bits, begins.data(), plane_begins.data(), by_unknown.data()};
  }
};

/// Sums the normal equations of poses and lasers over the rows on planes, for all devices; the code
/// for one element is in row_steps.h and sum_steps.h. `Backend` is CpuArrays or gpu::GpuBackend.
/// The order of every sum depends on the rows only: within a plane by scan, then in the plane's
/// order; within a scan or laser by plane, in chunks.
template <class Backend>
class PlaneSumsOn {
 public:
  template <class T>
  using Array = typename Backend::template Array<T>;

  explicit PlaneSumsOn(const Backend& backend) : backend_(backend) {}

  /// Chooses the points of the set that become rows, and finds their entries. `lasers`: of the
  /// cloud, null if `laser_count` is 0.
  void choose(const PlaneMembers& members, std::size_t plane_count, const RowOptions& options,
              const std::uint32_t* scans, const std::uint32_t* indices, const std::uint16_t* lasers,
              std::size_t scan_count, std::size_t laser_count) {
    planes_ = members.planes;
    indices_ = indices;
    plane_count_ = plane_count;
    scan_count_ = scan_count;
    laser_count_ = laser_count;
    list_rows(members, options, scans);
    make_entries(keys_, scan_count, poses_);
    if (laser_count > 0) order_by_laser(lasers);
  }

  PlaneBlocks sum(const RaysView& rays, const Vec3d* pivots, const RowOptions& options) {
    pivots_ = pivots;
    backend_.resize(rows_, points_.size());
    backend_.for_each(points_.size(), "measure distances",
                      MeasureRow{rays, indices_, points_.data(), keys_.data(), poses_.bits, planes_,
                                 options, rows_.data()});
    sum_poses(options);
    PlaneBlocks blocks;
    blocks.poses = pose_blocks();
    if (laser_count_ > 0) {
      sum_lasers(options);
      blocks.lasers = laser_blocks();
    }
    return blocks;
  }

  /// See CalibrationSteps::coupled().
  PlaneStep coupled(const PlaneStep& x) {
    const auto& of_poses = backend_.copied(x.poses);
    const auto& of_lasers = backend_.copied(x.lasers);
    backend_.resize(of_planes_, plane_count_);
    backend_.for_each(plane_count_, "couple planes",
                      CouplePlane{poses_.view(), lasers_.view(), planes_, pivots_,
                                  couplings_.data(), laser_entries_.data(), laser_count_,
                                  of_poses.data(), of_lasers.data(), of_planes_.data()});
    PlaneStep result;
    result.poses = coupled_poses(of_lasers.data());
    if (laser_count_ > 0) result.lasers = coupled_lasers(of_poses.data());
    return result;
  }

 private:
  static constexpr std::uint32_t kEntriesOfChunk = 64;

  static int bits_for(std::size_t numbers) { return static_cast<int>(std::bit_width(numbers)); }

  void list_rows(const PlaneMembers& members, const RowOptions& options,
                 const std::uint32_t* scans) {
    Array<std::uint32_t> counts = backend_.template array<std::uint32_t>(plane_count_);
    backend_.for_each(plane_count_, "count points",
                      CountRows{members, options.max_points, counts.data()});
    const auto begins = backend_.running_sums(counts);
    const std::vector<std::uint64_t>& begins_here = backend_.on_host(begins);
    const std::size_t rows = begins_here.back();
    Array<std::uint32_t> listed = backend_.template array<std::uint32_t>(rows);
    backend_.resize(keys_, rows);
    poses_.bits = bits_for(scan_count_);
    backend_.for_each(plane_count_, "list points",
                      ListRows{members, options.max_points, begins.data(), scans, poses_.bits,
                               listed.data(), keys_.data()});
    backend_.sort(keys_, order_);
    backend_.resize(points_, rows);
    backend_.for_each(rows, "list points",
                      PickValue<std::uint32_t>{listed.data(), order_.data(), points_.data()});
  }

  /// Finds the entries of rows from their sorted keys.
  void make_entries(const Array<std::uint64_t>& keys, std::size_t unknowns,
                    EntriesOn<Backend>& entries) const {
    Array<std::uint8_t> flags = backend_.template array<std::uint8_t>(keys.size());
    backend_.for_each(keys.size(), "find entries", FlagRunBegin{keys.data(), 0, flags.data()});
    entries.begins = backend_.flagged(flags);
    const std::size_t count = entries.begins.size();
    backend_.resize(entries.keys, count);
    backend_.for_each(
        count, "find entries",
        PickValue<std::uint64_t>{keys.data(), entries.begins.data(), entries.keys.data()});
    backend_.resize(entries.plane_begins, plane_count_ + 1);
    backend_.for_each(plane_count_ + 1, "find entries",
                      FindFirst{entries.keys.data(), static_cast<std::uint32_t>(count),
                                entries.bits, entries.plane_begins.data()});
    Array<std::uint64_t> of_unknowns = backend_.template array<std::uint64_t>(count);
    backend_.for_each(count, "order entries", KeyOfUnknown{entries.view(), of_unknowns.data()});
    backend_.sort(of_unknowns, entries.by_unknown);
    Array<std::uint32_t> begins = backend_.template array<std::uint32_t>(unknowns + 1);
    backend_.for_each(
        unknowns + 1, "order entries",
        FindFirst{of_unknowns.data(), static_cast<std::uint32_t>(count), 0, begins.data()});
    cut(backend_.on_host(begins), entries);
  }

  void cut(const std::vector<std::uint32_t>& begins, EntriesOn<Backend>& entries) const {
    std::vector<EntryChunk> chunks;
    std::vector<std::uint32_t> chunk_begins;
    for (std::uint32_t u = 0; u + 1 < begins.size(); ++u) {
      chunk_begins.push_back(static_cast<std::uint32_t>(chunks.size()));
      for (std::uint32_t e = begins[u]; e < begins[u + 1]; e += kEntriesOfChunk)
        chunks.push_back({u, e, std::min(e + kEntriesOfChunk, begins[u + 1])});
    }
    chunk_begins.push_back(static_cast<std::uint32_t>(chunks.size()));
    entries.chunks = backend_.copied(chunks);
    entries.chunk_begins = backend_.copied(chunk_begins);
  }

  void order_by_laser(const std::uint16_t* lasers) {
    lasers_.bits = bits_for(laser_count_);
    Array<std::uint64_t> by_plane = backend_.template array<std::uint64_t>(points_.size());
    Array<std::uint64_t> by_scan = backend_.template array<std::uint64_t>(points_.size());
    backend_.for_each(
        points_.size(), "order points",
        KeyOfLaser{keys_.data(), poses_.bits, points_.data(), indices_, lasers, scan_count_,
                   laser_count_, lasers_.bits, by_plane.data(), by_scan.data()});
    backend_.sort(by_plane, by_plane_and_laser_);
    make_entries(by_plane, laser_count_, lasers_);
    backend_.sort(by_scan, by_scan_and_laser_);
    const std::size_t count = scan_count_ * laser_count_;
    backend_.resize(crossing_begins_, count + 1);
    backend_.for_each(count + 1, "order points",
                      FindFirst{by_scan.data(), static_cast<std::uint32_t>(by_scan.size()), 0,
                                crossing_begins_.data()});
  }

  void sum_poses(const RowOptions& options) {
    backend_.resize(moments_, poses_.size());
    backend_.resize(couplings_, poses_.size());
    backend_.resize(factors_, plane_count_);
    backend_.for_each(poses_.size(), "add up scans",
                      SumPoseEntry{poses_.view(), rows_.data(), points_.size(), moments_.data()});
    backend_.for_each(
        plane_count_, "add up planes",
        FactorPlane{poses_.view(), moments_.data(), options.max_weight, factors_.data()});
    backend_.for_each(poses_.size(), "add up scans",
                      WhitenPoseEntry{poses_.view(), factors_.data(), options.poses,
                                      moments_.data(), couplings_.data()});
  }

  void sum_lasers(const RowOptions& options) {
    backend_.resize(laser_entries_, lasers_.size());
    backend_.for_each(
        lasers_.size(), "add up lasers",
        SumLaserEntry{lasers_.view(), by_plane_and_laser_.data(), rows_.data(), points_.size(),
                      laser_count_, factors_.data(), laser_entries_.data()});
    backend_.resize(crossings_, scan_count_ * laser_count_);
    backend_.for_each(crossings_.size(), "add up lasers",
                      SumCrossing{crossing_begins_.data(), by_scan_and_laser_.data(), rows_.data(),
                                  keys_.data(), poses_.bits, planes_, factors_.data(), pivots_,
                                  laser_count_, options.poses, crossings_.data()});
  }

  std::vector<PoseBlock> pose_blocks() const {
    Array<PoseBlock> parts = backend_.template array<PoseBlock>(poses_.chunks.size());
    backend_.for_each(parts.size(), "add up scans",
                      SumPoseChunk{poses_.view(), poses_.chunks.data(), planes_, pivots_,
                                   moments_.data(), couplings_.data(), parts.data()});
    return blocks_of(parts, poses_, scan_count_);
  }

  std::vector<LaserBlock> laser_blocks() const {
    Array<LaserBlock> parts = backend_.template array<LaserBlock>(lasers_.chunks.size());
    backend_.for_each(
        parts.size(), "add up lasers",
        SumLaserChunk{lasers_.view(), lasers_.chunks.data(), laser_entries_.data(), parts.data()});
    return blocks_of(parts, lasers_, laser_count_);
  }

  template <class Block>
  std::vector<Block> blocks_of(const Array<Block>& parts, const EntriesOn<Backend>& entries,
                               std::size_t unknowns) const {
    constexpr std::size_t kWidth = sizeof(Block) / sizeof(double);
    Array<double> sums = backend_.template array<double>(unknowns * kWidth);
    backend_.for_each(sums.size(), "add up chunks",
                      AddChunks{reinterpret_cast<const double*>(parts.data()),
                                entries.chunk_begins.data(), kWidth, sums.data()});
    const std::vector<double>& here = backend_.on_host(sums);
    std::vector<Block> blocks(unknowns);
    for (std::size_t u = 0; u < unknowns; ++u)
      std::copy_n(here.data() + u * kWidth, kWidth, reinterpret_cast<double*>(&blocks[u]));
    return blocks;
  }

  std::vector<double> coupled_poses(const double* of_lasers) {
    backend_.resize(pose_parts_, 6 * poses_.chunks.size());
    backend_.for_each(poses_.chunks.size(), "couple scans",
                      CouplePoseChunk{poses_.view(), poses_.chunks.data(), planes_, pivots_,
                                      couplings_.data(), of_planes_.data(), pose_parts_.data()});
    backend_.resize(of_scans_, 6 * scan_count_);
    backend_.for_each(
        of_scans_.size(), "couple scans",
        FinishPose{{pose_parts_.data(), poses_.chunk_begins.data(), 6, of_scans_.data()},
                   crossings_.data(),
                   laser_count_,
                   of_lasers});
    return backend_.on_host(of_scans_);
  }

  std::vector<double> coupled_lasers(const double* of_poses) {
    backend_.resize(laser_parts_, kLaserUnknowns * lasers_.chunks.size());
    backend_.for_each(lasers_.chunks.size(), "couple lasers",
                      CoupleLaserChunk{lasers_.view(), lasers_.chunks.data(), laser_entries_.data(),
                                       of_planes_.data(), laser_parts_.data()});
    backend_.resize(of_lasers_, kLaserUnknowns * laser_count_);
    backend_.for_each(of_lasers_.size(), "couple lasers",
                      FinishLaser{{laser_parts_.data(), lasers_.chunk_begins.data(), kLaserUnknowns,
                                   of_lasers_.data()},
                                  crossings_.data(),
                                  scan_count_,
                                  laser_count_,
                                  of_poses});
    return backend_.on_host(of_lasers_);
  }

  const Backend& backend_;
  const ScanPlane* planes_ = nullptr;
  const std::uint32_t* indices_ = nullptr;
  const Vec3d* pivots_ = nullptr;
  std::size_t plane_count_ = 0, scan_count_ = 0, laser_count_ = 0;

  // Rows, by plane and scan.
  Array<std::uint64_t> keys_;
  Array<std::uint32_t> order_, points_;
  Array<PlaneRow> rows_;
  EntriesOn<Backend> poses_, lasers_;
  Array<std::uint32_t> by_plane_and_laser_, by_scan_and_laser_, crossing_begins_;

  Array<PoseMoments> moments_;
  Array<PlaneFactor> factors_;
  Array<PoseCoupling> couplings_;
  Array<LaserEntry> laser_entries_;
  Array<Crossing> crossings_;
  Array<PlaneVector> of_planes_;
  Array<double> pose_parts_, of_scans_, laser_parts_, of_lasers_;
};

}  // namespace adasplats
