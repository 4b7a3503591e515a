// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/semantickitti_writer.h"
#include "adasplats/synth/city/city_caster.h"
#include "adasplats/synth/city/city_drive.h"
#include "adasplats/synth/city/city_sections.h"
#include "adasplats/synth/city/scan_schedule.h"
#include "adasplats/synth/city/synth_city.h"
#include "adasplats/synth/street.h"
#include "adasplats/synth/world/world_parts.h"

namespace adasplats {
namespace {

constexpr std::size_t kBatch =
    64;  // scans that are cast while the sections for the next batch are built
constexpr double kBatchWay_m = 48;    // maximum driven length of a batch
constexpr double kKeptBeyond_m = 50;  // beyond the sensor's range, in case the drive turns back

class CityScanner {
 public:
  CityScanner(const SynthCityOptions& options, const SynthCitySink& sink, const Executor& executor)
      : options_(options),
        sink_(sink),
        executor_(executor),
        sensor_(load_lidar_model(options.sensor)),
        firings_(firings_of(sensor_)),
        sectors_(firings_),
        schedule_(options, firings_.size()),
        grid_(options.seed),
        models_(grid_, executor),
        drive_(grid_, options.length_m),
        vehicle_from_sensor_(draw_world_mount(options.seed)) {}

  SynthCityReport run(ProgressSink& progress) {
    progress.begin_step("metres", static_cast<std::uint64_t>(std::ceil(options_.length_m)));
    while (true) {
      const std::size_t first = schedule_.scans();
      const std::vector<double> positions = schedule_.next(kBatch, kBatchWay_m, report_.points);
      if (positions.empty()) break;
      const std::set<CitySectionId> wanted = sections_along(positions);
      std::set<CitySectionId> kept = around(positions.back(), kKeptBeyond_m);
      kept.insert(wanted.begin(), wanted.end());
      sections_.keep(kept);
      work(missing(wanted), {}, 0);
      work(missing(sections_along(schedule_.preview(kBatch, kBatchWay_m))), positions, first);
      report_.scans = schedule_.scans();
      if (sink_.scans_done) sink_.scans_done(report_.scans);
      progress.advance(static_cast<std::uint64_t>(positions.back()));
    }
    progress.end_step();
    return report_;
  }

 private:
  std::set<CitySectionId> around(double position, double beyond_m) const {
    return sections_around(grid_, drive_.grid_position(position), sensor_.max_range_m + beyond_m);
  }
  std::set<CitySectionId> sections_along(const std::vector<double>& positions) const {
    std::set<CitySectionId> all;
    for (const double position : positions) all.merge(around(position, 0));
    return all;
  }
  std::vector<CitySectionId> missing(const std::set<CitySectionId>& wanted) const {
    std::vector<CitySectionId> ids;
    for (const CitySectionId& id : wanted)
      if (!sections_.holds(id)) ids.push_back(id);
    return ids;
  }

  /// Builds sections and casts scans on all threads; sections start first because they take
  /// longest.
  void work(const std::vector<CitySectionId>& to_make, const std::vector<double>& positions,
            std::size_t first_scan) {
    std::vector<std::unique_ptr<CitySection>> made(to_make.size());
    std::vector<std::size_t> points(positions.size());
    std::atomic<std::size_t> next = 0;
    executor_.for_chunks(made.size() + positions.size(), 1, [&](std::size_t, std::size_t) {
      const std::size_t task = next++;
      if (task < made.size()) {
        made[task] = make(to_make[task]);
      } else {
        const std::size_t k = task - made.size();
        points[k] = cast(positions[k], first_scan + k);
      }
    });
    for (const std::size_t count : points) report_.points += count;
    for (auto& section : made) {
      if (built_.insert(section->id).second) {
        ++report_.pieces;
        report_.mesh_triangles += section->built.mesh.triangles.size();
      } else {
        ++report_.pieces_made_again;
      }
      sections_.add(std::move(section), executor_);
    }
    report_.max_pieces = std::max(report_.max_pieces, sections_.size());
  }

  std::unique_ptr<CitySection> make(const CitySectionId& id) const {
    auto section = std::make_unique<CitySection>(grid_, id, models_);
    if (sink_.section && built_.count(id) == 0) sink_.section(name_of(id), section->built);
    return section;
  }

  /// Casts one scan and passes it to the sink; returns its number of points.
  std::size_t cast(double position, std::size_t index) const {
    const Vec3d grid_position = drive_.grid_position(position);
    TimedPose pose = drive_.at(position);
    CityScene scene = {.models = &models_};
    for (const CitySectionId& id : around(position, 0)) {
      const CitySection& section = sections_.section(id);
      scene.sections.push_back(&section);
    }
    scene.movers = vehicles_around(grid_, models_, grid_position, sensor_.max_range_m, pose.time_s);
    for (const CitySection* section : scene.sections)
      for (const Walker& walker : section->walkers)
        scene.movers.push_back(place_walker(walker, section->plan, pose.time_s));
    pose.world_from_sensor = pose.world_from_sensor * vehicle_from_sensor_;
    Scan scan;
    if (repeats(sensor_)) {
      scan = scan_of(scene, firings_, sectors_, pose, index);
    } else {
      const std::vector<Firing> firings = firings_of(sensor_, index);
      scan = scan_of(scene, firings, FiringSectors(firings), pose, index);
    }
    const std::size_t count = scan.size();
    sink_.scan(index, scan);
    return count;
  }

  Scan scan_of(const CityScene& scene, std::span<const Firing> firings,
               const FiringSectors& sectors, const TimedPose& pose, std::size_t index) const {
    const std::vector<StreetEcho> echoes =
        cast_city(scene, sensor_, firings, sectors, pose, options_.seed, index, executor_);
    return world_scan_of(firings, echoes, pose, options_.seed, index);
  }

  const SynthCityOptions& options_;
  const SynthCitySink& sink_;
  const Executor& executor_;
  LidarModel sensor_;
  std::vector<Firing> firings_;
  FiringSectors sectors_;
  ScanSchedule schedule_;
  CityGrid grid_;
  MoverModels models_;
  CityDrive drive_;
  RigidTransform vehicle_from_sensor_;
  CitySections sections_;
  std::set<CitySectionId> built_;  ///< all sections built so far
  SynthCityReport report_;
};

}  // namespace

SynthCityReport scan_synth_city(const SynthCityOptions& options, const SynthCitySink& sink,
                                const Executor& executor, ProgressSink& progress) {
  check_settings(options);
  CityScanner scanner(options, sink, executor);
  return scanner.run(progress);
}

SynthCityReport write_synth_city(const std::filesystem::path& folder,
                                 const SynthCityOptions& options, const Executor& executor,
                                 ProgressSink& progress) {
  check_settings(options);
  const std::filesystem::path sequence = folder / "sequences" / "00";
  const std::filesystem::path truth = folder / "truth";
  SemanticKittiWriter writer(sequence);
  if (options.truth) create_folder(truth);
  std::mutex mutex;
  std::map<std::size_t, EncodedScan> written;  // of one batch, without their bytes
  SynthCitySink sink;
  sink.scan = [&](std::size_t index, const Scan& scan) {
    EncodedScan encoded = SemanticKittiWriter::encode(index, scan);
    write_encoded(sequence, encoded.files, FileWrites::in_place);
    encoded.files.clear();
    const std::lock_guard lock(mutex);
    written.emplace(index, std::move(encoded));
  };
  sink.scans_done = [&](std::size_t) {
    for (const auto& [index, scan] : written) writer.note_written(index, scan);
    written.clear();
  };
  if (options.truth) {
    sink.section = [&](const std::string& name, const BuiltMesh& section) {
      save_street_mesh(truth / (name + ".ply"), section.mesh, section.instances,
                       section.reflectances);
    };
  }
  const SynthCityReport report = scan_synth_city(options, sink, executor, progress);
  writer.finish();
  return report;
}

}  // namespace adasplats
