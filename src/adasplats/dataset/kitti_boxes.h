// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/cloud/labels/label_scheme.h"
#include "adasplats/dataset/encoded_scan.h"
#include "adasplats/simulate/scan/scan_view.h"
#include "adasplats/simulate/world/world.h"

namespace adasplats {

/// A box in the frame of a scan, with the number of its points.
struct SensedBox {
  std::string type;            ///< KITTI type: Car, Truck, Pedestrian, Cyclist, Tram, Misc
  std::uint16_t class_id = 0;  ///< of the label scheme
  std::uint16_t instance = 0;
  Vec3d center_m;          ///< sensor frame
  Vec3d size_m;            ///< length, width, height
  double yaw_rad = 0;      ///< of its length about the sensor's z, from x towards y, -pi..pi
  std::size_t points = 0;  ///< points of the scan within the box, enlarged by 5 cm
};

/// The type of a class in KITTI's object benchmark, from the words of its name ("moving-car" is a
/// Car; Misc if none matches).
std::string_view kitti_type(std::string_view class_name);

/// Transforms boxes to the frame of a scan. `labels` names the classes; without it they are Misc.
/// Boxes that are tilted in the sensor frame keep only their yaw.
std::vector<SensedBox> sensed_boxes(std::span<const ObjectBox> boxes, const ScanView& scan,
                                    const LabelScheme* labels);

/// Writes two files for scan `index`, with a line per box with at least `min_points` points:
/// - label_2/NNNNNN.txt, the format of KITTI's object benchmark: type, truncated -1, occluded 3
///   (unknown), alpha -10, 2D box -1 -1 -1 -1 (there is no image), height width length, the middle
///   of the box's bottom x y z and rotation_y in the camera frame. That frame is the LiDAR's with
///   other axes, the `Tr` of calib.txt: x right, y down, z forward, the same origin.
/// - label_velodyne/NNNNNN.txt, in the frame of the points: type, instance, center x y z, length
///   width height, yaw, number of points.
/// Metres, radians. The folders are created. Errors: cannot_create, io.
void write_kitti_boxes(const std::filesystem::path& folder, std::size_t index,
                       std::span<const SensedBox> boxes, std::size_t min_points = 1);

/// The same as bytes; names are prefixed with `folder`.
std::vector<EncodedFile> encode_kitti_boxes(const std::string& folder, std::size_t index,
                                            std::span<const SensedBox> boxes,
                                            std::size_t min_points = 1);

}  // namespace adasplats
