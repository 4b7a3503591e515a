// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/city/city_points.h"

#include <optional>
#include <string>
#include <vector>

#include "adasplats/city/tile_points.h"
#include "adasplats/cloud/labels/dynamic_removal.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/pipeline/model/label_use.h"
#include "adasplats/pipeline/session/inputs.h"
#include "adasplats/recipes/city/city_inputs.h"
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

/// The points to their tiles; fills in facts and what tiles have in common.
void read_points(CityWork& work) {
  const CityJob& job = work.job;
  const bool has_labels = !job.segment.on;  // else a network gives classes when all are sorted
  TilePointsWriter writer(work.folder, work.tiles.grid, kBufferedPoints, work.session.executor,
                          job.segment.on);
  RangeCounts ranges;
  std::optional<CurveBox> box;
  ModelJob reading = job;
  reading.load.empty_beams = work.options.empty_beams && work.options.balance_rounds > 0;
  const std::optional<LabelScheme> scheme = work.scheme();
  const LabelScheme* const known = scheme ? &*scheme : nullptr;
  const CityPoints read = read_city_points(reading, work.session, [&](PointCloud&& cloud) {
    const bool is_first = !box;
    cloud.scan_indices = {};  // all that they were for is done
    cloud.lasers = {};
    writer.add(cloud);
    if (is_first) work.common.crs = cloud.crs;
    if (is_first && has_labels)
      check_label_use({job.labels, job.build.remove, job.removal_is_asked}, cloud, known,
                      work.session.progress);
    add_ranges(cloud, ranges);
    if (has_labels) work.facts.rays += count_rays(cloud, known, work);
    if (!cloud.empty())
      grow(box, curve_box_of(cloud.positions, work.session.executor),
           cloud.origin - writer.origin());
  });
  work.facts.tiles = writer.finish();
  if (!box) throw Error(ErrorKind::data, "no points: there is nothing to model");
  work.facts.box = *box;
  work.facts.origin = writer.origin();
  work.facts.points_read = read.read;
  work.facts.empty_reach_m = ranges.empty_reach_m();
  work.common.origin = work.facts.origin;
  work.common.calibration = read.calibration;
  work.calibrated_s = read.calibrated_s;
  work.common.method = "consistent";
  if (scheme) work.common.label_scheme = scheme_reference(job.labels, *scheme);
}

/// Files of the work's folder with what they hold.
std::vector<FileDigest> digests_of(const std::vector<std::string>& files, const CityWork& work) {
  std::vector<FileDigest> digests(files.size());
  work.session.executor.for_chunks(files.size(), 1, [&](std::size_t k, std::size_t) {
    digests[k] = {files[k], sha256_of_file(work.path(files[k]))};
  });
  return digests;
}

void find_tiles(CityWork& work) {
  for (const auto& [tile, count] : work.facts.tiles)
    if (count.points > 0) work.tiles.tiles.insert(tile);
}

std::vector<std::string> files_of_points(const CityWork& work) {
  std::vector<std::string> files;
  for (const auto& [tile, count] : work.facts.tiles) {
    if (count.points > 0) files.push_back(points_file_of(tile));
    if (count.points > 0 && work.job.segment.on) files.push_back(order_file_of(tile));
    if (count.empty_beams > 0) files.push_back(beams_file_of(tile));
  }
  return files;
}

}  // namespace

std::size_t count_rays(const PointCloud& cloud, const LabelScheme* scheme, const CityWork& work) {
  const RemovedPoints removed = points_to_remove(cloud, scheme, work.job.build.remove);
  std::size_t rays = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_beam(cloud.origin_kind(i))) continue;
    const float range_m = length(cloud.positions[i] - cloud.sensor_positions[i]);
    const bool stays =
        removed.ids.empty() || cloud.classes.empty() || removed.ids[cloud.classes[i]] == 0;
    if (stays && static_cast<double>(range_m) >= work.options.least_range_m) ++rays;
  }
  return rays;
}

void load_sorted(CityWork& work) {
  work.facts = load_facts(work.path(kPointsFile));
  work.common = load_model(work.path(kCityCommonFile));
  work.common.origin = work.facts.origin;
  find_tiles(work);
}

void sort_points(CityWork& work, ResumableFolder& folder) {
  fs::create_directories(work.path("points"));
  if (folder.has(kPointsFile)) {
    load_sorted(work);
    for (const std::string& file : files_of_points(work))
      if (!folder.has(file))
        throw Error(ErrorKind::data, work.path(file).string() + ": not as it was written; remove " +
                                         work.folder.string() + " to start anew");
    return;
  }
  fs::remove_all(work.path("points"));  // what a killed run left half done
  fs::remove_all(work.path("rays"));
  read_points(work);
  save_model(work.path(kCityCommonFile), work.common);
  write_file_in_place(work.path(kPointsFile), text_of(work.facts));
  folder.record(std::string(kCityCommonFile));
  folder.record(digests_of(files_of_points(work), work));
  folder.record(std::string(kPointsFile));
  find_tiles(work);
}

}  // namespace adasplats
