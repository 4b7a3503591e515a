// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// The metadata that Ouster sensors and the Ouster SDK write: JSON, with all keys on one level (up
// to firmware 2.x) or in groups (beam_intrinsics, lidar_data_format...). Geometry: Ouster Sensor
// Documentation, "Coordinate Frames and XYZ Calculation".

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/sensors/lidar_files.h"

namespace adasplats {

namespace {

using Json = nlohmann::json;

constexpr double kMillimetre_m = 1e-3;

/// The keys of the file, on the top level or in a group.
class Metadata {
 public:
  Metadata(std::string_view text, const std::filesystem::path& path) : path_(path) {
    try {
      json_ = Json::parse(text);
    } catch (const Json::parse_error& error) {
      throw error_at_byte(text, error.byte);
    } catch (const Json::exception& error) {
      throw fault(std::string("is not valid JSON: ") + error.what());  // a number out of range
    }
    if (!json_.is_object()) throw fault("is not a JSON object");
  }

  Error fault(const std::string& message) const {
    return {ErrorKind::data, path_.string() + ": " + message};
  }

  /// nullptr if the key is missing.
  const Json* find(const char* key) const {
    if (const auto found = json_.find(key); found != json_.end()) return &*found;
    for (const auto& [group, values] : json_.items())
      if (values.is_object())
        if (const auto found = values.find(key); found != values.end()) return &*found;
    return nullptr;
  }

  /// Finite numbers; empty if the key is missing.
  std::vector<double> numbers(const char* key) const {
    const Json* list = find(key);
    if (list == nullptr) return {};
    if (!list->is_array()) throw fault(std::string(key) + " is not a list of numbers");
    std::vector<double> numbers;
    for (const Json& each : *list) {
      if (!each.is_number() || !std::isfinite(each.get<double>()))
        throw fault(std::string(key) + " is not a list of numbers");
      numbers.push_back(each.get<double>());
    }
    return numbers;
  }

  std::string text(const char* key) const {
    const Json* value = find(key);
    return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
  }

 private:
  Error error_at_byte(std::string_view text, std::size_t byte) const {
    const std::string_view before = text.substr(0, byte == 0 ? 0 : byte - 1);
    const auto lines = static_cast<std::uint64_t>(std::count(before.begin(), before.end(), '\n'));
    return data_error({path_, std::nullopt, lines + 1}, "not valid JSON");
  }

  std::filesystem::path path_;
  Json json_;
};

std::vector<double> beam_angles_rad(const Metadata& metadata, const char* key, double limit_deg) {
  std::vector<double> angles = metadata.numbers(key);
  if (angles.empty())
    throw metadata.fault(std::string("no ") + key + ": expected the metadata of an Ouster sensor");
  if (angles.size() > kMaxBeams)
    throw metadata.fault(std::string(key) + " has more than 65536 beams");
  for (double& angle : angles) {
    if (!(std::fabs(angle) <= limit_deg))
      throw metadata.fault(std::string(key) + " has an angle of " + std::to_string(angle) +
                           " degrees");
    angle = radians(angle);
  }
  return angles;
}

/// "1024x10": columns and revolutions per second.
void read_mode(const Metadata& metadata, LidarModel& model) {
  const std::string mode = metadata.text("lidar_mode");
  const std::size_t cross = mode.find('x');
  std::optional<std::uint32_t> columns;
  std::optional<double> rotation_hz;
  if (cross != std::string::npos) {
    columns = parse_number<std::uint32_t>(std::string_view(mode).substr(0, cross));
    rotation_hz = parse_number<double>(std::string_view(mode).substr(cross + 1));
  }
  if (!columns || *columns < 1 || *columns > kMaxColumns || !rotation_hz ||
      !(*rotation_hz > 0 && *rotation_hz <= 1e6))
    throw metadata.fault("lidar_mode is " + shown(mode) +
                         ", expected columns x Hz, for example '1024x10'");
  model.columns = *columns;
  model.rotation_hz = *rotation_hz;
}

/// A 4 x 4 matrix by rows; the identity if the key is missing.
std::vector<double> matrix_of(const Metadata& metadata, const char* key) {
  std::vector<double> matrix = metadata.numbers(key);
  if (matrix.empty()) matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  if (matrix.size() != 16)
    throw metadata.fault(std::string(key) + " has " + std::to_string(matrix.size()) +
                         " numbers, expected 16");
  return matrix;
}

/// Of metadata without lidar_origin_to_beam_origin_mm, as Ouster's SDK assumes
/// (default_lidar_origin_to_beam_origin): that of the first generation unless prod_line states one.
double default_beam_origin_mm(const std::string& line) {
  if (line.starts_with("OS-0-")) return 27.67;
  if (line.starts_with("OS-1-")) return 15.806;
  if (line.starts_with("OS-2-")) return 13.762;
  return 12.163;
}

/// The beams' origin relative to the sensor's axis, x along the encoder's azimuth; m.
Vec3d beam_origin(const Metadata& metadata) {
  const std::vector<double> matrix = matrix_of(metadata, "beam_to_lidar_transform");
  if (metadata.find("beam_to_lidar_transform") != nullptr)
    return kMillimetre_m * Vec3d{matrix[3], matrix[7], matrix[11]};
  const Json* along_mm = metadata.find("lidar_origin_to_beam_origin_mm");
  if (along_mm == nullptr)
    return {kMillimetre_m * default_beam_origin_mm(metadata.text("prod_line")), 0, 0};
  if (!along_mm->is_number())
    throw metadata.fault("lidar_origin_to_beam_origin_mm is not a number");
  return {kMillimetre_m * along_mm->get<double>(), 0, 0};
}

/// Rotates the lidar frame, with x towards the connector, into the sensor frame.
void read_frames(const Metadata& metadata, LidarModel& model) {
  std::vector<double> matrix = metadata.numbers("lidar_to_sensor_transform");
  // The default of older files: half a revolution, and the height of the first generation.
  if (matrix.empty()) matrix = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1};
  if (matrix.size() != 16 || std::fabs(matrix[10] - 1) > 1e-6 ||
      std::fabs(std::hypot(matrix[0], matrix[4]) - 1) > 1e-6)
    throw metadata.fault("lidar_to_sensor_transform is not a rotation about z");
  if (std::hypot(matrix[3], matrix[7]) > 1e-6)
    throw metadata.fault("lidar_to_sensor_transform moves the axis off the sensor's origin");
  model.first_azimuth_rad = std::atan2(matrix[4], matrix[0]);
  const Vec3d origin = beam_origin(metadata) + Vec3d{0, 0, kMillimetre_m * matrix[11]};
  if (!(length(origin) <= kFar_m))
    throw metadata.fault("its beams start " + exact_text(length(origin)) +
                         " m away from the sensor");
  model.beam_origins_m.assign(model.elevations_rad.size(), origin);
}

/// Profiles with the same bytes up to the reflectivity are one format.
constexpr std::pair<std::string_view, PacketFormat> kProfiles[] = {
    {"LEGACY", PacketFormat::ouster_legacy},
    {"RNG19_RFL8_SIG16_NIR16", PacketFormat::ouster_single},
    {"RNG19_RFL8_SIG16_NIR16_DUAL", PacketFormat::ouster_dual},
    {"RNG15_RFL8_NIR8", PacketFormat::ouster_low},
    {"RNG15_RFL8_NIR8_DUAL", PacketFormat::ouster_low_dual},
    {"FUSA_RNG15_RFL8_NIR8_DUAL", PacketFormat::ouster_low_dual},
    {"RNG15_RFL8_WIN8", PacketFormat::ouster_low},
    {"RNG19_RFL8_SIG16_NIR16_ZONE16", PacketFormat::ouster_single},
    {"RNG19_RFL8_SIG16_ZONE16_DUAL", PacketFormat::ouster_dual}};

/// A whole number from 1; 0 if the key is missing.
std::uint64_t count_of(const Metadata& metadata, const char* key, std::uint64_t max) {
  const Json* value = metadata.find(key);
  if (value == nullptr) return 0;
  if (!value->is_number_unsigned() || *value < 1 || *value > max)
    throw metadata.fault(std::string(key) + " is " + value->dump() + ", expected 1 to " +
                         std::to_string(max));
  return value->get<std::uint64_t>();
}

/// The packets of the metadata's profile. Older metadata have no profile and mean LEGACY. Ranges in
/// packets start at the axis.
void read_packet_layout(const Metadata& metadata, LidarModel& model) {
  constexpr std::uint64_t kMaxColumnsOfPacket = 64;
  std::string profile = metadata.text("udp_profile_lidar");
  if (profile.empty()) profile = "LEGACY";
  const auto* const known =
      std::ranges::find(kProfiles, profile, &std::pair<std::string_view, PacketFormat>::first);
  if (known == std::end(kProfiles)) {
    model.packet_profile = profile;
    return;
  }
  PacketLayout& layout = model.packets.emplace();
  layout.format = known->second;
  layout.columns = count_of(metadata, "columns_per_packet", kMaxColumnsOfPacket);
  const std::string header = metadata.text("header_type");
  layout.has_safety_head = header == "FUSA" || (header.empty() && profile.starts_with("FUSA"));
  layout.serial = parse_number<std::uint64_t>(metadata.text("prod_sn")).value_or(0);
  const Vec3d along = beam_origin(metadata);
  const std::size_t beams = model.elevations_rad.size();
  layout.range_offsets_m.assign(beams, -std::hypot(along.x, along.z));
  for (std::size_t beam = 0; beam < beams; ++beam)
    layout.laser_ids.push_back(static_cast<std::uint32_t>(beam));
}

/// The library's sensor with the same optics: ranges, noise, divergence.
LidarFile base_of(const std::string& product_line, std::size_t beams) {
  if (product_line.starts_with("OS-0")) return *read_library_lidar("ouster-os0-128");
  if (product_line.starts_with("OS-2")) return *read_library_lidar("ouster-os2-128");
  if (product_line.starts_with("OS-1"))
    return *read_library_lidar(beams == 128 ? "ouster-os1-128" : "ouster-os1-64");
  return default_rotating_lidar();
}

/// Removes the entries of `values` that are not kept.
template <class T>
void keep_beams(std::vector<T>& values, const std::vector<bool>& kept) {
  std::size_t beam = 0;
  std::erase_if(values, [&](const T&) { return !kept[beam++]; });
}

/// The number of beams in the product line: 16 of "OS-1-16-A0"; nothing if it has none.
std::optional<std::size_t> beams_of_product(const std::string& line) {
  if (!line.starts_with("OS-")) return std::nullopt;
  const std::size_t dash = line.find('-', 3);
  if (dash == std::string::npos) return std::nullopt;
  return parse_number<std::size_t>(
      std::string_view(line).substr(dash + 1, line.find('-', dash + 1) - dash - 1));
}

/// Sensors of 16 and 32 beams have lists of 64 up to firmware 1.13: every fourth or second entry is
/// a beam, the others are 0, or up to firmware 1.12 angles of beams that do not exist. Packets have
/// all 64. Errors: data if the others are not those of the product.
void drop_padding(const Metadata& metadata, const std::string& line, LidarModel& model) {
  const std::size_t listed = model.elevations_rad.size();
  if (const auto fault = degrees_fault(model)) throw metadata.fault(*fault);
  std::vector<bool> kept(listed);
  for (std::size_t beam = 0; beam < listed; ++beam)
    kept[beam] = model.elevations_rad[beam] != 0 || model.azimuth_offsets_rad[beam] != 0;
  constexpr std::size_t kPadded = 64;
  const std::size_t stated = beams_of_product(line).value_or(listed);
  if (listed == kPadded && (stated == 16 || stated == 32) && std::ranges::count(kept, false) == 0)
    for (std::size_t beam = 0; beam < listed; ++beam)
      kept[beam] = (beam + 1) % (kPadded / stated) == 0;
  const auto real = static_cast<std::size_t>(std::ranges::count(kept, true));
  const std::size_t product = beams_of_product(line).value_or(listed - real > 1 ? real : listed);
  const bool is_padded = listed - real > 1 && real > 0 && listed != product;
  const std::size_t found = is_padded ? real : listed;
  if (found != product && real > 0)
    throw metadata.fault("beam_altitude_angles and beam_azimuth_angles have " +
                         std::to_string(found) + (is_padded ? " beams that are not 0" : " beams") +
                         ", prod_line is " + shown(line));
  if (is_padded) {
    keep_beams(model.elevations_rad, kept);
    keep_beams(model.azimuth_offsets_rad, kept);
    keep_beams(model.beam_origins_m, kept);
    if (model.packets) {
      keep_beams(model.packets->laser_ids, kept);
      keep_beams(model.packets->range_offsets_m, kept);
      model.packets->lasers = listed;
    }
  }
  if (const auto fault = angle_fault(model)) throw metadata.fault(*fault);
}

/// The columns that the sensor measures: [first, last] of column_window.
void read_window(const Metadata& metadata, LidarModel& model) {
  const std::vector<double> window = metadata.numbers("column_window");
  if (window.empty()) return;
  const auto is_column = [&](double column) {
    return column >= 0 && column < model.columns && column == std::floor(column);
  };
  if (window.size() != 2 || !std::ranges::all_of(window, is_column))
    throw metadata.fault("column_window is not [first, last] of " + std::to_string(model.columns) +
                         " columns (lidar_mode)");
  const double columns = model.columns;
  if (std::fmod(window[1] + 1 - window[0] + columns, columns) == 0) return;  // all of them
  model.window_begin = window[0] / columns;
  model.window_end = (window[1] + 1) / columns;
}

}  // namespace

LidarFile read_ouster_json(std::string_view text, const std::filesystem::path& path) {
  const Metadata metadata(text, path);
  std::vector<double> elevations_rad = beam_angles_rad(metadata, "beam_altitude_angles", 90);
  std::vector<double> azimuths_rad = beam_angles_rad(metadata, "beam_azimuth_angles", 360);
  if (elevations_rad.size() != azimuths_rad.size())
    throw metadata.fault("beam_altitude_angles has " + std::to_string(elevations_rad.size()) +
                         " beams, beam_azimuth_angles " + std::to_string(azimuths_rad.size()));
  const std::string line = metadata.text("prod_line");
  LidarFile file = base_of(line, elevations_rad.size());
  file.clear_pattern();
  LidarModel& model = file.model;
  model.name = path.stem().string();
  const std::string serial = metadata.text("prod_sn");
  model.source = path.filename().string() + (line.empty() ? "" : ", " + line) +
                 (serial.empty() ? "" : " " + serial);
  model.elevations_rad = std::move(elevations_rad);
  for (const double azimuth_rad : azimuths_rad) model.azimuth_offsets_rad.push_back(-azimuth_rad);
  model.clockwise = true;
  if (metadata.text("udp_profile_lidar").ends_with("_DUAL")) model.max_returns = 2;
  read_mode(metadata, model);
  read_frames(metadata, model);
  read_packet_layout(metadata, model);
  drop_padding(metadata, line, model);
  read_window(metadata, model);
  return file;
}

std::string ouster_profiles() {
  std::string list;
  for (const auto& [profile, format] : kProfiles)
    list += (list.empty() ? "" : ", ") + std::string(profile);
  return list;
}

}  // namespace adasplats
