// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/words.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/jobs/output/output_folder.h"
#include "adasplats/sensors/lidar_library.h"
#include "adasplats/sensors/lidar_model.h"
#include "adasplats/simulate/captions/color_bar.h"
#include "adasplats/simulate/image/color_map.h"
#include "adasplats/simulate/image/image.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/session.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kSensorsExamples =
    "  adasplats sensors\n"
    "  adasplats sensors velodyne-vlp-16 -o pattern.png\n"
    "  adasplats sensors --show hesai-ot128 > mine.toml\n"
    "  adasplats sensors metadata.json\n";

/// What `sensors` shows of one LiDAR.
struct SensorFacts {
  std::string name;
  std::size_t beams = 0;
  std::size_t columns = 0;  ///< 0: a rosette or a list of rays
  std::size_t rays_per_scan = 0;
  double rotation_hz = 0;
  double top_deg = 0;     ///< of the highest ray
  double bottom_deg = 0;  ///< of the lowest ray
  double left_deg = 0;    ///< azimuths of the rays, -180..180
  double right_deg = 0;
  double last_time_s = 0;  ///< of the last firing
};

constexpr double kDegrees = 180 / std::numbers::pi;

double azimuth_deg(const Firing& firing) {
  return kDegrees * std::atan2(static_cast<double>(firing.direction.y),
                               static_cast<double>(firing.direction.x));
}

double elevation_deg(const Firing& firing) {
  return kDegrees * std::asin(std::clamp(static_cast<double>(firing.direction.z), -1.0, 1.0));
}

std::string signed_degrees(double degrees) { return (degrees > 0 ? "+" : "") + fixed(degrees, 2); }

std::string columns_text(const SensorFacts& facts) {
  return facts.columns == 0 ? "-" : grouped(facts.columns);
}

nlohmann::ordered_json sensor_json(const LidarModel& sensor, const SensorFacts& facts) {
  return {{"name", facts.name},
          {"beams", facts.beams},
          {"columns", facts.columns},
          {"rays_per_scan", facts.rays_per_scan},
          {"rotation_hz", facts.rotation_hz},
          {"top_deg", facts.top_deg},
          {"bottom_deg", facts.bottom_deg},
          {"min_range_m", sensor.min_range_m},
          {"max_range_m", sensor.max_range_m},
          {"range_noise_m", sensor.range_noise_m},
          {"max_returns", sensor.max_returns},
          {"clockwise", sensor.clockwise},
          {"repeats", repeats(sensor)},
          {"source", sensor.source}};
}

/// The lines of a table with texts of any length behind them, flush left.
std::string with_last_column(const std::string& table, const std::vector<std::string>& texts) {
  std::string joined;
  std::size_t begin = 0;
  for (const std::string& text : texts) {
    const std::size_t end = table.find('\n', begin);
    joined += table.substr(begin, end - begin) + "  " + text + "\n";
    begin = end + 1;
  }
  return joined;
}

/// Part of a picture that shows part of the directions.
struct Panel {
  int left_px = 0, top_px = 0, width_px = 0, height_px = 0;
  double left_deg = 0, right_deg = 0;  ///< azimuths at the edges, left > right
  double top_deg = 0, bottom_deg = 0;
  double grid_deg = 10;
};

void put(Image& image, int x, int y, Rgb color) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                              static_cast<std::size_t>(x));
  std::copy(color.begin(), color.end(), image.pixels.begin() + static_cast<std::ptrdiff_t>(at));
}

constexpr Rgb kPaper = {255, 255, 255};
constexpr Rgb kGrid = {214, 214, 214};
constexpr Rgb kAxis = {150, 150, 150};

int column_px(const Panel& panel, double degrees) {
  return panel.left_px +
         static_cast<int>(std::lround((panel.left_deg - degrees) /
                                      (panel.left_deg - panel.right_deg) * (panel.width_px - 1)));
}

int row_px(const Panel& panel, double degrees) {
  return panel.top_px +
         static_cast<int>(std::lround((panel.top_deg - degrees) /
                                      (panel.top_deg - panel.bottom_deg) * (panel.height_px - 1)));
}

/// Lines every grid_deg; those of azimuth and elevation 0 are darker.
void draw_grid(const Panel& panel, Image& image) {
  const auto from = [&](double degrees) {
    return static_cast<int>(std::ceil(degrees / panel.grid_deg));
  };
  for (int k = from(panel.right_deg); k * panel.grid_deg <= panel.left_deg; ++k)
    for (int y = 0; y < panel.height_px; ++y)
      put(image, column_px(panel, k * panel.grid_deg), panel.top_px + y, k == 0 ? kAxis : kGrid);
  for (int k = from(panel.bottom_deg); k * panel.grid_deg <= panel.top_deg; ++k)
    for (int x = 0; x < panel.width_px; ++x)
      put(image, panel.left_px + x, row_px(panel, k * panel.grid_deg), k == 0 ? kAxis : kGrid);
}

const ColorScale& time_scale() {
  static const ColorScale scale = [] {
    constexpr int kPlaces = 9;
    ColorScale places;
    for (int i = 0; i < kPlaces; ++i) {
      const Vec3f color = viridis(static_cast<float>(i) / (kPlaces - 1));
      Rgb rgb;
      for (int c = 0; c < 3; ++c)
        rgb[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(255 * color[c]));
      places.places.push_back(rgb);
    }
    return places;
  }();
  return scale;
}

/// One square of `side_px` per firing, coloured by its time.
void draw_firings(std::span<const Firing> firings, const Panel& panel, double first_s,
                  double last_s, int side_px, Image& image) {
  for (const Firing& firing : firings) {
    const double azimuth = azimuth_deg(firing);
    const double elevation = elevation_deg(firing);
    if (azimuth > panel.left_deg || azimuth < panel.right_deg || elevation > panel.top_deg ||
        elevation < panel.bottom_deg)
      continue;
    const double share = (static_cast<double>(firing.time_s) - first_s) / (last_s - first_s);
    const Rgb color = time_scale().at(share);
    const int x = column_px(panel, azimuth) - side_px / 2;
    const int y = row_px(panel, elevation) - side_px / 2;
    for (int dy = 0; dy < side_px; ++dy)
      for (int dx = 0; dx < side_px; ++dx) put(image, x + dx, y + dy, color);
  }
}

constexpr int kWidth_px = 1600;

/// The spacing for about 12 grid lines over that many degrees.
double grid_of(double degrees) {
  for (const double step : {0.5, 1.0, 2.0, 5.0, 10.0})
    if (degrees / step <= 12) return step;
  return 30;
}

/// A circle of directions around +x, or a part of the sphere in equal scales.
Image draw_whole(std::span<const Firing> firings, const SensorFacts& facts) {
  const double margin_deg = 0.03 * std::max(facts.top_deg - facts.bottom_deg, 1.0);
  Panel panel;
  panel.width_px = kWidth_px;
  panel.left_deg = std::min(facts.left_deg + margin_deg, 180.0);
  panel.right_deg = std::max(facts.right_deg - margin_deg, -180.0);
  if (!(panel.left_deg > panel.right_deg)) panel.left_deg = panel.right_deg + 1;
  panel.top_deg = facts.top_deg + margin_deg;
  panel.bottom_deg = facts.bottom_deg - margin_deg;
  const double pixels_a_degree = panel.width_px / (panel.left_deg - panel.right_deg);
  panel.height_px = std::clamp(
      static_cast<int>(std::lround(pixels_a_degree * (panel.top_deg - panel.bottom_deg))), 200,
      1600);
  panel.grid_deg = grid_of(panel.left_deg - panel.right_deg);
  constexpr int kFooter_px = 64;
  Image image{panel.width_px, panel.height_px + kFooter_px, {}};
  image.pixels.assign(
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3,
      kPaper[0]);
  draw_grid(panel, image);
  draw_firings(firings, panel, 0, std::max(facts.last_time_s, 1e-9),
               firings.size() > 30'000 ? 1 : 2, image);
  draw_color_bar(image, time_scale(),
                 {"time",
                  {{0, "0"}, {1, fixed(1e3 * facts.last_time_s, 1) + " ms"}},
                  {{kGrid, fixed(panel.grid_deg, 1) + " degrees a line"}}});
  return image;
}

/// Some columns around the front of a spinning sensor, at all elevations, coloured by the time
/// since the first of them.
Image draw_front(const LidarModel& sensor, std::span<const Firing> firings,
                 const SensorFacts& facts) {
  constexpr double kColumns = 70;
  constexpr int kHeight_px = 1000;
  constexpr int kFooter_px = 64;
  const double margin_deg = 0.02 * std::max(facts.top_deg - facts.bottom_deg, 1.0);
  const double half_deg = std::min(0.5 * kColumns * 360 / sensor.columns, 180.0);
  const Panel panel = {0,
                       0,
                       kWidth_px,
                       kHeight_px,
                       half_deg,
                       -half_deg,
                       facts.top_deg + margin_deg,
                       facts.bottom_deg - margin_deg,
                       grid_of(2 * half_deg)};
  std::vector<Firing> front;
  for (const Firing& firing : firings)
    if (std::fabs(azimuth_deg(firing)) <= half_deg) front.push_back(firing);
  Image image{kWidth_px, kHeight_px + kFooter_px, {}};
  image.pixels.assign(
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3,
      kPaper[0]);
  draw_grid(panel, image);
  // A scan that begins at the front also ends there: the last columns get negative times.
  const double period_s = 1.0 / sensor.rotation_hz;
  for (Firing& firing : front)
    if (static_cast<double>(firing.time_s) > 0.75 * period_s && sensor.first_azimuth_rad == 0)
      firing.time_s -= static_cast<float>(period_s);
  const auto [first, last] = std::ranges::minmax(front, {}, &Firing::time_s);
  const double first_s = static_cast<double>(first.time_s);
  const double last_s = std::max(static_cast<double>(last.time_s), first_s + 1e-9);
  draw_firings(front, panel, first_s, last_s, 4, image);
  draw_color_bar(image, time_scale(),
                 {"time",
                  {{0, "0"}, {1, fixed(1e3 * (last_s - first_s), 2) + " ms"}},
                  {{kGrid, fixed(panel.grid_deg, 1) + " degrees a line"}}});
  return image;
}

/// The simulated divergence, and its source.
std::string divergence_text(const LidarModel& sensor) {
  if (sensor.divergence_rad[0] + sensor.divergence_rad[1] == 0) return "unknown: one ray per beam";
  const std::string angles = fixed(kDegrees * sensor.divergence_rad[0], 3) + " x " +
                             fixed(kDegrees * sensor.divergence_rad[1], 3) +
                             " degrees between 1/e2 of the intensity";
  if (sensor.divergence_kind == DivergenceKind::unknown)
    return angles + " (assumed: the source does not define its angles)";
  return angles +
         " (the source states: " + std::string(word_of(sensor.divergence_kind, kDivergenceKinds)) +
         ")";
}

SensorFacts facts_of(const LidarModel& sensor) {
  SensorFacts facts;
  facts.name = sensor.name;
  facts.beams = sensor.rings();
  facts.columns = sensor.rosette ? 0 : sensor.columns;
  facts.rotation_hz = sensor.rotation_hz;
  facts.top_deg = facts.left_deg = -180;
  facts.bottom_deg = facts.right_deg = 180;
  const std::vector<Firing> firings = firings_of(sensor);
  facts.rays_per_scan = firings.size();
  for (const Firing& firing : firings) {
    facts.top_deg = std::max(facts.top_deg, elevation_deg(firing));
    facts.bottom_deg = std::min(facts.bottom_deg, elevation_deg(firing));
    facts.left_deg = std::max(facts.left_deg, azimuth_deg(firing));
    facts.right_deg = std::min(facts.right_deg, azimuth_deg(firing));
    facts.last_time_s = std::max(facts.last_time_s, static_cast<double>(firing.time_s));
  }
  return facts;
}

/// All sensors of the library in a table.
std::string library_table(Session& session) {
  session.report["sensors"] = nlohmann::ordered_json::array();
  TextTable table({"sensor", "beams", "columns", "rays per scan", "Hz", "elevations", "range m",
                   "noise mm", "returns"});
  std::vector<std::string> sources = {"source", "------"};
  for (const std::string& name : lidar_model_names()) {
    const LidarModel sensor = load_lidar_model(name);
    const SensorFacts facts = facts_of(sensor);
    table.add_row(
        {name, grouped(facts.beams), columns_text(facts), grouped(facts.rays_per_scan),
         fixed(facts.rotation_hz, facts.rotation_hz == std::floor(facts.rotation_hz) ? 0 : 2),
         signed_degrees(facts.bottom_deg) + " .. " + signed_degrees(facts.top_deg),
         fixed(sensor.min_range_m, 2) + " .. " + fixed(sensor.max_range_m, 0),
         fixed(1e3 * sensor.range_noise_m, 0), std::to_string(sensor.max_returns)});
    sources.push_back(sensor.source);
    session.report["sensors"].push_back(sensor_json(sensor, facts));
  }
  return with_last_column(table.text(), sources);
}

/// One sensor in lines "what  value".
std::string describe(const LidarModel& sensor, Session& session) {
  const SensorFacts facts = facts_of(sensor);
  session.report["sensor"] = sensor_json(sensor, facts);
  const auto span = [](double low, double high, const char* unit) {
    return signed_degrees(low) + " .. " + signed_degrees(high) + unit;
  };
  std::vector<std::pair<std::string, std::string>> rows = {
      {"beams", grouped(facts.beams)},
      {"columns", columns_text(facts)},
      {"rays per scan", grouped(facts.rays_per_scan)},
      {"scans per second", fixed(sensor.rotation_hz, 2)},
      {"elevations", span(facts.bottom_deg, facts.top_deg, " degrees")},
      {"azimuths", span(facts.right_deg, facts.left_deg, " degrees")},
      {"turns", sensor.rosette || sensor.columns == 0 ? "no"
                : sensor.clockwise                    ? "clockwise"
                                                      : "counter-clockwise"},
      {"last firing", fixed(1e3 * facts.last_time_s, 3) + " ms"},
      {"range", fixed(sensor.min_range_m, 2) + " .. " + fixed(sensor.max_range_m, 1) + " m"},
      {"range noise", fixed(1e3 * sensor.range_noise_m, 1) + " mm"},
      {"range resolution", fixed(1e3 * sensor.range_resolution_m, 1) + " mm"},
      {"divergence", divergence_text(sensor)},
      {"returns", std::to_string(sensor.max_returns)},
      {"repeats", repeats(sensor) ? "yes" : "no"},
      {"source", sensor.source}};
  std::string text = sensor.name + "\n";
  for (const auto& [what, value] : rows)
    text += "  " + what + std::string(18 - what.size(), ' ') + value + "\n";
  return text;
}

/// The directions of one scan, azimuth to the left and elevation up, coloured by the time of
/// firing: all of them, and for a spinning sensor a part of them below.
Image draw_pattern(const LidarModel& sensor) {
  const SensorFacts facts = facts_of(sensor);
  const std::vector<Firing> firings = firings_of(sensor);
  Image whole = draw_whole(firings, facts);
  const bool around = facts.left_deg - facts.right_deg > 300;
  if (sensor.rosette || sensor.columns == 0 || !around) return whole;
  const Image front = draw_front(sensor, firings, facts);
  whole.pixels.insert(whole.pixels.end(), front.pixels.begin(), front.pixels.end());
  whole.height += front.height;
  return whole;
}

class SensorsCommand final : public Command {
 public:
  explicit SensorsCommand(CLI::App& program)
      : Command(program, "sensors", "List LiDAR sensors, describe one, or draw its pattern",
                kSensorsExamples) {
    OptionSet& app = options();
    app.add_option("SENSOR", sensor_,
                   "Name from the list, or a file: TOML, Ouster metadata (JSON), Velodyne "
                   "calibration (YAML), Hesai angles or rays (CSV) (default: print the list)")
        ->type_name("NAME|FILE");
    app.add_flag("--show", show_,
                 "Print the TOML of a sensor of the list, as a start for your own");
    writes(add_path(app, "-o,--output", picture_, "Picture of the scan pattern to write, PNG"),
           {".png"});
  }

  void run(Session& session) override {
    if (sensor_.empty()) {
      if (show_ || !picture_.empty())
        throw Error(ErrorKind::usage,
                    std::string(show_ ? "--show" : "--output") + " requires the name of a sensor");
      print(library_table(session));
      return;
    }
    if (!picture_.empty()) check_output_file(picture_);
    const LidarModel sensor = load_lidar_model(sensor_);
    const std::string text = describe(sensor, session);
    print(show_ ? toml_of(sensor_) : text);
    if (picture_.empty()) return;
    const Image image = draw_pattern(sensor);
    write_png(picture_, image.width, image.height, image.pixels);
  }

 private:
  static std::string toml_of(const std::string& name) {
    const auto library = lidar_library();
    const auto lidar = std::ranges::find(library, name, &LibraryLidar::name);
    if (lidar == library.end())
      throw Error(ErrorKind::usage, "--show requires a sensor of the list, found the file '" +
                                        name + "'; a TOML file can hold: like = \"" + name + "\"");
    return std::string(lidar->toml);
  }

  std::string sensor_;
  bool show_ = false;
  std::filesystem::path picture_;
};

}  // namespace

std::unique_ptr<Command> make_sensors_command(CLI::App& program) {
  return std::make_unique<SensorsCommand>(program);
}

}  // namespace adasplats::app
