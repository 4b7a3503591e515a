// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// Calibration files of Velodyne sensors: YAML of the ROS driver velodyne_pointcloud with a list
// "lasers", each laser in braces or with one key per line; and db.xml of the manufacturer, which
// VeloView also reads, in degrees and centimetres. They hold angles and offsets; the library's
// sensor with as many lasers supplies times, ranges and the rest.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <pugixml.hpp>
#include <string>

#include "adasplats/sensors/lidar_files.h"
#include "adasplats/sensors/text_fields.h"

namespace adasplats {

namespace {

const std::vector<std::string>& laser_keys() {
  static const std::vector<std::string> keys = {"dist_correction",   "dist_correction_x",
                                                "dist_correction_y", "focal_distance",
                                                "focal_slope",       "horiz_offset_correction",
                                                "laser_id",          "laser_ring",
                                                "max_intensity",     "min_intensity",
                                                "rot_correction",    "two_pt_correction_available",
                                                "vert_correction",   "vert_offset_correction"};
  return keys;
}

struct Laser {
  std::map<std::string, double, std::less<>> values;
  FilePosition place;

  double value(std::string_view key, double otherwise) const {
    const auto found = values.find(key);
    return found == values.end() ? otherwise : found->second;
  }
  double required(std::string_view key) const {
    const auto found = values.find(key);
    if (found == values.end()) throw data_error(place, "a laser without " + std::string(key));
    return found->second;
  }
  /// A plausible length; 0 if the key is missing.
  double length_m(std::string_view key) const {
    const double length = value(key, 0);
    if (!(std::fabs(length) <= kFar_m))
      throw data_error(place, std::string(key) + " is " + exact_text(length) +
                                  " m, expected at most " + exact_text(kFar_m));
    return length;
  }
  /// An angle in [-limit, limit] rad.
  double angle_rad(std::string_view key, double limit) const {
    const double angle = key == "vert_correction" ? required(key) : value(key, 0);
    if (!(std::fabs(angle) <= limit))
      throw data_error(place, std::string(key) + " is " + std::to_string(angle) +
                                  ", expected radians from -" + std::to_string(limit) + " to " +
                                  std::to_string(limit) + "; are the angles in degrees?");
    return angle;
  }
};

struct Calibration {
  std::vector<Laser> lasers;
  std::map<std::string, double, std::less<>> header;
};

/// Parses the YAML of this format, line by line.
class CalibrationReader {
 public:
  CalibrationReader(std::string_view text, const std::filesystem::path& path)
      : lines_(text, path) {}

  Calibration read() {
    while (const auto line = lines_.next()) {
      // Strips comments; no value is a text that could contain '#'.
      read_line(trimmed(line->substr(0, line->find(" #"))));
    }
    if (in_braces_) throw data_error(calibration_.lasers.back().place, "a '{' without a '}'");
    if (!list_seen_)
      throw data_error(lines_.place(), "no list 'lasers': not a Velodyne calibration");
    return std::move(calibration_);
  }

 private:
  void read_line(std::string_view line) {
    if (line == "---" || line == "...") return;
    if (line == "lasers:") {
      list_seen_ = true;
      in_laser_ = false;
    } else if (line.starts_with('-') && list_seen_) {
      if (in_braces_)
        throw data_error(lines_.place(), "a laser starts before the '}' of the previous one");
      if (calibration_.lasers.size() >= kMaxBeams)
        throw data_error(lines_.place(), "more than 65536 lasers");
      calibration_.lasers.push_back({{}, lines_.place()});
      in_laser_ = true;
      read_laser_text(trimmed(line.substr(1)));
    } else if (in_braces_ || (in_laser_ && is_laser_key(line))) {
      read_laser_text(line);
    } else {
      in_laser_ = false;
      const auto [key, value] = pair_of(line);
      calibration_.header[std::string(key)] = finite_number(value, key, lines_.place());
    }
  }

  void read_laser_text(std::string_view text) {
    if (text.starts_with('{')) {
      in_braces_ = true;
      text.remove_prefix(1);
    }
    bool closes = false;
    if (in_braces_ && text.ends_with('}')) {
      closes = true;
      text.remove_suffix(1);
    }
    for (const std::string_view field : fields_of(text, ','))
      if (!field.empty()) read_pair(field);
    if (closes) in_braces_ = false;
  }

  void read_pair(std::string_view field) {
    const auto [key, value] = pair_of(field);
    const std::string name(key);
    if (std::ranges::find(laser_keys(), name) == laser_keys().end()) {
      const auto nearest = nearest_word(name, laser_keys());
      throw data_error(lines_.place(), "unknown key " + shown(key) +
                                           (nearest ? ", did you mean '" + *nearest + "'?" : ""));
    }
    if (value == "true" || value == "false") return;
    auto& values = calibration_.lasers.back().values;
    if (!values.emplace(name, finite_number(value, key, lines_.place())).second)
      throw data_error(lines_.place(), "two values for " + name);
  }

  std::pair<std::string_view, std::string_view> pair_of(std::string_view field) const {
    const std::size_t colon = field.find(':');
    if (colon == std::string_view::npos)
      throw data_error(lines_.place(), "expected 'key: value', found " + shown(field));
    return {trimmed(field.substr(0, colon)), trimmed(field.substr(colon + 1))};
  }

  static bool is_laser_key(std::string_view line) {
    // In some files num_lasers and distance_resolution follow the list.
    const std::string_view key = trimmed(line.substr(0, line.find(':')));
    return key != "num_lasers" && key != "distance_resolution";
  }

  FilledLines lines_;
  Calibration calibration_;
  bool list_seen_ = false;
  bool in_laser_ = false;
  bool in_braces_ = false;
};

/// The group of a laser; the lasers of a group fire together or one after the other.
int group_of(int laser, int group_size) { return laser / group_size; }

/// A sensor of the library and the firing time of each of its lasers, by id.
struct Family {
  const char* name;
  double (*firing_time_us)(int laser);
};

/// The files sensors/velodyne-*.toml give the sources of the times.
std::optional<Family> family_of(const Calibration& calibration, const std::string& file_name) {
  const bool staggered = std::ranges::any_of(
      calibration.lasers, [](const Laser& laser) { return laser.value("rot_correction", 0) != 0; });
  switch (calibration.lasers.size()) {
    case 16: return Family{"velodyne-vlp-16", [](int id) { return 2.304 * id; }};
    case 32:
      if (!staggered) return Family{"velodyne-hdl-32e", [](int id) { return 1.152 * id; }};
      return Family{"velodyne-vlp-32c", [](int id) { return 2.304 * group_of(id, 2); }};
    case 64: {
      constexpr auto kS2 = [](int id) {
        constexpr double kInGroup_us[] = {0, 1.26, 2.46, 3.66};
        return 6.0 * group_of(id % 32, 4) + kInGroup_us[id % 4];
      };
      constexpr auto kS3 = [](int id) {
        constexpr double kInGroup_us[] = {0, 1.3, 2.5, 3.7};
        return 7.2 * group_of(id % 32, 4) + kInGroup_us[id % 4];
      };
      const bool is_s3 = lower_case(file_name).find("s3") != std::string::npos;
      return is_s3 ? Family{"velodyne-hdl-64e-s3", kS3} : Family{"velodyne-hdl-64e-s2", kS2};
    }
    case 128:
      return Family{"velodyne-vls-128",
                    [](int id) { return 2.665 * (group_of(id, 8) + group_of(id, 64)); }};
    default: return std::nullopt;
  }
}

/// Origin of a laser in the head's frame: its offsets are perpendicular to its beam.
/// velodyne_pointcloud computes x = right, y = forward of xy = r cos e - v sin e, z = r sin e + v
/// cos e, and shifts the result by h to the left of the beam.
Vec3d origin_of(const Laser& laser, double elevation_rad, double offset_rad) {
  const double up_m = laser.length_m("vert_offset_correction");
  const double left_m = laser.length_m("horiz_offset_correction");
  const double ahead_m = -up_m * std::sin(elevation_rad);
  const double cos = std::cos(offset_rad);
  const double sin = std::sin(offset_rad);
  return {cos * ahead_m - sin * left_m, sin * ahead_m + cos * left_m,
          up_m * std::cos(elevation_rad)};
}

void add_laser(const Laser& laser, LidarModel& model) {
  const double elevation_rad = laser.angle_rad("vert_correction", std::numbers::pi / 2);
  // The clockwise azimuth of a laser is rotation - rot_correction.
  const double offset_rad = laser.angle_rad("rot_correction", 2 * std::numbers::pi);
  model.elevations_rad.push_back(elevation_rad);
  model.azimuth_offsets_rad.push_back(offset_rad);
  model.beam_origins_m.push_back(origin_of(laser, elevation_rad, offset_rad));
}

/// The ids of the lasers; by default 0, 1, 2...
std::vector<int> laser_ids(const Calibration& calibration) {
  const auto count = calibration.lasers.size();
  std::vector<int> ids;
  std::vector<bool> seen(count, false);
  for (std::size_t i = 0; i < count; ++i) {
    const Laser& laser = calibration.lasers[i];
    const double id = laser.value("laser_id", static_cast<double>(i));
    if (!(id >= 0 && id < static_cast<double>(count)) || id != std::floor(id) ||
        seen[static_cast<std::size_t>(id)])
      throw data_error(laser.place, "laser_id is not a unique whole number from 0 to " +
                                        std::to_string(count - 1));
    seen[static_cast<std::size_t>(id)] = true;
    ids.push_back(static_cast<int>(id));
  }
  return ids;
}

/// The child of that name, or an error.
pugi::xml_node required_child(pugi::xml_node parent, const char* name,
                              const std::filesystem::path& path) {
  if (const pugi::xml_node child = parent.child(name)) return child;
  throw data_error(
      {path, std::nullopt, std::nullopt},
      "no <" + std::string(name) + "> in <" + parent.name() + ">: not a Velodyne calibration");
}

/// Stores the number of a child, if it exists, scaled by `unit`.
void put_xml_number(pugi::xml_node parent, const char* child_name, double unit, const char* key,
                    const FilePosition& place, std::map<std::string, double, std::less<>>& values) {
  if (const pugi::xml_node child = parent.child(child_name))
    values[key] = unit * finite_number(child.text().get(), child_name, place);
}

/// The enabled lasers of db.xml.
Calibration xml_calibration(const std::string& text, const std::filesystem::path& path) {
  constexpr double kCentimetre_m = 0.01, kDegree_rad = std::numbers::pi / 180;
  const FilePosition place{path, std::nullopt, std::nullopt};
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(
      text.data(), text.size(), pugi::parse_default | pugi::parse_trim_pcdata, pugi::encoding_utf8);
  if (!parsed) throw data_error(place, std::string("no well-formed XML: ") + parsed.description());
  const pugi::xml_node database = required_child(document.document_element(), "DB", path);
  std::vector<bool> enabled;
  for (const pugi::xml_node one : database.child("enabled_").children("item"))
    enabled.push_back(std::string_view(one.text().get()) != "0");
  Calibration calibration;
  put_xml_number(database, "distLSB_", kCentimetre_m, "distance_resolution", place,
                 calibration.header);
  std::size_t index = 0;
  for (const pugi::xml_node item : required_child(database, "points_", path).children("item")) {
    const std::size_t number = index++;
    if (number < enabled.size() && !enabled[number]) continue;
    const pugi::xml_node values = required_child(item, "px", path);
    Laser laser{{}, place};
    put_xml_number(values, "id_", 1, "laser_id", place, laser.values);
    put_xml_number(values, "rotCorrection_", kDegree_rad, "rot_correction", place, laser.values);
    put_xml_number(values, "vertCorrection_", kDegree_rad, "vert_correction", place, laser.values);
    put_xml_number(values, "distCorrection_", kCentimetre_m, "dist_correction", place,
                   laser.values);
    put_xml_number(values, "vertOffsetCorrection_", kCentimetre_m, "vert_offset_correction", place,
                   laser.values);
    put_xml_number(values, "horizOffsetCorrection_", kCentimetre_m, "horiz_offset_correction",
                   place, laser.values);
    if (calibration.lasers.size() >= kMaxBeams) throw data_error(place, "more than 65536 lasers");
    calibration.lasers.push_back(std::move(laser));
  }
  return calibration;
}

LidarFile lidar_of_calibration(const Calibration& calibration, const std::filesystem::path& path) {
  const FilePosition place{path, std::nullopt, std::nullopt};
  if (calibration.lasers.empty()) throw data_error(place, "the calibration has no lasers");
  const auto count = calibration.header.find("num_lasers");
  if (count != calibration.header.end() &&
      count->second != static_cast<double>(calibration.lasers.size()))
    throw data_error(place, "num_lasers is not the number of lasers, " +
                                std::to_string(calibration.lasers.size()));
  const auto family = family_of(calibration, path.filename().string());
  LidarFile file = family ? *read_library_lidar(family->name) : default_rotating_lidar();
  const std::optional<PacketLayout> packets = file.model.packets;
  file.clear_pattern();
  LidarModel& model = file.model;
  model.name = path.stem().string();
  model.source = path.filename().string() + (family ? std::string(", like ") + family->name : "");
  for (const Laser& laser : calibration.lasers) add_laser(laser, model);
  if (const auto fault = angle_fault(model)) throw data_error(place, *fault);
  const std::vector<int> ids = laser_ids(calibration);
  if (family && packets) {
    model.packets = PacketLayout{packets->format, {}, {}};
    for (const int id : ids) {
      model.firing_times_s.push_back(1e-6 * family->firing_time_us(id));
      model.packets->laser_ids.push_back(static_cast<std::uint32_t>(id));
    }
    for (const Laser& laser : calibration.lasers)
      model.packets->range_offsets_m.push_back(laser.length_m("dist_correction"));
  }
  const auto resolution = calibration.header.find("distance_resolution");
  if (resolution == calibration.header.end()) return file;
  model.range_resolution_m = resolution->second;
  if (!(model.range_resolution_m >= 0 && model.range_resolution_m <= kFar_m))
    throw data_error(place, "distance_resolution is " + exact_text(model.range_resolution_m) +
                                " m, expected 0 to " + exact_text(kFar_m));
  return file;
}

}  // namespace

LidarFile read_velodyne_yaml(std::string_view text, const std::filesystem::path& path) {
  const Calibration calibration = CalibrationReader(text, path).read();
  LidarFile file = lidar_of_calibration(calibration, path);
  const std::string name = path.filename().string();
  if (!family_of(calibration, name) && !calibration.header.contains("num_lasers"))
    throw data_error({path, std::nullopt, std::nullopt},
                     "has " + std::to_string(calibration.lasers.size()) +
                         " lasers and no num_lasers; Velodyne's sensors have 16, 32, 64 or 128: is "
                         "the file truncated?");
  return file;
}

LidarFile read_velodyne_xml(std::string_view text, const std::filesystem::path& path) {
  LidarFile file = lidar_of_calibration(xml_calibration(std::string(text), path), path);
  if (const auto fault = degrees_fault(file.model))
    throw data_error({path, std::nullopt, std::nullopt}, *fault);
  return file;
}

}  // namespace adasplats
