// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/segment/labelled_points.h"

#include <string>

#include "adasplats/cloud/load/load_cloud.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

/// Columns that a network gives, and their names.
struct FoundColumns {
  std::vector<std::string> names;
  std::vector<ColumnView> columns;

  explicit FoundColumns(const LabelledPoints& points) {
    if (!points.confidences.empty())
      columns.push_back({"confidence", ColumnType::f32, points.confidences.data(), sizeof(float)});
    if (points.probabilities.empty()) return;
    for (const std::uint16_t id : points.ids) names.push_back("probability_" + std::to_string(id));
    for (std::size_t c = 0; c < names.size(); ++c)
      columns.push_back({names[c], ColumnType::f32, points.probabilities.data() + c,
                         names.size() * sizeof(float)});
  }
};

}  // namespace

void save_labelled_ply(const std::filesystem::path& file, const LabelledPoints& points) {
  save_cloud_ply(file, points.cloud, FoundColumns(points).columns);
}

void save_labelled_las(const std::filesystem::path& file, const LabelledPoints& points) {
  save_cloud_las(file, points.cloud, FoundColumns(points).columns);
}

void save_labels(const std::filesystem::path& path, std::span<const std::uint32_t> labels) {
  AtomicFile file(path);
  file.write(labels.data(), labels.size_bytes());
  file.commit();
}

void save_floats(const std::filesystem::path& path, std::span<const float> values) {
  AtomicFile file(path);
  file.write(values.data(), values.size_bytes());
  file.commit();
}

}  // namespace adasplats
