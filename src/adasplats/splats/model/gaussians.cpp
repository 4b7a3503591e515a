// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/model/gaussians.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/flat_gaussian.h"
#include "adasplats/scene/soft_disk.h"
#include "adasplats/splats/model/model_comments.h"

namespace adasplats {
namespace {

constexpr double kLeastOpacity = 1.0 / 255;  // what renderers skip
/// From this opacity on, a Gaussian is opaque: viewers clamp at 0.99.
constexpr double kOpaque = 0.985;

using Numbers = std::vector<double>;

Column& column(Table& table, const std::string& name) {
  const auto found = std::ranges::find(table.columns, name, &Column::name);
  return found != table.columns.end() ? *found
                                      : table.columns.emplace_back(Column{name, Numbers()});
}

void put(Table& table, const std::string& name, Numbers values) {
  column(table, name).values = std::move(values);
}

bool is_trained(const Table& table) {
  for (const char* name : {"f_dc_0", "opacity", "scale_0", "scale_1", "rot_0", "rot_3"})
    if (table.find(name) == nullptr) return false;
  return table.find("radius") == nullptr;
}

/// Properties of the PLY layout, in the order of Trained.
constexpr std::array<const char*, 11> kTrained = {"f_dc_0",  "f_dc_1",  "f_dc_2", "opacity",
                                                  "scale_0", "scale_1", "rot_0",  "rot_1",
                                                  "rot_2",   "rot_3",   "scale_2"};

constexpr std::size_t kOpacity = 3;

/// Logarithms and logits of the PLY layout as the columns of read_gltf_splats().
void activate(const std::filesystem::path& path, Table& table) {
  std::array<const Column*, kTrained.size()> from{};
  for (std::size_t k = 0; k < kTrained.size(); ++k) from[k] = table.find(kTrained[k]);
  const bool is_flat = from.back() == nullptr;
  for (std::size_t k = 0; k + 1 < from.size(); ++k)
    if (from[k] == nullptr)
      throw data_error({path, {}, {}},
                       "Gaussians without the property '" + std::string(kTrained[k]) + "'");
  constexpr std::array<const char*, 9> kMade = {
      "nx", "ny", "nz", "deviation_0", "deviation_1", "opacity", "red", "green", "blue"};
  std::array<Numbers, kMade.size()> made;
  for (std::size_t i = 0; i < table.rows; ++i) {
    std::array<double, kTrained.size()> v{};
    for (std::size_t k = 0; k < v.size(); ++k) {
      if (from[k] != nullptr) v[k] = from[k]->as_double(i);
      // The logit of an opacity of 0 or 1 is infinite.
      if (k == kOpacity ? std::isnan(v[k]) : !std::isfinite(v[k]))
        throw data_error({path, {}, {}},
                         "Gaussian " + std::to_string(i) + ": " + kTrained[k] + " is not finite");
    }
    const double norm = std::sqrt(v[6] * v[6] + v[7] * v[7] + v[8] * v[8] + v[9] * v[9]);
    if (!(norm > 0))
      throw data_error({path, {}, {}}, "Gaussian " + std::to_string(i) + ": its rotation is 0");
    const FlatGaussian flat =
        flat_gaussian({std::exp(v[4]), std::exp(v[5]), is_flat ? 0 : std::exp(v[10])},
                      rotation_from_quaternion(v[6] / norm, v[7] / norm, v[8] / norm, v[9] / norm));
    const auto color = [&](std::size_t k) {
      return std::round(255 * std::clamp(0.5 + kHarmonic0 * v[k], 0.0, 1.0));
    };
    const std::array<double, kMade.size()> row = {
        flat.normal.x, flat.normal.y, flat.normal.z,
        flat.longer,   flat.shorter,  1 / (1 + std::exp(-v[kOpacity])),
        color(0),      color(1),      color(2)};
    for (std::size_t k = 0; k < row.size(); ++k) made[k].push_back(row[k]);
  }
  for (std::size_t k = 0; k < kMade.size(); ++k) put(table, kMade[k], std::move(made[k]));
  std::erase_if(table.columns, [](const Column& of) {
    return of.name.starts_with("f_") || of.name.starts_with("scale_") ||
           of.name.starts_with("rot_");
  });
}

/// Adds what the comment "adasplats.origin X Y Z" says.
void add_origin(Table& table) {
  Vec3d origin;
  const std::string text = comment_value(table, "adasplats.origin ");
  if (std::sscanf(text.c_str(), "%lf %lf %lf", &origin.x, &origin.y, &origin.z) != 3) return;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (table.find(name) == nullptr) continue;
    Numbers values;
    for (std::size_t i = 0; i < table.rows; ++i)
      values.push_back(table.find(name)->as_double(i) + origin[axis]);
    put(table, name, std::move(values));
  }
}

}  // namespace

double gaussian_sigma(const Disk& disk, bool is_soft) {
  return static_cast<double>(is_soft ? disk.radius / kRimReach : disk.radius) *
         kGaussianSigmaOverRadius;
}

Quaternion rotation_from_z(Vec3d n) {
  const double across = std::hypot(n.x, n.y);
  if (across == 0.0) return n.z > 0 ? Quaternion{1, 0, 0, 0} : Quaternion{0, 1, 0, 0};
  // The half angles by atan2: exact near both poles, where 1 + z or 1 - z would cancel.
  const double half = 0.5 * std::atan2(across, n.z);
  const double share = std::sin(half) / across;
  return {std::cos(half), -n.y * share, n.x * share, 0};
}

float harmonic_of(std::uint8_t value) {
  return static_cast<float>((value / 255.0 - 0.5) / kHarmonic0);
}

Table disks_of_gaussians(const std::filesystem::path& path, Table table) {
  if (is_trained(table)) {
    activate(path, table);
    add_origin(table);
  }
  if (table.find("deviation_0") == nullptr) return table;
  const Column &longer = *table.find("deviation_0"), &shorter = *table.find("deviation_1"),
               &opacity = *table.find("opacity");
  std::vector<bool> kept(table.rows);
  bool is_soft = false;
  for (std::size_t i = 0; i < table.rows; ++i) {
    kept[i] = opacity.as_double(i) >= kLeastOpacity && shorter.as_double(i) > 0;
    is_soft = is_soft || (kept[i] && opacity.as_double(i) < kOpaque);
  }
  Numbers radii;
  for (std::size_t i = 0; i < table.rows; ++i)
    radii.push_back(std::sqrt(longer.as_double(i) * shorter.as_double(i)) /
                    kGaussianSigmaOverRadius * (is_soft ? static_cast<double>(kRimReach) : 1));
  const auto invisible = std::ranges::count(kept, false);
  if (table.rows > 0 && static_cast<std::size_t>(invisible) == table.rows)
    throw data_error({path, {}, {}}, "all Gaussians are invisible");
  put(table, "radius", std::move(radii));
  std::erase_if(table.columns, [&](const Column& of) {
    return of.name.starts_with("deviation_") || (of.name == "opacity" && !is_soft);
  });
  keep_rows(kept, table);
  return table;
}

}  // namespace adasplats
