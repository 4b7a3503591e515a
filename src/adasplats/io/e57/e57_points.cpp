// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/e57_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace adasplats {
namespace {

using FieldNames = std::array<std::string_view, 3>;
constexpr FieldNames kCartesian = {"cartesianX", "cartesianY", "cartesianZ"};
constexpr FieldNames kSpherical = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};

/// A field that marks others of the point as invalid by a value other than 0.
struct E57Flag {
  std::string_view field;
  std::string_view columns[3];  ///< empty: none
};

constexpr E57Flag kE57Flags[] = {{"isIntensityInvalid", {"intensity", "", ""}},
                                 {"isColorInvalid", {"red", "green", "blue"}},
                                 {"isTimeStampInvalid", {"timestamp", "", ""}}};

/// Range in metres; azimuth from x to y, elevation from the plane of x and y up, in radians.
Vec3d from_spherical(Vec3d p) {
  const double across = p.x * std::cos(p.z);
  return {across * std::cos(p.y), across * std::sin(p.y), p.x * std::sin(p.z)};
}

class ScanPoints {
 public:
  ScanPoints(PagedFile& file, const E57Scan& scan) : file_(file), scan_(scan) {
    is_spherical_ = !has_all(kCartesian);
    if (is_spherical_ && !has_all(kSpherical))
      throw data_error({file.path(), {}, {}},
                       scan.name +
                           ": its points have neither cartesianX, Y and Z nor "
                           "sphericalRange, Azimuth and Elevation as numbers");
  }

  E57Points read(const E57Section& section, const std::vector<std::string>& columns) {
    std::vector<bool> wanted(scan_.fields.size(), false);
    const auto want = [&](std::string_view field) {
      if (const auto index = number_of(field)) wanted[*index] = true;
    };
    for (const std::string_view field : is_spherical_ ? kSpherical : kCartesian) want(field);
    want(state_field());
    for (const E57Flag& flag : kE57Flags) want(flag.field);
    for (std::size_t k = 0; k < wanted.size(); ++k)
      if (std::ranges::find(columns, scan_.fields[k].column) != columns.end()) wanted[k] = true;
    values_ = read_e57_fields(file_, scan_, section, wanted);
    clear_invalid_values();
    return finished(columns);
  }

 private:
  std::optional<std::size_t> number_of(std::string_view field) const {
    for (std::size_t k = 0; k < scan_.fields.size(); ++k)
      if (scan_.fields[k].name == field && scan_.fields[k].codec != E57Codec::other) return k;
    return std::nullopt;
  }

  bool has_all(const FieldNames& names) const {
    return std::ranges::all_of(
        names, [this](std::string_view name) { return number_of(name).has_value(); });
  }

  std::string_view state_field() const {
    return is_spherical_ ? "sphericalInvalidState" : "cartesianInvalidState";
  }

  void clear_invalid_values() {
    for (const E57Flag& flag : kE57Flags) {
      const auto flags = number_of(flag.field);
      if (!flags) continue;
      for (std::size_t k = 0; k < values_.size(); ++k) {
        const std::string& column = scan_.fields[k].column;
        if (column.empty() || values_[k].empty() ||
            std::ranges::find(flag.columns, column) == std::end(flag.columns))
          continue;
        for (std::size_t i = 0; i < values_[k].size(); ++i)
          if (values_[*flags][i] != 0) values_[k][i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

  /// Transforms the points to the world in place; returns which of them have a return.
  std::vector<bool> place_points(E57Points& points) const {
    const auto state = number_of(state_field());
    std::vector<bool> has_return(points.x.size(), true);
    for (std::size_t i = 0; i < points.x.size(); ++i) {
      Vec3d p = {points.x[i], points.y[i], points.z[i]};
      if (is_spherical_) p = from_spherical(p);
      const bool is_invalid = state && values_[*state][i] != 0;
      if (is_invalid || (scan_.has_scanner && p == Vec3d{})) has_return[i] = false;
      p = scan_.world_from_scanner * p;
      points.x[i] = p.x;
      points.y[i] = p.y;
      points.z[i] = p.z;
    }
    return has_return;
  }

  E57Points finished(const std::vector<std::string>& columns) {
    const FieldNames& names = is_spherical_ ? kSpherical : kCartesian;
    E57Points points;
    points.x = std::move(values_[*number_of(names[0])]);
    points.y = std::move(values_[*number_of(names[1])]);
    points.z = std::move(values_[*number_of(names[2])]);
    const std::vector<bool> has_return = place_points(points);
    for (const std::string& column : columns) {
      const auto found = std::ranges::find(scan_.fields, column, &E57Field::column);
      points.columns.push_back(
          found == scan_.fields.end()
              ? std::vector<double>(scan_.points, std::numeric_limits<double>::quiet_NaN())
              : std::move(values_[static_cast<std::size_t>(found - scan_.fields.begin())]));
    }
    const auto drop_from = [&has_return](std::vector<double>& values) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < values.size(); ++i)
        if (has_return[i]) values[kept++] = values[i];
      values.resize(kept);
    };
    for (auto* values : {&points.x, &points.y, &points.z}) drop_from(*values);
    for (auto& values : points.columns) drop_from(values);
    points.without_return = scan_.points - points.x.size();
    return points;
  }

  PagedFile& file_;
  const E57Scan& scan_;
  bool is_spherical_ = false;
  std::vector<std::vector<double>> values_;  ///< by field; empty: not read
};

}  // namespace

E57Points read_e57_points(PagedFile& file, const E57Scan& scan, const E57Section& section,
                          const std::vector<std::string>& columns) {
  return ScanPoints(file, scan).read(section, columns);
}

}  // namespace adasplats
