// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/calibrate/drive_reader.h"

#include <algorithm>
#include <utility>

namespace adasplats {

DriveReader::DriveReader(const OpenInputs& inputs, Session& session)
    : inputs_(&inputs),
      session_(&session),
      warnings_(std::make_shared<RepeatedWarnings>(session.progress, "pieces of the drive")) {}

std::optional<DriveReader> DriveReader::of(const OpenInputs& inputs, std::size_t window_scans,
                                           Session& session) {
  if (!inputs.are_drives() || inputs.rig()) return std::nullopt;
  std::vector<std::size_t> counts;
  for (std::size_t k = 0; k < inputs.inputs().size(); ++k) counts.push_back(inputs.chosen_scans(k));
  // Of drives without a chosen scan load() says what is wrong.
  if (std::ranges::max(counts) <= window_scans || std::ranges::min(counts) == 0)
    return std::nullopt;
  DriveReader pieces(inputs, session);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const OpenInput& drive = inputs.inputs()[k];
    const ScanBeams& beams = drive.sequence->beams;
    pieces.report_.beams.push_back(beams.description());
    pieces.report_.drives.push_back({drive.input.path, beams.sensor, counts[k],
                                     drive.is_frame_drive ? drive.sequence->facts : DriveFacts{}});
    pieces.is_counted_.emplace_back(counts[k]);
  }
  return pieces;
}

std::vector<DriveSource> DriveReader::sources() {
  std::vector<DriveSource> sources;
  for (std::size_t drive = 0; drive < report_.drives.size(); ++drive)
    sources.push_back(
        {report_.drives[drive].scans, [this, drive](ScanSpan span) { return read(drive, span); }});
  return sources;
}

PointCloud DriveReader::read(std::size_t drive, ScanSpan span) {
  auto [cloud, loaded] =
      inputs_->load({drive, span.begin, span.size()}, session_->executor, *warnings_);
  loaded.beams.clear();
  loaded.drives.clear();
  if (!is_counted_[drive][span.begin]) report_.add(std::move(loaded));
  is_counted_[drive][span.begin] = true;
  return std::move(cloud);
}

void DriveReader::end() { warnings_->end(); }

}  // namespace adasplats
