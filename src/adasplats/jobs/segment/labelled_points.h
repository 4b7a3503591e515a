// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "adasplats/cloud/points/point_cloud.h"

namespace adasplats {

/// Points with the labels that a network gave them.
struct LabelledPoints {
  PointCloud cloud;                  ///< its classes are the labels
  std::vector<float> confidences;    ///< of the labels, 0 to 1; empty: not asked for
  std::vector<float> probabilities;  ///< of each of `ids`, point by point; empty: not asked for
  std::vector<std::uint16_t> ids;    ///< numbers of the classes
};

/// PLY with the columns of save_cloud_ply(), `confidence`, and `probability_N` of each class
/// number.
void save_labelled_ply(const std::filesystem::path& file, const LabelledPoints& points);

/// LAS or LAZ, as the name says, with the columns of save_cloud_las() and those two.
void save_labelled_las(const std::filesystem::path& file, const LabelledPoints& points);

/// One number a point in their order, as SemanticKITTI's .label (32 bits, little endian).
void save_labels(const std::filesystem::path& file, std::span<const std::uint32_t> labels);
/// 32-bit floats, little endian, point by point.
void save_floats(const std::filesystem::path& file, std::span<const float> values);

}  // namespace adasplats
