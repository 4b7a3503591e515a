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
#include "adasplats/splats/model/splat_colors.h"
#include "adasplats/splats/reflectance/reflectance.h"

namespace adasplats {

/// A scene of oriented disks: the paper calls it the splatted environment.
struct SplatModel {
  Vec3d origin;                        ///< world coordinates of the local origin, m
  Crs crs;                             ///< of the world coordinates, as in the input
  std::vector<Disk> disks;             ///< relative to `origin`
  std::vector<float> opacities;        ///< of soft disks (scene/soft_disk.h); empty: opaque disks
  std::vector<std::uint16_t> classes;  ///< semantic class of the seed point; empty without labels
  std::vector<SemanticGroup> groups;   ///< one per splat; empty for basic splats
  /// Reflectances if there is a `response`, else measured intensities of the seed point; empty if
  /// the points have none.
  std::vector<float> intensities;
  /// By how much the log odds that a beam returns nothing exceed those of other splats at the same
  /// range and incidence: glass, wet or black surfaces. Empty: not measured.
  std::vector<float> drop_log_odds;
  std::vector<ColorBytes> colors;  ///< of the points (colors_of_disks()); empty if they have none
  IntensityResponse response;      ///< of the sensor that measured the intensities; empty: unknown
  std::string label_scheme;        ///< name or path for load_label_scheme; may be empty
  std::string network_sha256;      ///< of the network that labelled the points; empty: none
  std::string method;              ///< how it was made
  Calibration calibration;         ///< that corrected the points; empty: uncorrected

  std::size_t size() const { return disks.size(); }
  SceneView view() const { return {disks, nullptr, opacities}; }
};

/// Local bounding box of the disks' exact extents; {0,0,0} twice for an empty model.
std::pair<Vec3f, Vec3f> bounds(const SplatModel& model);

/// The disks as opaque ones: those of a soft model with the radius within which their opacity is
/// above 0.3, which is 0 for some.
std::vector<Disk> opaque_disks(const SplatModel& model);
/// The model with the disks of opaque_disks() that have a radius.
SplatModel opaque(SplatModel model);

/// Writes a PLY file with one vertex per splat: x y z nx ny nz radius [opacity] [class] [group]
/// [intensity] [drop] [red green blue] (x y z as doubles in world coordinates if the origin is not
/// zero). Everything else is in comments "adasplats.KEY VALUE", the coordinate system in
/// crs_comments(), the label scheme in "labels"; the response in "response_ranges_m",
/// "response_range_gains", "response_cosines" and "response_cosine_gains"; the calibration in
/// "calibration_range_offsets_m", "calibration_elevation_offsets_rad", "calibration_mount"
/// (rotation vector, shift), "calibration_smooth_s" and, one per scan, "calibration_pose": time,
/// given position, rotation vector, shift.
void save_model(const std::filesystem::path& path, const SplatModel& model);

/// Reads the files of save_model, and any other PLY file with x y z nx ny nz radius. Errors: data
/// (no radius column, values that are not finite, radius <= 0, a normal whose length differs from 1
/// by more than 1e-3, an opacity outside 0 to 1, a `drop` outside -100 to 100, an incomplete
/// response or calibration). Without a response comment the response is empty.
SplatModel load_model(const std::filesystem::path& path);

}  // namespace adasplats
