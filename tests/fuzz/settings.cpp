// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/jobs/segment/output_classes.h"
#include "adasplats/sensors/camera_file.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/sensors/ray_drop_model.h"
#include "fuzz_readers.h"

namespace adasplats::fuzz {

void read_lidar_file(const Input& input) {
  const LidarModel model = load_lidar_model(input.file.string());
  require(model.max_range_m > model.min_range_m && model.rotation_hz > 0, "a sensor that can be");
  require(std::isfinite(model.rotation_hz), "turns that are finite");
  for (const double elevation : model.elevations_rad)
    require(std::isfinite(elevation), "elevations that are finite");
  for (const Vec3d& origin : model.beam_origins_m)
    require(is_finite(vec_cast<float>(origin)), "origins that a float holds");
  for (const Firing& firing : model.free_pattern)
    require(is_finite(firing.direction) && std::isfinite(firing.time_s), "rays that are finite");
}

namespace {

void check_lens(const Lens& lens) {
  for (int i = 0; i < 9; ++i) {
    const double u = 0.5 * (i % 3) * lens.width, v = 0.5 * static_cast<int>(i / 3) * lens.height;
    const Vec3d direction = lens.direction(u, v);
    if (direction == Vec3d{}) continue;
    require(std::fabs(length(direction) - 1) < 1e-9, "directions of length 1");
    const auto at = project(lens, direction);
    require(!at || std::fabs(at->x - u) + std::fabs(at->y - v) <= 1e-6 * (lens.fx + lens.fy + 1e3),
            "rays that return to their pixels");
  }
}

}  // namespace

void read_camera_file(const Input& input) { check_lens(load_camera(input.file.string()).lens); }

void read_nuscenes_camera_file(const Input& input) {
  const MountedCamera camera = load_camera(input.file.string() + ":scene-0001/CAM_FRONT");
  require(is_finite(camera.vehicle_from_camera.translation), "mounts that are finite");
  check_lens(camera.lens);
}

void read_ray_drop(const Input& input) {
  for (const double weight : load_ray_drop(input.file).weights)
    require(std::isfinite(weight), "weights that are finite");
}

void read_labels(const Input& input) {
  const LabelScheme scheme = load_label_scheme(input.file.string());
  for (std::size_t k = 1; k < scheme.classes().size(); ++k)
    require(scheme.classes()[k].id > scheme.classes()[k - 1].id, "ids that ascend");
}

void read_classes_of_network(const Input& input) {
  static const std::vector<std::string> kClasses = {"road", "pole"};
  require(read_class_map(input.file, kClasses).of_network.size() == kClasses.size(),
          "an entry a class of the network");
}

}  // namespace adasplats::fuzz
