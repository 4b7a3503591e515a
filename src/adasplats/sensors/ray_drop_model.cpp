// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/sensors/ray_drop_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "adasplats/core/constants.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/toml_nodes.h"
#include "adasplats/sensors/toml_table.h"

namespace adasplats {
namespace {

const TomlKeys& ray_drop_keys() {
  static const TomlKeys keys = {"fitted_to", "usual_reflectance", "weights", "edge_runs",
                                "blocked"};
  return keys;
}

/// Rounded to 1e-4 degrees, which suffices for a sector (pi as a float is more than 180 degrees).
std::string degrees_text(float angle_rad) {
  return exact_text(std::round(static_cast<double>(angle_rad) / kDegree * 1e4) / 1e4);
}

template <class Numbers>
std::string list_text(const Numbers& numbers) {
  std::string text;
  for (const double number : numbers) {
    text += text.empty() ? "" : ", ";
    text += exact_text(number);
  }
  return "[" + text + "]";
}

/// One table for the sectors of each elevation.
std::string blocked_text(const std::vector<BlockedSector>& blocked, const std::string& prefix) {
  std::string text;
  for (std::size_t i = 0; i < blocked.size(); ++i) {
    const bool continues = i > 0 && blocked[i].elevation_rad == blocked[i - 1].elevation_rad;
    if (!continues) {
      text += i == 0 ? "" : "]\n";
      text += "\n[[" + prefix + "blocked]]\nelevation_deg = ";
      text += degrees_text(blocked[i].elevation_rad) + "\nazimuths_deg = [";
    } else {
      text += ", ";
    }
    text += std::string("[") + degrees_text(blocked[i].azimuth_begin_rad) + ", " +
            degrees_text(blocked[i].azimuth_end_rad) + "]";
  }
  return blocked.empty() ? text : text + "]\n";
}

/// A TOML string.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result + "\"";
}

/// A list of any length, or of `count` elements if that is not 0.
const toml::array& array_of(const TomlTable& table, const toml::node& node, const std::string& key,
                            std::size_t count = 0) {
  const toml::array* list = node.as_array();
  if (list == nullptr || (count > 0 && list->size() != count))
    throw table.error_at(node, key + " is not a list" +
                                   (count > 0 ? " of " + std::to_string(count) : std::string()));
  return *list;
}

std::vector<double> edge_runs_of(const TomlTable& table, const toml::node& node) {
  std::vector<double> shares;
  double sum = 0;
  for (const toml::node& element : array_of(table, node, "edge_runs")) {
    shares.push_back(table.number_of(element, "edge_runs", 0, 1));
    sum += shares.back();
  }
  if (shares.size() > kMaxEdgeRun)
    throw table.error("edge_runs", "has " + std::to_string(shares.size()) +
                                       " shares, expected at most " + std::to_string(kMaxEdgeRun));
  if (sum > 1) throw table.error("edge_runs", "has shares with a sum above 1");
  return shares;
}

std::vector<BlockedSector> sectors_of(const TomlTable& table, const toml::node& node) {
  const auto angle_rad = [&](const toml::node& angle, const char* key) {
    return static_cast<float>(table.number_of(angle, key, -180, 180) * kDegree);
  };
  std::vector<BlockedSector> sectors;
  for (const toml::node& element : array_of(table, node, "blocked")) {
    const toml::table* sector = element.as_table();
    const toml::node* elevation = sector == nullptr ? nullptr : sector->get("elevation_deg");
    const toml::node* azimuths = sector == nullptr ? nullptr : sector->get("azimuths_deg");
    if (elevation == nullptr || azimuths == nullptr)
      throw table.error_at(element, "blocked needs elevation_deg and azimuths_deg");
    for (const toml::node& pair : array_of(table, *azimuths, "azimuths_deg")) {
      const toml::array& ends = array_of(table, pair, "azimuths_deg", 2);
      sectors.push_back({angle_rad(*elevation, "elevation_deg"), angle_rad(ends[0], "azimuths_deg"),
                         angle_rad(ends[1], "azimuths_deg")});
    }
  }
  const auto before = [](const BlockedSector& a, const BlockedSector& b) {
    return a.elevation_rad != b.elevation_rad ? a.elevation_rad < b.elevation_rad
                                              : a.azimuth_begin_rad < b.azimuth_begin_rad;
  };
  std::stable_sort(sectors.begin(), sectors.end(), before);
  return sectors;
}

RayDropModel ray_drop_of(const TomlTable& table) {
  RayDropModel model;
  model.fitted_to = table.text("fitted_to", "");
  model.usual_reflectance = table.number("usual_reflectance", model.usual_reflectance, 0, 1e9);
  table.require("weights");
  const toml::array& weights =
      array_of(table, *table.find("weights"), "weights", std::size_t{kDropFeatures});
  for (std::size_t k = 0; k < weights.size(); ++k)
    model.weights[k] = table.number_of(weights[k], "weights", -1e9, 1e9);
  if (const toml::node* node = table.find("edge_runs"))
    model.edge_runs = edge_runs_of(table, *node);
  if (const toml::node* node = table.find("blocked")) model.blocked = sectors_of(table, *node);
  return model;
}

}  // namespace

bool RayDropModel::blocks(Vec3f direction) const {
  if (blocked.empty() || direction == Vec3f{}) return false;
  constexpr auto kHalfTurn = static_cast<float>(std::numbers::pi);
  constexpr double kMaxApart_rad = 0.3 * kDegree;  // beams of an HDL-64E are farther apart
  const auto elevation = static_cast<float>(
      std::atan2(static_cast<double>(direction.z),
                 std::hypot(static_cast<double>(direction.x), static_cast<double>(direction.y))));
  const auto below = [](const BlockedSector& sector, float value) {
    return sector.elevation_rad < value;
  };
  auto first = std::lower_bound(blocked.begin(), blocked.end(), elevation, below);
  if (first == blocked.end() ||
      (first != blocked.begin() &&
       elevation - std::prev(first)->elevation_rad < first->elevation_rad - elevation)) {
    first = std::lower_bound(blocked.begin(), first, std::prev(first)->elevation_rad, below);
  }
  const float nearest = first->elevation_rad;
  if (std::fabs(static_cast<double>(nearest - elevation)) > kMaxApart_rad) return false;
  const auto azimuth = static_cast<float>(
      std::atan2(static_cast<double>(direction.y), static_cast<double>(direction.x)));
  for (; first != blocked.end() && first->elevation_rad == nearest; ++first) {
    // The azimuth pi belongs to the sector that ends there.
    const bool before_end = azimuth < first->azimuth_end_rad || first->azimuth_end_rad >= kHalfTurn;
    if (azimuth >= first->azimuth_begin_rad && before_end) return true;
  }
  return false;
}

std::string ray_drop_toml(const RayDropModel& model, const std::string& prefix) {
  std::string text =
      "# Probability that an echo is dropped: logistic(weights * (1, r, "
      "r^2, log r,\n# 1 - cos, (1 - cos)^2, log reflectance, r * log reflectance)), "
      "r in units of 10 m, cos of the\n# incidence; always in blocked directions.\n";
  text += "fitted_to = " + quoted(model.fitted_to) + "\n";
  text += "usual_reflectance = " + exact_text(model.usual_reflectance) + "\n";
  text += "weights = " + list_text(model.weights) + "\n";
  if (!model.edge_runs.empty())
    text +=
        "# Of edges of 0.5 m and more between neighbouring beams: the shares at which 1, 2, ... "
        "beams are\n# lost. The weights are of the other beams.\nedge_runs = " +
        list_text(model.edge_runs) + "\n";
  return text + blocked_text(model.blocked, prefix);
}

RayDropModel read_ray_drop_table(const TomlTable& parent, std::string_view key) {
  return ray_drop_of(parent.table(key, ray_drop_keys()));
}

void save_ray_drop(const std::filesystem::path& path, const RayDropModel& model) {
  write_file(path, ray_drop_toml(model));
}

RayDropModel load_ray_drop(const std::filesystem::path& path) {
  return ray_drop_of(parse_toml(read_file(path), path, ray_drop_keys(), "ray drop model"));
}

}  // namespace adasplats
