// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "adasplats/synth/city/city_caster.h"
#include "adasplats/synth/city/city_drive.h"
#include "adasplats/synth/city/city_pace.h"
#include "adasplats/synth/city/city_pieces.h"
#include "adasplats/synth/city/synth_city.h"
#include "adasplats/synth/world/world_scan.h"

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
        pace_(options, firings_.size()),
        grid_(options.seed),
        models_(grid_, executor),
        drive_(grid_, options.length_m),
        vehicle_from_sensor_(draw_world_mount(options.seed)) {}

  SynthCityReport run(ProgressSink& progress) {
    progress.begin_step("metres", static_cast<std::uint64_t>(std::ceil(options_.length_m)));
    while (true) {
      const std::size_t first = pace_.scans();
      const std::vector<double> places = pace_.next(kBatch, kBatchWay_m, report_.points);
      if (places.empty()) break;
      const std::set<CityPieceId> wanted = pieces_of(places);
      std::set<CityPieceId> kept = around(places.back(), kKeptBeyond_m);
      kept.insert(wanted.begin(), wanted.end());
      pieces_.keep(kept);
      work(missing(wanted), {}, 0);
      work(missing(pieces_of(pace_.foreseen(kBatch, kBatchWay_m))), places, first);
      report_.scans = pace_.scans();
      if (sink_.scans_done) sink_.scans_done(report_.scans);
      progress.advance(static_cast<std::uint64_t>(places.back()));
    }
    progress.end_step();
    return report_;
  }

 private:
  std::set<CityPieceId> around(double place, double beyond_m) const {
    return pieces_around(grid_, drive_.grid_place(place), sensor_.max_range_m + beyond_m);
  }
  std::set<CityPieceId> pieces_of(const std::vector<double>& places) const {
    std::set<CityPieceId> all;
    for (const double place : places) all.merge(around(place, 0));
    return all;
  }
  std::vector<CityPieceId> missing(const std::set<CityPieceId>& wanted) const {
    std::vector<CityPieceId> ids;
    for (const CityPieceId& id : wanted)
      if (!pieces_.holds(id)) ids.push_back(id);
    return ids;
  }

  /// Builds sections and casts scans on all threads; sections start first because they take
  /// longest.
  void work(const std::vector<CityPieceId>& to_make, const std::vector<double>& places,
            std::size_t first_scan) {
    std::vector<std::unique_ptr<CityPiece>> made(to_make.size());
    std::vector<std::size_t> points(places.size());
    std::atomic<std::size_t> next = 0;
    executor_.for_chunks(made.size() + places.size(), 1, [&](std::size_t, std::size_t) {
      const std::size_t task = next++;
      if (task < made.size()) {
        made[task] = make(to_make[task]);
      } else {
        const std::size_t k = task - made.size();
        points[k] = cast(places[k], first_scan + k);
      }
    });
    for (const std::size_t count : points) report_.points += count;
    for (auto& piece : made) {
      if (known_.insert(piece->id).second) {
        ++report_.pieces;
        report_.mesh_triangles += piece->built.mesh.triangles.size();
      } else {
        ++report_.pieces_made_again;
      }
      pieces_.add(std::move(piece), executor_);
    }
    report_.max_pieces = std::max(report_.max_pieces, pieces_.size());
  }

  std::unique_ptr<CityPiece> make(const CityPieceId& id) const {
    auto piece = std::make_unique<CityPiece>(grid_, id, models_);
    if (sink_.piece && known_.count(id) == 0) sink_.piece(name_of(id), piece->built);
    return piece;
  }

  /// Casts one scan and passes it to the sink; returns its number of points.
  std::size_t cast(double place, std::size_t index) const {
    const Vec3d grid_place = drive_.grid_place(place);
    TimedPose pose = drive_.at(place);
    CityScene scene = {.models = &models_};
    for (const CityPieceId& id : around(place, 0)) {
      const CityPiece& piece = pieces_.piece(id);
      scene.pieces.push_back(&piece);
    }
    scene.movers = vehicles_around(grid_, models_, grid_place, sensor_.max_range_m, pose.time_s);
    for (const CityPiece* piece : scene.pieces)
      for (const Walker& walker : piece->walkers)
        scene.movers.push_back(place_walker(walker, piece->plan, pose.time_s));
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
  CityPace pace_;
  CityGrid grid_;
  MoverModels models_;
  CityDrive drive_;
  RigidTransform vehicle_from_sensor_;
  CityPieces pieces_;
  std::set<CityPieceId> known_;  ///< all sections built so far
  SynthCityReport report_;
};

}  // namespace

SynthCityReport scan_synth_city(const SynthCityOptions& options, const SynthCitySink& sink,
                                const Executor& executor, ProgressSink& progress) {
  check_settings(options);
  CityScanner scanner(options, sink, executor);
  return scanner.run(progress);
}

}  // namespace adasplats
