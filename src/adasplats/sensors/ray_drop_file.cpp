// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// A ray drop model as a TOML file, or a table of one.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/sensors/ray_drop_model.h"
#include "adasplats/sensors/ray_drop_toml.h"

namespace adasplats {
namespace {

const std::vector<std::string>& known_keys() {
  static const std::vector<std::string> keys = {"fitted_to", "usual_reflectance", "weights",
                                                "edge_runs", "blocked"};
  return keys;
}

/// Rounded to what a sector needs: a ten-thousandth of a degree (half a turn in floats is more than
/// 180).
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

/// Sectors of one elevation as one table.
std::string blocked_text(const std::vector<BlockedSector>& blocked, const std::string& prefix) {
  std::string text;
  for (std::size_t i = 0; i < blocked.size(); ++i) {
    const bool goes_on = i > 0 && blocked[i].elevation_rad == blocked[i - 1].elevation_rad;
    if (!goes_on) {
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

/// A string as TOML writes it.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result + "\"";
}

/// Reads the keys of one table; each error has the line of what is wrong.
class DropTable {
 public:
  DropTable(const toml::table& table, const std::filesystem::path& path)
      : path_(path), table_(table) {
    for (const auto& [key, value] : table_) {
      const std::string name(key.str());
      if (std::ranges::find(known_keys(), name) != known_keys().end()) continue;
      const auto nearest = nearest_word(name, known_keys());
      throw error_at(key.source(), std::string("unknown key '") + name + "'" +
                                       (nearest ? ", did you mean '" + *nearest + "'?" : ""));
    }
  }

  RayDropModel model() const {
    RayDropModel model;
    if (const toml::node* node = table_.get("fitted_to")) {
      if (!node->is_string()) throw error_at(node->source(), "fitted_to is not a string");
      model.fitted_to = node->value_or(std::string());
    }
    if (const toml::node* node = table_.get("usual_reflectance"))
      model.usual_reflectance = number_of(*node, "usual_reflectance", 0, 1e9);
    const toml::node* weights = table_.get("weights");
    if (weights == nullptr) throw Error(ErrorKind::config, path_.string() + ": weights is missing");
    const toml::array& list = array_of(*weights, "weights", std::size_t{kDropFeatures});
    for (std::size_t k = 0; k < list.size(); ++k)
      model.weights[k] = number_of(list[k], "weights", -1e9, 1e9);
    if (const toml::node* node = table_.get("edge_runs")) model.edge_runs = runs_of(*node);
    if (const toml::node* node = table_.get("blocked")) model.blocked = sectors_of(*node);
    return model;
  }

 private:
  Error error_at(const toml::source_region& place, const std::string& message) const {
    return Error(ErrorKind::config,
                 path_.string() + ":" + std::to_string(place.begin.line) + ": " + message);
  }

  double number_of(const toml::node& node, const char* key, double low, double high) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !(*value >= low && *value <= high))
      throw error_at(node.source(), std::string(key) + " is not a number from " + exact_text(low) +
                                        " to " + exact_text(high));
    return *value;
  }

  /// `count` = 0: any.
  const toml::array& array_of(const toml::node& node, const char* key, std::size_t count) const {
    const toml::array* list = node.as_array();
    if (list == nullptr || (count > 0 && list->size() != count))
      throw error_at(node.source(),
                     std::string(key) + " is not a list" +
                         (count > 0 ? std::string(" of ") + std::to_string(count) : ""));
    return *list;
  }

  std::vector<double> runs_of(const toml::node& node) const {
    std::vector<double> shares;
    double sum = 0;
    for (const toml::node& element : array_of(node, "edge_runs", 0)) {
      shares.push_back(number_of(element, "edge_runs", 0, 1));
      sum += shares.back();
    }
    if (shares.size() > kMaxEdgeRun)
      throw error_at(node.source(), "edge_runs has " + std::to_string(shares.size()) +
                                        " shares, expected at most " + std::to_string(kMaxEdgeRun));
    if (sum > 1) throw error_at(node.source(), "edge_runs has shares of more than 1 together");
    return shares;
  }

  float angle_rad(const toml::node& node, const char* key) const {
    return static_cast<float>(number_of(node, key, -180, 180) * kDegree);
  }

  std::vector<BlockedSector> sectors_of(const toml::node& node) const {
    std::vector<BlockedSector> sectors;
    for (const toml::node& element : array_of(node, "blocked", 0)) {
      const toml::table* table = element.as_table();
      const toml::node* elevation = table == nullptr ? nullptr : table->get("elevation_deg");
      const toml::node* azimuths = table == nullptr ? nullptr : table->get("azimuths_deg");
      if (elevation == nullptr || azimuths == nullptr)
        throw error_at(element.source(), "blocked needs elevation_deg and azimuths_deg");
      for (const toml::node& pair : array_of(*azimuths, "azimuths_deg", 0)) {
        const toml::array& ends = array_of(pair, "azimuths_deg", 2);
        sectors.push_back({angle_rad(*elevation, "elevation_deg"),
                           angle_rad(ends[0], "azimuths_deg"), angle_rad(ends[1], "azimuths_deg")});
      }
    }
    const auto before = [](const BlockedSector& a, const BlockedSector& b) {
      return a.elevation_rad != b.elevation_rad ? a.elevation_rad < b.elevation_rad
                                                : a.azimuth_begin_rad < b.azimuth_begin_rad;
    };
    std::stable_sort(sectors.begin(), sectors.end(), before);
    return sectors;
  }

  const std::filesystem::path& path_;
  const toml::table& table_;
};

}  // namespace

std::string ray_drop_toml(const RayDropModel& model, const std::string& prefix) {
  std::string text =
      "# How likely a beam that met something is not told: logistic(weights * (1, r, "
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

RayDropModel ray_drop_of_table(const toml::table& table, const std::filesystem::path& path) {
  return DropTable(table, path).model();
}

void save_ray_drop(const std::filesystem::path& path, const RayDropModel& model) {
  write_file(path, ray_drop_toml(model));
}

RayDropModel load_ray_drop(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  // toml++ frees nested tables by recursion and does not bound the depth of dotted keys.
  constexpr std::ptrdiff_t kMaxDots = 8192;
  if (std::ranges::count(text, '.') > kMaxDots)
    throw Error(ErrorKind::config, path.string() + ": too large for a ray drop");
  try {
    return ray_drop_of_table(toml::parse(text), path);
  } catch (const toml::parse_error& error) {
    throw Error(ErrorKind::config, path.string() + ":" + std::to_string(error.source().begin.line) +
                                       ": " + std::string(error.description()));
  }
}

}  // namespace adasplats
