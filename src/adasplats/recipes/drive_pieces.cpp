// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/drive_pieces.h"

#include <algorithm>
#include <array>
#include <utility>

#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/cloud/load/cloud_part.h"

namespace adasplats {

namespace {

std::size_t chosen_of(std::size_t scans, const LoadOptions& load) {
  if (load.first_scan >= scans || load.scan_stride == 0) return 0;  // load_cloud says what is wrong
  return std::min(load.scan_count, (scans - load.first_scan - 1) / load.scan_stride + 1);
}

}  // namespace

DrivePieces::DrivePieces(const LoadOptions& load, Session& session)
    : load_(load),
      session_(&session),
      warnings_(std::make_shared<RepeatedWarnings>(session.progress, "pieces of the drive")) {}

std::optional<DrivePieces> DrivePieces::open(std::span<const std::filesystem::path> inputs,
                                             const LoadOptions& load, std::size_t window_scans,
                                             Session& session) {
  if (!load.trajectory.empty() || load.viewpoint) return std::nullopt;
  std::vector<CloudInput> sequences;
  for (const std::filesystem::path& path : inputs)
    for (CloudInput& input : cloud_inputs(path)) sequences.push_back(std::move(input));
  if (!std::ranges::all_of(sequences, &CloudInput::is_sequence)) return std::nullopt;
  std::size_t longest = 0;
  std::vector<std::size_t> counts;
  for (const CloudInput& input : sequences) {
    counts.push_back(chosen_of(open_kitti_sequence(input.path).scans.size(), load));
    longest = std::max(longest, counts.back());
  }
  if (longest <= window_scans || std::ranges::find(counts, std::size_t{0}) != counts.end())
    return std::nullopt;
  if (sequences.size() > 1) require_one_world(sequences);
  DrivePieces pieces(load, session);
  for (std::size_t k = 0; k < sequences.size(); ++k) {
    const KittiSequence sequence = open_sequence(sequences[k].path, load, session.executor);
    pieces.report_.beams.push_back(sequence.beams.description());
    pieces.report_.drives.push_back({sequences[k].path, sequence.beams.sensor, counts[k]});
    pieces.is_counted_.emplace_back(counts[k]);
  }
  return pieces;
}

std::vector<DriveSource> DrivePieces::sources() {
  std::vector<DriveSource> sources;
  for (std::size_t drive = 0; drive < report_.drives.size(); ++drive)
    sources.push_back(
        {report_.drives[drive].scans, [this, drive](ScanSpan span) { return read(drive, span); }});
  return sources;
}

PointCloud DrivePieces::read(std::size_t drive, ScanSpan span) {
  LoadOptions part = load_;
  part.first_scan = load_.first_scan + span.begin * load_.scan_stride;
  part.scan_count = span.size();
  const std::array inputs = {report_.drives[drive].folder};
  auto [cloud, loaded] = load_cloud(inputs, part, session_->executor, *warnings_);
  if (!is_counted_[drive][span.begin]) count(loaded);
  is_counted_[drive][span.begin] = true;
  return std::move(cloud);
}

void DrivePieces::count(const LoadReport& piece) {
  report_.points_read += piece.points_read;
  report_.dropped_not_finite += piece.dropped_not_finite;
  report_.no_returns += piece.no_returns;
  report_.unknown_intensities += piece.unknown_intensities;
  report_.dropped_far += piece.dropped_far;
  report_.own_body += piece.own_body;
  report_.driven_path += piece.driven_path;
  for (std::size_t kind = 0; kind < piece.origins.size(); ++kind)
    report_.origins[kind] += piece.origins[kind];
}

void DrivePieces::end() { warnings_->end(); }

}  // namespace adasplats
