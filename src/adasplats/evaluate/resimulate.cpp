// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/evaluate/resimulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "adasplats/cloud/beams/empty_beams.h"
#include "adasplats/cloud/sequence/moving_boxes.h"
#include "adasplats/core/error.h"
#include "adasplats/evaluate/beam_accuracy_internal.h"
#include "adasplats/evaluate/beam_surroundings.h"

namespace adasplats {
namespace {

constexpr std::array<double, 7> kRangeEdges_m = {10, 20, 30, 40, 50, 75, 100};
constexpr std::array<double, 6> kIncidenceEdges_deg = {0, 30, 60, 75, 85, 90};
constexpr double kDegreesPerRadian = 57.29577951308232;
constexpr float kNearSurface_m = 0.5F;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint8_t kNoBin = 255;
constexpr float kMinUp = static_cast<float>(EmptyBeamOptions{}.min_up);

/// The stored result of one beam.
struct Beam {
  float error_m = kNoHitError;
  std::uint32_t primitive = Hit::kNone;
  /// The moving object it is on, as far as known: its number in the boxes, or kLabelled, class and
  /// instance; 0: none.
  std::uint64_t object = 0;
  std::uint8_t range_bin = 0;
  std::uint8_t incidence_bin = 0;  ///< meaningless without a hit
  std::int8_t elevation_deg = 0;   ///< rounded down
  bool upward = false;             ///< in the world
  Surroundings surroundings = Surroundings::rough;
  std::uint16_t class_id = 0;  ///< 0 without labels
};

/// The counted beams of one scan, with the measured and the predicted points.
struct CastScan {
  std::vector<Beam> beams;
  std::vector<float> measured_intensities, predicted_intensities;  ///< of beams near the surface
  PointCloud measured;                                             ///< sensor frame
  PointCloud predicted;  ///< sensor frame; beams without a hit have none
};

/// Names and bounds of bins: value v is in bin k for edges[k] <= v < edges[k + 1].
struct Bins {
  std::vector<double> edges;
  const char* unit;

  std::uint8_t bin_of(double value) const {
    const auto after = std::upper_bound(edges.begin() + 1, edges.end() - 1, value);
    return static_cast<std::uint8_t>(after - edges.begin() - 1);
  }
  std::size_t size() const { return edges.size() - 1; }
  std::string name_of(std::size_t bin) const {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%g-%g %s", edges[bin], edges[bin + 1], unit);
    return text.data();
  }
};

Bins range_bins(const ResimulateOptions& options) {
  Bins bins{{options.min_range_m}, "m"};
  for (const double edge : kRangeEdges_m) {
    if (edge > options.min_range_m && edge < options.max_range_m) bins.edges.push_back(edge);
  }
  bins.edges.push_back(options.max_range_m);
  return bins;
}

Bins incidence_bins() { return {{kIncidenceEdges_deg.begin(), kIncidenceEdges_deg.end()}, "deg"}; }

/// The measured points that count: finite, within the ranges, of classes that are kept.
std::vector<std::uint32_t> select_points(const KittiScan& scan, const std::filesystem::path& file,
                                         const LabelScheme& labels,
                                         const ResimulateOptions& options) {
  std::vector<std::uint32_t> selected;
  for (std::size_t i = 0; i < scan.positions.size(); ++i) {
    const Vec3d point = vec_cast<double>(scan.positions[i]);
    const double range_m = length(point);
    // A point that is not finite has no range within the bounds.
    if (!(range_m >= options.min_range_m && range_m <= options.max_range_m)) continue;
    if (!scan.classes.empty()) {
      const SemanticClass* found = labels.find(scan.classes[i]);
      if (found == nullptr) {
        throw Error(ErrorKind::data, file.string() + ": point " + std::to_string(i) + ": class " +
                                         std::to_string(scan.classes[i]) +
                                         " is not in the label scheme '" + labels.name() + "'");
      }
      if (!is_counted(found->mobility, options.drop_moving, options.drop_movable)) continue;
    }
    selected.push_back(static_cast<std::uint32_t>(i));
  }
  return selected;
}

/// A measured beam as it is cast again.
struct BeamToCast {
  Ray ray;
  double range_m = 0;
  double elevation_rad = 0;  ///< in the scan's frame
};

BeamToCast beam_to_cast(const MeasuredBeam& beam, const RigidTransform& scene_from_sensor) {
  BeamToCast cast;
  const Vec3d way = beam.end - beam.origin;
  cast.range_m = length(way);
  const Vec3d direction = way / cast.range_m;
  cast.elevation_rad = std::asin(std::clamp(direction.z, -1.0, 1.0));
  cast.ray.origin = vec_cast<float>(scene_from_sensor * beam.origin);
  cast.ray.direction = vec_cast<float>(scene_from_sensor.rotation * direction);
  return cast;
}

void add_intensities(float measured, float predicted, CastScan& scan) {
  if (!std::isfinite(measured) || !std::isfinite(predicted)) return;
  scan.measured_intensities.push_back(measured);
  scan.predicted_intensities.push_back(predicted);
}

/// What the casts of all scans share.
struct CastSettings {
  const BeamScene& scene;
  const LabelScheme& labels;
  const ResimulateOptions& options;
  Bins ranges;
  Bins incidences;
};

/// Casts beams into the scene and its objects at the times of the points.
void cast_beams(const BeamScene& scene, std::span<const Ray> rays, const KittiScan& scan,
                const TimedPose& pose, std::span<const std::uint32_t> selected, std::span<Hit> hits,
                const Executor& executor) {
  scene.tracer.nearest(rays, hits, executor);
  if (scene.world == nullptr) return;
  std::vector<double> times_s;
  for (const std::uint32_t i : selected) times_s.push_back(time_of_point(scan, pose, i));
  scene.world->add_hits(rays, times_s, hits, executor);
}

constexpr std::uint64_t kLabelled = std::uint64_t{1} << 32U;

/// Beam::object of a point.
std::uint64_t object_of(const KittiScan& scan, std::size_t i, const LabelScheme& labels) {
  if (!scan.in_boxes.empty() && scan.in_boxes[i] != 0) return scan.in_boxes[i];
  if (scan.classes.empty() || labels.find(scan.classes[i])->mobility != Mobility::moving) return 0;
  return kLabelled + (std::uint64_t{scan.classes[i]} << 16U) + scan.instances[i];
}

/// Incidence and intensity of a beam that hit the scene, not an object.
void add_hit_figures(const CastSettings& setting, const Ray& ray, const Hit& hit, float intensity,
                     Beam& beam, CastScan& result) {
  const PrimitiveAttributes& scene = setting.scene.attributes;
  beam.incidence_bin = kNoBin;
  if (hit.primitive >= scene.view.primitive_count()) return;
  const double cosine = cos_incidence(scene.view, ray.direction, hit.primitive);
  beam.incidence_bin = setting.incidences.bin_of(std::acos(cosine) * kDegreesPerRadian);
  if (std::fabs(beam.error_m) <= kNearSurface_m)
    add_intensities(intensity, expected_intensity(scene, ray, hit), result);
}

CastScan cast_scan(const CastSettings& setting, const KittiSequence& sequence, std::size_t index,
                   const Executor& executor) {
  const KittiScan scan = setting.options.drop_moving ? read_kitti_scan(sequence, index)
                                                     : read_all_returns(sequence, index);
  const std::vector<std::uint32_t> selected =
      select_points(scan, sequence.scans[index], setting.labels, setting.options);
  RigidTransform scene_from_sensor = sequence.trajectory[index].world_from_sensor;
  scene_from_sensor.translation = scene_from_sensor.translation - setting.scene.origin;

  CastScan result;
  result.beams.resize(selected.size());
  result.measured.positions.resize(selected.size());
  std::vector<MeasuredBeam> measured(selected.size());
  std::vector<BeamToCast> cast(selected.size());
  std::vector<Ray> rays(selected.size());
  std::vector<Hit> hits(selected.size());
  executor.for_chunks(rays.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      measured[k] = beam_of(sequence, index, scan, selected[k]);
      result.measured.positions[k] = vec_cast<float>(measured[k].end);
      cast[k] = beam_to_cast(measured[k], scene_from_sensor);
      rays[k] = cast[k].ray;
    }
  });
  cast_beams(setting.scene, rays, scan, sequence.trajectory[index], selected, hits, executor);
  const auto surroundings = surroundings_of(result.measured.positions, executor);
  for (std::size_t k = 0; k < selected.size(); ++k) {
    const double range_m = cast[k].range_m;
    Beam& beam = result.beams[k];
    beam.range_bin = setting.ranges.bin_of(length(vec_cast<double>(result.measured.positions[k])));
    beam.elevation_deg =
        static_cast<std::int8_t>(std::floor(cast[k].elevation_rad * kDegreesPerRadian));
    beam.surroundings = surroundings[k];
    beam.upward = rays[k].direction.z > kMinUp;
    if (!scan.classes.empty()) beam.class_id = scan.classes[selected[k]];
    beam.object = object_of(scan, selected[k], setting.labels);
    if (!hits[k].valid()) continue;
    const double predicted_m = static_cast<double>(hits[k].t);
    beam.error_m = static_cast<float>(predicted_m - range_m);
    beam.primitive = hits[k].primitive;
    add_hit_figures(setting, rays[k], hits[k],
                    scan.intensities.empty() ? kUnknown : scan.intensities[selected[k]], beam,
                    result);
    result.predicted.positions.push_back(vec_cast<float>(
        measured[k].origin + predicted_m / range_m * (measured[k].end - measured[k].origin)));
  }
  return result;
}

/// The single beams of a scan.
/// `primitives`: number of those of the scene; objects have none.
ScanErrors errors_of(CastScan scan, std::size_t primitives) {
  ScanErrors errors;
  errors.measured = std::move(scan.measured.positions);
  errors.errors_m.reserve(scan.beams.size());
  errors.primitives.reserve(scan.beams.size());
  for (const Beam& beam : scan.beams) {
    errors.errors_m.push_back(beam.error_m);
    errors.primitives.push_back(beam.primitive < primitives ? beam.primitive : Hit::kNone);
  }
  return errors;
}

/// Means of the scans' distances, as lidar-nerf and LiDAR4D average them over frames.
class MeanCloudDistance {
 public:
  void add(const CloudDistance& scan) {
    ++scans_;
    sum_.c2c_m += scan.c2c_m;
    sum_.completeness_m += scan.completeness_m;
    sum_.chamfer_m += scan.chamfer_m;
    sum_.chamfer_m2 += scan.chamfer_m2;
    for (const auto& [bound_m, score] : scan.f_score) sum_.f_score[bound_m] += score;
    sum_.simulated_points += scan.simulated_points;
    sum_.original_points += scan.original_points;
  }
  /// Distances are NaN if no scan was added.
  CloudDistance mean() const {
    const double scans = scans_ == 0 ? std::numeric_limits<double>::quiet_NaN() : scans_;
    CloudDistance result = sum_;
    for (double* value :
         {&result.c2c_m, &result.completeness_m, &result.chamfer_m, &result.chamfer_m2}) {
      *value /= scans;
    }
    for (auto& [bound_m, score] : result.f_score) score /= scans;
    return result;
  }

 private:
  int scans_ = 0;
  CloudDistance sum_;
};

template <class Predicate>
BeamAccuracy accuracy_where(const std::vector<Beam>& beams, const Predicate& predicate) {
  std::vector<float> errors_m;
  for (const Beam& beam : beams) {
    if (predicate(beam)) errors_m.push_back(beam.error_m);
  }
  return accuracy_of(errors_m);
}

/// The errors of the beams of each of `parts`, in one pass over the beams. `part_of` returns the
/// part of a beam; numbers from `parts` on mean none.
template <class PartOf>
std::vector<std::vector<float>> errors_by_part(const std::vector<Beam>& beams, std::size_t parts,
                                               const PartOf& part_of) {
  std::vector<std::vector<float>> errors_m(parts);
  for (const Beam& beam : beams)
    if (const std::size_t part = part_of(beam); part < parts)
      errors_m[part].push_back(beam.error_m);
  return errors_m;
}

void add_breakdowns(ResimulateResult& result, const std::vector<Beam>& beams,
                    const CastSettings& setting, bool labelled) {
  const Bins& ranges = setting.ranges;
  const auto by_range =
      errors_by_part(beams, ranges.size(), [](const Beam& beam) { return beam.range_bin; });
  for (std::size_t bin = 0; bin < ranges.size(); ++bin)
    result.by_range.emplace_back(ranges.name_of(bin), accuracy_of(by_range[bin]));
  const Bins& incidences = setting.incidences;
  const auto by_incidence = errors_by_part(beams, incidences.size(), [&](const Beam& beam) {
    return std::isnan(beam.error_m) ? incidences.size() : beam.incidence_bin;
  });
  for (std::size_t bin = 0; bin < incidences.size(); ++bin)
    result.by_incidence.emplace_back(incidences.name_of(bin), accuracy_of(by_incidence[bin]));
  const auto by_surroundings = errors_by_part(beams, kSurroundings, [](const Beam& beam) {
    return static_cast<std::size_t>(beam.surroundings);
  });
  for (std::size_t kind = 0; kind < kSurroundings; ++kind)
    result.by_surroundings.emplace_back(name_of(static_cast<Surroundings>(kind)),
                                        accuracy_of(by_surroundings[kind]));
  constexpr int kDown_deg = -90, kUp_deg = 90;
  const auto by_elevation = errors_by_part(beams, kUp_deg - kDown_deg + 1, [](const Beam& beam) {
    return static_cast<std::size_t>(beam.elevation_deg - kDown_deg);
  });
  for (int elevation = kDown_deg; elevation <= kUp_deg; ++elevation) {
    const auto& errors_m = by_elevation[static_cast<std::size_t>(elevation - kDown_deg)];
    if (errors_m.empty()) continue;
    result.by_elevation.emplace_back(std::to_string(elevation) + " deg", accuracy_of(errors_m));
  }
  if (!labelled) return;
  constexpr std::size_t kClassIds = 0x10000;
  const auto by_class =
      errors_by_part(beams, kClassIds, [](const Beam& beam) { return beam.class_id; });
  for (const SemanticClass& semantic_class : setting.labels.classes()) {
    const auto& errors_m = by_class[semantic_class.id];
    if (!errors_m.empty()) result.by_class.emplace_back(semantic_class.name, accuracy_of(errors_m));
  }
}

void append(const std::vector<float>& from, std::vector<float>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void check(const ResimulateOptions& options) {
  if (!(options.min_range_m >= 0 && options.min_range_m < options.max_range_m &&
        std::isfinite(options.max_range_m))) {
    throw Error(ErrorKind::usage, "ranges must be 0 <= minimum < maximum, found " +
                                      std::to_string(options.min_range_m) + " and " +
                                      std::to_string(options.max_range_m));
  }
}

/// "73 Car" or "moving-car 5".
std::string object_name(std::uint64_t object, const KittiSequence& sequence,
                        const LabelScheme& labels) {
  if (object < kLabelled) {
    const BoxTrack& track = sequence.boxes->tracks()[object - 1];
    return std::to_string(track.id) + (track.label.empty() ? "" : " ") + track.label;
  }
  const auto class_id = static_cast<std::uint16_t>((object - kLabelled) >> 16U);
  return labels.find(class_id)->name + " " + std::to_string(object & 0xffffU);
}

void add_objects(ResimulateResult& result, const std::vector<Beam>& beams,
                 const KittiSequence& sequence, const LabelScheme& labels) {
  std::map<std::uint64_t, std::vector<float>> errors_m;
  for (const Beam& beam : beams)
    if (beam.object != 0) errors_m[beam.object].push_back(beam.error_m);
  for (const auto& [object, errors] : errors_m)
    result.by_object.emplace_back(object_name(object, sequence, labels), accuracy_of(errors));
}

}  // namespace

ResimulateResult resimulate(const BeamScene& scene, const KittiSequence& sequence,
                            const LabelScheme& labels, const ResimulateOptions& options,
                            const Executor& executor, ProgressSink& progress, KeepBeams keep) {
  check(options);
  const CastSettings setting{scene, labels, options, range_bins(options), incidence_bins()};
  std::vector<Beam> beams;
  std::vector<float> measured_intensities, predicted_intensities;
  MeanCloudDistance clouds;
  ResimulateResult result;
  progress.begin_step("re-simulate", sequence.scans.size());
  for (std::size_t index = 0; index < sequence.scans.size(); ++index) {
    CastScan scan = cast_scan(setting, sequence, index, executor);
    beams.insert(beams.end(), scan.beams.begin(), scan.beams.end());
    append(scan.measured_intensities, measured_intensities);
    append(scan.predicted_intensities, predicted_intensities);
    if (!scan.predicted.empty()) {
      clouds.add(cloud_distance(scan.predicted, scan.measured, executor));
    } else if (!scan.beams.empty()) {
      progress.warn(sequence.scans[index].string() +
                    ": no beam hit the model; the scan is left out of the cloud distances");
    }
    if (keep == KeepBeams::yes)
      result.errors.push_back(errors_of(std::move(scan), scene.attributes.view.primitive_count()));
    progress.advance(index + 1);
  }
  progress.end_step();
  if (beams.empty()) {
    throw Error(ErrorKind::data,
                sequence.folder.string() +
                    ": no measured beams within the ranges and of classes that are kept");
  }
  result.all = accuracy_where(beams, [](const Beam&) { return true; });
  result.upward = accuracy_where(beams, [](const Beam& beam) { return beam.upward; });
  if (!options.drop_moving && (sequence.boxes || !sequence.labels.empty())) {
    for (const bool moving : {false, true})
      result.by_motion.emplace_back(
          moving ? "moving" : "still",
          accuracy_where(beams, [&](const Beam& beam) { return (beam.object != 0) == moving; }));
    add_objects(result, beams, sequence, labels);
  }
  result.clouds = clouds.mean();
  if (!measured_intensities.empty())
    result.intensities = intensity_agreement(predicted_intensities, measured_intensities);
  result.beams = sequence.beams.description();
  add_breakdowns(result, beams, setting, !sequence.labels.empty());
  return result;
}

}  // namespace adasplats
