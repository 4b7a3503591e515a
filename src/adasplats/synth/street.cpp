// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/synth/street.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/dataset/scan_values.h"
#include "adasplats/dataset/semantickitti_writer.h"
#include "adasplats/io/ply/ply.h"
#include "adasplats/synth/street_parts.h"

namespace adasplats {

double street_length_for(std::size_t points) {
  const double length = 60 * std::pow(static_cast<double>(points) / 300'000, 0.4);
  return std::clamp(length, kMinStreetLength_m, kMaxStreetLength_m);
}

Street make_street(const StreetOptions& options) {
  const StreetPlan plan = make_street_plan(options);
  MeshBuilder builder;
  add_ground(plan, builder);
  add_facades(plan, builder);
  add_houses(plan, builder);
  add_fences(plan, builder);
  add_furniture(plan, builder);
  add_vegetation(plan, builder);
  const std::uint16_t first_moving = add_parked_cars(plan, builder);
  BuiltMesh built = builder.take();

  Street street;
  street.length_m = plan.length;
  street.fixed = std::move(built.mesh);
  street.instances = std::move(built.instances);
  street.reflectances = std::move(built.reflectances);
  street.moving = make_traffic(plan, first_moving);
  street.traffic_period_s = kTrafficPeriod_s;
  return street;
}

void save_street_mesh(const std::filesystem::path& path, const Street& street) {
  save_street_mesh(path, street.fixed, street.instances, street.reflectances);
}

void save_street_mesh(const std::filesystem::path& path, const TriangleMesh& mesh,
                      std::span<const std::uint16_t> instances,
                      std::span<const float> reflectances) {
  const auto* first = mesh.vertices.data();
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  const float* floats = first == nullptr ? nullptr : &first->x;
  const std::array<ColumnView, 3> vertex_columns = {
      ColumnView{"x", ColumnType::f32, floats, sizeof(Vec3f)},
      ColumnView{"y", ColumnType::f32, floats == nullptr ? nullptr : &first->y, sizeof(Vec3f)},
      ColumnView{"z", ColumnType::f32, floats == nullptr ? nullptr : &first->z, sizeof(Vec3f)}};
  const std::array<ColumnView, 3> face_columns = {
      ColumnView{"class", ColumnType::u16, mesh.classes.data(), sizeof(std::uint16_t)},
      ColumnView{"instance", ColumnType::u16, instances.data(), sizeof(std::uint16_t)},
      ColumnView{"reflectance", ColumnType::f32, reflectances.data(), sizeof(float)}};
  std::vector<std::uint32_t> corners;
  corners.reserve(mesh.triangles.size() * 3);
  for (const auto& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  const std::array<std::string, 1> comments = {
      "true surface of a procedural street, SemanticKITTI classes, moving objects not included"};
  write_ply_mesh(path, mesh.vertices.size(), vertex_columns, corners, face_columns, comments);
}

StreetReport write_street(const std::filesystem::path& folder, StreetOptions street_options,
                          const StreetScanOptions& scan, const Executor& executor,
                          ProgressSink& progress) {
  if (street_options.length_m == 0) street_options.length_m = street_length_for(scan.points);
  const Street street = make_street(street_options);
  create_folder(folder);

  // First, because it rejects a folder with another street.
  std::optional<SemanticKittiWriter> sequence;
  if (scan.driving_spacing_m > 0 && scan.max_driving_scans > 0)
    sequence.emplace(folder / "sequences" / "00");
  save_street_mesh(folder / "mesh.ply", street);
  const StreetRecording recording = scan_street(
      street, scan,
      [&](std::size_t index, const Scan& driving) { sequence->write_scan(index, driving); },
      executor, progress);
  if (sequence) {
    sequence->finish();
    write_trajectory_csv(folder / "true_driving_trajectory.csv", recording.true_driving_trajectory);
  }
  save_cloud_ply(folder / "mapping.ply", recording.mapping);
  write_trajectory_csv(folder / "mapping_trajectory.csv", recording.mapping_trajectory);
  write_trajectory_csv(folder / "true_mapping_trajectory.csv", recording.true_mapping_trajectory);
  return {street.length_m,
          street.fixed.triangles.size(),
          street.moving.size(),
          recording.mapping.size(),
          recording.mapping_trajectory.size(),
          recording.driving_trajectory.size()};
}

}  // namespace adasplats
