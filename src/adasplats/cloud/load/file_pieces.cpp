// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/file_pieces.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "adasplats/cloud/load/cloud_part.h"

namespace adasplats {
namespace {

/// One scan of a file.
struct ScanPart {
  std::uint64_t begin = 0;  ///< its first record
  Vec3d sensor_sum;         ///< of the sensor's positions in the world
  std::size_t sensors = 0;  ///< that were measured
};

/// The scans of a file, in the order of its records.
class ScansOfFile {
 public:
  /// Takes the next records; false where they have no scans, or are not in their order.
  bool take(const CloudPart& part) {
    const std::vector<std::uint32_t>& numbers = part.cloud.scan_indices;
    if (numbers.size() != part.size() || part.world_sensors.size() != part.size()) return false;
    for (std::size_t i = 0; i < numbers.size(); ++i, ++records_) {
      if (scans_.empty() || numbers[i] != last_) {
        if (!scans_.empty() && numbers[i] < last_) {
          is_shuffled_ = true;
          return false;
        }
        scans_.push_back({records_, {}, 0});
        last_ = numbers[i];
      }
      if (!is_measured(part, i)) continue;
      scans_.back().sensor_sum = scans_.back().sensor_sum + part.world_sensors[i];
      ++scans_.back().sensors;
    }
    return true;
  }

  bool is_shuffled() const { return is_shuffled_; }
  /// Records of the longest scan.
  std::uint64_t longest() const {
    std::uint64_t longest = 0;
    for (std::size_t scan = 0; scan < scans_.size(); ++scan)
      longest = std::max(longest, end_of(scan) - scans_[scan].begin);
    return longest;
  }

  /// Pieces of whole scans, each with the path beyond.
  std::vector<InputPiece> pieces(std::size_t input, std::uint64_t max_records) const {
    std::vector<InputPiece> pieces;
    for (std::size_t scan = 0; scan < scans_.size();) {
      const std::size_t first = scan++;
      while (scan < scans_.size() && end_of(scan) - scans_[first].begin <= max_records) ++scan;
      InputPiece piece = {
          input, scans_[first].begin, end_of(scan - 1) - scans_[first].begin, true, {}};
      add_places(0, first, piece.beyond.before);
      add_places(scan, scans_.size(), piece.beyond.after);
      pieces.push_back(std::move(piece));
    }
    return pieces;
  }

 private:
  static bool is_measured(const CloudPart& part, std::size_t i) {
    const std::vector<OriginKind>& kinds = part.cloud.origin_kinds;
    return is_place(part.world_sensors[i]) && (kinds.empty() || kinds[i] == OriginKind::measured);
  }
  std::uint64_t end_of(std::size_t scan) const {
    return scan + 1 < scans_.size() ? scans_[scan + 1].begin : records_;
  }
  void add_places(std::size_t begin, std::size_t end, std::vector<Vec3d>& places) const {
    for (std::size_t k = begin; k < end; ++k)
      if (scans_[k].sensors > 0)
        places.push_back(scans_[k].sensor_sum / static_cast<double>(scans_[k].sensors));
  }

  std::vector<ScanPart> scans_;
  std::uint32_t last_ = 0;
  std::uint64_t records_ = 0;
  bool is_shuffled_ = false;
};

/// Says what is not known of the pieces of a file.
void warn_of_cut_scans(const std::filesystem::path& file, const std::string& why,
                       ProgressSink& progress) {
  progress.warn(file.string() + ": " + why +
                "; as it is read piece by piece, beams without return are not looked for, nor is "
                "traffic in the path of the vehicle beyond a piece");
}

/// Pieces of whole scans; nothing where the file has none.
std::vector<InputPiece> pieces_by_scans(const std::filesystem::path& file, std::size_t input,
                                        std::uint64_t all, std::uint64_t records,
                                        const LoadOptions& options, const Executor& executor,
                                        ProgressSink& progress) {
  ScansOfFile scans;
  ProgressSink quiet;  // what is to be said of the file is said when its points are loaded
  for (std::uint64_t first = 0; first < all; first += records) {
    LoadOptions part = options;
    part.selection.records = RecordSpan{first, records};
    if (scans.take(read_file_part(file, part, quiet, &executor))) continue;
    if (scans.is_shuffled())
      warn_of_cut_scans(file, "its scans are not one behind another", progress);
    return {};
  }
  if (scans.longest() > 2 * records) {
    warn_of_cut_scans(file, "it has a scan of " + std::to_string(scans.longest()) + " points",
                      progress);
    return {};
  }
  return scans.pieces(input, records);
}

}  // namespace

std::vector<InputPiece> file_pieces(const OpenInputs& inputs, std::uint64_t records,
                                    const Executor& executor, ProgressSink& progress) {
  std::vector<InputPiece> pieces;
  for (std::size_t k = 0; k < inputs.inputs().size(); ++k) {
    const CloudInput& input = inputs.inputs()[k].input;
    if (input.is_sequence) throw std::logic_error("file_pieces: a drive");
    const LoadOptions& options = inputs.options();
    const std::optional<std::uint64_t> all = records_at_random(input.path, options.salvage);
    if (!all || *all <= records) {
      pieces.push_back({.input = k});
      continue;
    }
    std::vector<InputPiece> own;
    if (options.selection.is_all())
      own = pieces_by_scans(input.path, k, *all, records, options, executor, progress);
    for (std::uint64_t first = 0; own.empty() && first < *all; first += records)
      pieces.push_back({k, first, records, false, {}});
    std::ranges::move(own, std::back_inserter(pieces));
  }
  return pieces;
}

}  // namespace adasplats
