// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/city/city_points.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adasplats/city/tile_points.h"
#include "adasplats/cloud/load/cloud_inputs.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/jobs/city/city_alignment.h"
#include "adasplats/jobs/city/city_inputs.h"
#include "adasplats/jobs/model/unused_settings.h"
#include "adasplats/jobs/session/inputs.h"
#include "adasplats/splats/rays/measured_rays.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Points that wait in memory to be written to their tiles.
constexpr std::size_t kBufferedPoints = 4'000'000;

void grow(std::optional<CurveBox>& box, CurveBox more, Vec3d shift) {
  if (!(shift == Vec3d{})) {
    more.low = vec_cast<float>(vec_cast<double>(more.low) + shift);
    more.high = vec_cast<float>(vec_cast<double>(more.high) + shift);
  }
  if (!box) box = more;
  box->low = min(box->low, more.low);
  box->high = max(box->high, more.high);
}

void add_ranges(const PointCloud& cloud, RangeCounts& ranges) {
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (is_beam(cloud.origin_kind(i)))
      ranges.add(length(cloud.positions[i] - cloud.sensor_positions[i]));
}

/// Throws data where new points come with other attributes than the city's.
void require_attributes(const CityBefore& before, const std::string& attributes) {
  if (attributes != before.attributes)
    throw Error(ErrorKind::data, "the points of " + before.city.string() +
                                     " come with other attributes:" + before.attributes +
                                     "; the new ones with" + attributes);
}

/// Throws data where their labels are of another scheme.
void require_scheme(const CityBefore& before, const std::string& label_scheme) {
  if (label_scheme != before.label_scheme)
    throw Error(ErrorKind::data, "the labels of " + before.city.string() + " are of the scheme '" +
                                     before.label_scheme + "', those of the new points of '" +
                                     label_scheme + "' (`labels`)");
}

/// The points to their tiles; fills in facts and what tiles have in common.
class LayerReader {
 public:
  explicit LayerReader(LayerWork& work)
      : work_(work),
        has_labels_(!work.job.segment.on),
        scheme_(scheme_of(work.job)),
        writer_(work.folder(), work.tiles.grid, kBufferedPoints, work.session.executor,
                work.job.segment.on,
                work.before ? std::optional(work.before->origin) : std::nullopt) {}

  void read() {
    if (scheme_) work_.common.label_scheme = scheme_reference(work_.job.labels, *scheme_);
    if (work_.before && scheme_) require_scheme(*work_.before, work_.common.label_scheme);
    ModelJob reading = work_.job;
    reading.load.empty_beams = work_.options.empty_beams && work_.options.balance_rounds > 0;
    const CityPoints read = read_city_points(
        reading, work_.session, [&](PointCloud&& cloud) { take(std::move(cloud)); }, how());
    LayerFacts& facts = work_.layer.facts;
    facts.tiles = writer_.finish();
    if (!box_) throw Error(ErrorKind::data, "no points: there is nothing to model");
    facts.box = *box_;
    facts.origin = writer_.origin();
    facts.attributes = attributes();
    facts.points_read = read.read;
    facts.empty_reach_m = ranges_.empty_reach_m();
    SplatModel& common = work_.common;
    common.origin = facts.origin;
    common.calibration =
        alignment() == nullptr ? read.calibration : alignment()->behind(read.calibration);
    common.method = "consistent";
    work_.calibrated_s = read.calibrated_s;
  }

 private:
  CityAlignment* alignment() const { return work_.before ? work_.before->alignment : nullptr; }

  CityReading how() const {
    CityReading reading;
    if (work_.before) reading.place = work_.before->place;
    if (alignment() != nullptr)
      reading.lay_on = [to = alignment()](PointCloud& cloud) { to->lay_on(cloud); };
    return reading;
  }

  void take(PointCloud&& cloud) {
    const LabelScheme* const known = scheme_ ? &*scheme_ : nullptr;
    cloud.scan_indices = {};  // all that they were for is done
    cloud.lasers = {};
    if (has_labels_) work_.layer.facts.rays += count_rays(cloud, known, work_.job);
    writer_.add(cloud);
    if (!box_) begin_with(cloud, known);
    add_ranges(cloud, ranges_);
    if (!cloud.empty())
      grow(box_, curve_box_of(cloud.positions, work_.session.executor),
           cloud.origin - writer_.origin());
  }

  void begin_with(const PointCloud& cloud, const LabelScheme* known) {
    const CityJob& job = work_.job;
    work_.common.crs = cloud.crs;
    if (work_.before) {
      require_same_crs({{work_.before->city, work_.before->crs}, {job.inputs.front(), cloud.crs}},
                       work_.session.progress);
      work_.common.crs = work_.before->crs;
      require_attributes(*work_.before, attributes());
    }
    if (has_labels_)
      check_label_use({job.labels, job.build.remove, job.removal_is_asked}, cloud, known,
                      work_.session.progress);
  }

  /// Of the points as they are modelled: where a network gives classes, labels do not matter.
  std::string attributes() const {
    std::string names = writer_.attributes();
    constexpr std::string_view kClasses = " classes";
    if (const auto at = names.find(kClasses); !has_labels_ && at != std::string::npos)
      names.erase(at, kClasses.size());
    return names;
  }

  LayerWork& work_;
  bool has_labels_;
  std::optional<LabelScheme> scheme_;
  TilePointsWriter writer_;
  RangeCounts ranges_;
  std::optional<CurveBox> box_;
};

/// Files of the layer with what they hold.
std::vector<FileDigest> digests_of(const std::vector<std::string>& files, const LayerWork& work) {
  std::vector<FileDigest> digests(files.size());
  work.session.executor.for_chunks(files.size(), 1, [&](std::size_t k, std::size_t) {
    digests[k] = {work.layer.file(files[k]), sha256_of_file(work.path(files[k]))};
  });
  return digests;
}

void find_tiles(LayerWork& work) {
  for (const auto& [tile, count] : work.layer.facts.tiles)
    if (count.points > 0) work.tiles.tiles.insert(tile);
}

std::vector<std::string> files_of_points(const LayerFacts& facts, const LayerWork& work) {
  std::vector<std::string> files;
  for (const auto& [tile, count] : facts.tiles) {
    if (count.points > 0) files.push_back(points_file_of(tile));
    if (count.points > 0 && work.job.segment.on) files.push_back(order_file_of(tile));
    if (count.empty_beams > 0) files.push_back(beams_file_of(tile));
  }
  return files;
}

/// Whether an earlier run left all points. Errors: data (a file has changed).
bool has_points(const LayerWork& work, const ResumableFolder& folder) {
  const std::string needed[] = {work.layer.file(kPointsFile), work.layer.file(kLayerCommonFile)};
  if (!folder.has(needed)) return false;
  for (const std::string& file : files_of_points(load_facts(work.path(kPointsFile)), work)) {
    if (folder.has(work.layer.file(file))) continue;
    // A run that was stopped at its end has removed some files.
    if (!fs::exists(work.path(file))) return false;
    throw Error(ErrorKind::data, work.path(file).string() +
                                     ": changed since it was written; remove " +
                                     work.city.string() + " to start again");
  }
  return true;
}

}  // namespace

void load_sorted(LayerWork& work) {
  work.layer.facts = load_facts(work.path(kPointsFile));
  work.common = load_model(work.path(kLayerCommonFile));
  work.common.origin = work.layer.facts.origin;
  find_tiles(work);
}

void sort_points(LayerWork& work, ResumableFolder& folder) {
  if (has_points(work, folder)) {
    load_sorted(work);
    return;
  }
  fs::remove_all(work.folder());  // what a killed run left half done
  fs::create_directories(work.path("points"));
  LayerReader(work).read();
  save_model(work.path(kLayerCommonFile), work.common);
  write_file_in_place(work.path(kPointsFile), text_of(work.layer.facts));
  folder.record(work.layer.file(kLayerCommonFile));
  folder.record(digests_of(files_of_points(work.layer.facts, work), work));
  folder.record(work.layer.file(kPointsFile));
  find_tiles(work);
}

}  // namespace adasplats
