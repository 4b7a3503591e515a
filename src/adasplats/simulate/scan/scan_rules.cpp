// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/simulate/scan/scan_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace adasplats {
namespace {

template <class T>
bool is_there(std::span<const T> values, std::size_t count) {
  if (!values.empty() && values.size() != count)
    throw std::logic_error("an attribute needs one value for each primitive of the scene");
  return !values.empty();
}

GainTable gain_table(std::span<const float> nodes, std::span<const float> gains) {
  if (gains.size() != nodes.size()) return {};
  return {nodes.data(), gains.data(), static_cast<std::uint32_t>(gains.size())};
}

}  // namespace

PrimitiveTable primitive_table(const PrimitiveAttributes& attributes, const Executor& executor) {
  PrimitiveTable table;
  // Objects of a world are behind the view, which is of the place.
  const std::size_t count = std::max({attributes.view.primitive_count(), attributes.classes.size(),
                                      attributes.instances.size(), attributes.intensities.size()});
  table.has_classes = is_there(attributes.classes, count);
  table.has_instances = is_there(attributes.instances, count);
  table.has_intensities = is_there(attributes.intensities, count);
  if (attributes.response != nullptr) table.response = *attributes.response;
  const auto memory = std::make_shared<std::vector<PrimitiveValues>>(count);
  table.values = *memory;
  table.memory = memory;
  executor.for_chunks(count, kCoarseGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      PrimitiveValues& values = (*memory)[i];
      if (i < attributes.view.primitive_count()) values.normal = attributes.view.unit_normal(i);
      values.reflectance = table.has_intensities ? attributes.intensities[i]
                                                 : std::numeric_limits<float>::quiet_NaN();
      if (table.has_classes) values.class_id = attributes.classes[i];
      if (table.has_instances) values.instance = attributes.instances[i];
      if (i < attributes.drop_log_odds.size()) values.drop_log_odds = attributes.drop_log_odds[i];
    }
  });
  return table;
}

ScanRules::ScanRules(const LidarModel& sensor, std::vector<Firing> firings,
                     const SimulateOptions& options, std::shared_ptr<const PrimitiveTable> table)
    : sensor_(sensor), options_(options), table_(std::move(table)) {
  check_beam(options.beam, sensor);
  weights_ = sub_ray_weights(options_.beam);
  if (!options.weather.is_clear()) air_ = air_rules(options.weather, sensor, expected_);
  set_firings(std::move(firings));
}

void ScanRules::set_firings(std::vector<Firing> firings) {
  identity_ = std::make_shared<int>(0);
  firings_ = std::move(firings);
  if (options_.beam.sub_rays > 1) cast_firings_ = sub_firings(sensor_, firings_, options_.beam);
  blocked_.clear();
  if (options_.ray_drop && !options_.ray_drop->blocked.empty())
    for (const Firing& firing : firings_)
      blocked_.push_back(options_.ray_drop->blocks(firing.direction) ? 1 : 0);
  set_body_cells();
}

/// The cells of the sensor's file, and one for each firing that a box stops.
void ScanRules::set_body_cells() {
  body_cells_.clear();
  body_.clear();
  if (!options_.vehicle_body || !sensor_.body) return;
  const VehicleBody& body = *sensor_.body;
  body_ = body.cells;
  for (const Firing& firing : firings_) {
    const std::size_t found = body.find(firing.ring, firing.direction);
    std::size_t cell = found < body.cells.size() ? found : kNoBody;
    const double range_m =
        body.range_to_boxes(vec_cast<double>(firing.origin), vec_cast<double>(firing.direction));
    if (std::isfinite(range_m)) {
      cell = body_.size();
      body_.push_back({firing.ring, 0, 1, static_cast<float>(range_m), 0});
    }
    body_cells_.push_back(static_cast<std::uint32_t>(cell));
  }
  if (body_.empty()) body_cells_.clear();
}

std::span<const double> ScanRules::range_offsets_m() const {
  if (!options_.sensor_offsets) return {};
  return sensor_.range_offsets_m;
}

std::span<const double> ScanRules::ring_noise_m() const {
  if (!options_.noise) return {};
  return sensor_.ring_noise_m;
}

const SensorIntensity* ScanRules::intensity() const {
  return options_.noise && sensor_.intensity && table_->has_intensities ? &*sensor_.intensity
                                                                        : nullptr;
}

const SensorFields* ScanRules::unit_fields() const {
  const bool asks =
      options_.ray_drop || intensity() != nullptr || (options_.noise && has_field_noise());
  return asks && sensor_.fields ? &*sensor_.fields : nullptr;
}

/// Not where the user set the noise of ranges: ring_noise_m is empty then.
bool ScanRules::has_field_noise() const { return sensor_.fields && !sensor_.ring_noise_m.empty(); }

ScanFields ScanRules::fields() const {
  ScanFields fields = options_.fields;
  fields.classes = fields.classes && table_->has_classes;
  fields.instances = fields.instances && table_->has_instances;
  fields.intensities = fields.intensities && table_->has_intensities;
  fields.return_indices = fields.return_indices && options_.beam.returns > 1;
  return fields;
}

FiringRules ScanRules::view() const {
  FiringRules rules;
  rules.firings = firings_.data();
  rules.rotation_hz = sensor_.rotation_hz;
  rules.min_range_m = static_cast<float>(sensor_.min_range_m);
  rules.max_range_m = static_cast<float>(sensor_.max_range_m);
  if (options_.noise) {
    rules.range_noise_m = sensor_.range_noise_m;
    rules.angular_noise_rad = sensor_.angular_noise_rad;
    rules.range_resolution_m = sensor_.range_resolution_m;
  }
  rules.range_offsets_m = range_offsets_m().data();
  rules.range_offset_count = static_cast<std::uint32_t>(range_offsets_m().size());
  rules.ring_noise_m = ring_noise_m().data();
  rules.ring_noise_count = static_cast<std::uint32_t>(ring_noise_m().size());
  if (intensity() != nullptr) rules.intensity = intensity_rules(*intensity());
  if (const SensorFields* fields = unit_fields()) {
    rules.fields = {fields->bytes.data(), fields->turns, fields->rings, fields->columns};
    rules.field_noise = options_.noise && has_field_noise();
  }
  rules.beam = options_.beam;
  rules.weights = weights_.data();
  if (options_.ray_drop) rules.drop = drop_rules(*options_.ray_drop);
  rules.blocked = blocked_.empty() ? nullptr : blocked_.data();
  rules.body_cells = body_cells_.empty() ? nullptr : body_cells_.data();
  rules.body = body().data();
  rules.air = air_;
  rules.air.expected = expected_.data();
  rules.primitives = table_->values.data();
  rules.primitive_count = static_cast<std::uint32_t>(table_->values.size());
  rules.has_intensities = table_->has_intensities;
  const IntensityResponse& response = table_->response;
  rules.has_response = !response.empty();
  rules.range_gain = gain_table(response.ranges_m, response.range_gains);
  rules.incidence_gain = gain_table(response.cos_incidences, response.incidence_gains);
  rules.seed = options_.seed;
  return rules;
}

std::vector<ScanPose> frame_poses(const ScanMotion& motion) {
  std::vector<ScanPose> poses;
  if (motion.knots.size() < 2) return poses;
  const RigidTransform frame_from_world = motion.reference.world_from_sensor.inverse();
  for (const RigidTransform& knot : motion.knots)
    poses.push_back(scan_pose(frame_from_world * knot, {}));
  return poses;
}

ScanPoses::ScanPoses(const ScanRules& rules, const ScanMotion& motion, Vec3d scene_origin)
    : knots(scan_poses(motion, scene_origin)) {
  if (rules.deskews()) frame_knots = frame_poses(motion);
}

ScanState ScanPoses::state(std::uint64_t scan_index) const {
  return {knots.data(), static_cast<std::uint32_t>(knots.size()),
          frame_knots.empty() ? nullptr : frame_knots.data(), scan_index};
}

}  // namespace adasplats
