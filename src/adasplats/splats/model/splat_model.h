// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/cloud/sequence/calibration.h"
#include "adasplats/core/maths/vec3.h"
#include "adasplats/io/base/crs.h"
#include "adasplats/scene/scene.h"
#include "adasplats/splats/reflectance/reflectance.h"

namespace adasplats {

/// A place as oriented disks: what the paper calls the splatted environment.
struct SplatModel {
  Vec3d origin;                        ///< world coordinates of the local origin, m
  Crs crs;                             ///< of the world coordinates, as the points had it
  std::vector<Disk> disks;             ///< relative to `origin`
  std::vector<std::uint16_t> classes;  ///< semantic class of the seed point; empty without labels
  std::vector<SemanticGroup> groups;   ///< one a splat; empty for basic splats
  /// Reflectances where there is a `response`, else measured intensities of the seed point; empty
  /// without.
  std::vector<float> intensities;
  IntensityResponse response;  ///< of the sensor that measured the intensities; empty: not known
  std::string label_scheme;    ///< name or path as load_label_scheme takes it; may be empty
  std::string network_sha256;  ///< of the network that gave the points classes; empty: none did
  std::string method;          ///< how it was made
  Calibration calibration;     ///< that the points were corrected with; empty: they are as given

  std::size_t size() const { return disks.size(); }
  SceneView view() const { return {disks, nullptr}; }
};

/// Local bounding box of the disks' exact extents; {0,0,0} twice for an empty model.
std::pair<Vec3f, Vec3f> bounds(const SplatModel& model);

/// Writes a PLY, one vertex a splat: x y z nx ny nz radius [class] [group] [intensity] (x y z as
/// doubles in world coordinates where the origin is not zero). The rest is in comments
/// "adasplats.KEY VALUE", the coordinate system in crs_comments(), the scheme in "labels"; the
/// response in "response_ranges_m",
/// "response_range_gains", "response_cosines" and "response_cosine_gains"; the calibration in
/// "calibration_range_offsets_m", "calibration_elevation_offsets_rad", "calibration_mount"
/// (rotation vector, shift), "calibration_smooth_s" and, one a scan, "calibration_pose": time,
/// given position, rotation vector, shift.
void save_model(const std::filesystem::path& path, const SplatModel& model);

/// Reads what save_model wrote, and any PLY with x y z nx ny nz radius. Errors: data (no radius
/// column, values not finite, radius <= 0, normal not of unit length to 1e-3, a response or
/// calibration that is not complete). Without a response comment the response is empty.
SplatModel load_model(const std::filesystem::path& path);

}  // namespace adasplats
