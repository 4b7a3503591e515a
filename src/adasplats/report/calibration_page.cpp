// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "adasplats/report/report_page.h"
#include "adasplats/report/results.h"
#include "adasplats/report/text_format.h"

namespace adasplats {
namespace page {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr double kCentimetres = 100;
constexpr double kMillimetres = 1000;

/// The numbers of a list; NaN for other elements.
std::vector<double> list_at(const Json& json, const KeyPath& path) {
  std::vector<double> list;
  const Json* found = find(json, path);
  if (found == nullptr || !found->is_array()) return list;
  for (const Json& element : *found)
    list.push_back(element.is_number() ? element.get<double>()
                                       : std::numeric_limits<double>::quiet_NaN());
  return list;
}

/// Component `axis` of a list of vectors.
std::vector<double> component_at(const Json& json, const KeyPath& path, std::size_t axis) {
  std::vector<double> list;
  const Json* found = find(json, path);
  if (found == nullptr || !found->is_array()) return list;
  for (const Json& vector : *found) {
    const bool there = vector.is_array() && axis < vector.size() && vector[axis].is_number();
    list.push_back(there ? vector[axis].get<double>() : std::numeric_limits<double>::quiet_NaN());
  }
  return list;
}

/// "1.23 cm"; empty without a value.
std::string in_unit(std::optional<double> value, double scale, const std::string& unit) {
  return value ? measure_text(scale * *value) + " " + unit : std::string();
}

void add_tile(Section& section, std::string term, std::string text) {
  if (!text.empty()) section.facts.push_back({std::move(term), std::move(text)});
}

/// "1.23, 0.00, -4.56 deg"; empty unless it is a list of numbers.
std::string numbers_text(const Json& json, const KeyPath& path, double scale,
                         const std::string& unit) {
  std::string text;
  for (const double value : list_at(json, path)) {
    if (!std::isfinite(value)) return {};
    text += (text.empty() ? "" : ", ") + measure_text(scale * value);
  }
  return text.empty() ? text : text + " " + unit;
}

/// The estimated mount, and the directions that could not be observed.
void add_mount(const Json& report, Section& section) {
  const Json* mount = find(report, {"mount"});
  if (mount == nullptr || !mount->is_object()) return;
  std::string not_observed;
  if (const Json* all = find(*mount, {"not_observed"}); all != nullptr && all->is_array())
    for (const Json& direction : *all)
      not_observed += (not_observed.empty() ? "" : ", ") + text_at(direction, {"name"});
  const std::string objection = text_at(*mount, {"objection"});
  if (!objection.empty()) section.paragraphs.push_back("The mount is as given: " + objection + ".");
  if (!not_observed.empty())
    section.paragraphs.push_back(
        "Directions of the mount that cannot be observed, left as given: " + not_observed + ".");
  if (!objection.empty()) return;
  const auto with_sd = [](const std::string& text, const std::string& sd) {
    return sd.empty() ? text : text + "\nstandard deviations " + sd;
  };
  add_tile(section, "Boresight: correction of the given yaw, pitch and roll",
           with_sd(numbers_text(*mount, {"yaw_pitch_roll_deg"}, 1, "deg"),
                   numbers_text(*mount, {"yaw_pitch_roll_sd_deg"}, 1, "deg")));
  add_tile(section, "Lever arm: correction along the sensor's axes",
           with_sd(numbers_text(*mount, {"shift_m"}, kCentimetres, "cm"),
                   numbers_text(*mount, {"shift_sd_m"}, kCentimetres, "cm")));
  if (const std::string alone = text_at(*mount, {"alone_because"}); !alone.empty())
    section.paragraphs.push_back("Only the mount is corrected: " + alone + ".");
}

/// Agreement of windows, and windows without a correction of their own.
void add_windows(const Json& report, Section& section) {
  const Json* windows = find(report, {"windows"});
  if (windows == nullptr || !windows->is_object()) return;
  const auto overlaps = [&](const char* key) { return number_at(*windows, {"overlaps", key}); };
  if (const auto count = number_at(*windows, {"count"}))
    add_tile(section, "Windows of the drive", count_text(*count));
  add_tile(section, "Poses in overlaps of windows, median difference",
           in_unit(overlaps("median_shift_m"), kCentimetres, "cm") + "\n" +
               in_unit(overlaps("median_rotation_rad"), kDegreesPerRadian, "deg"));
  add_tile(section, "Poses in overlaps of windows, largest difference",
           in_unit(overlaps("largest_shift_m"), kCentimetres, "cm") + "\n" +
               in_unit(overlaps("largest_rotation_rad"), kDegreesPerRadian, "deg"));
  if (number_at(*windows, {"laser_windows"}).value_or(0) > 0)
    add_tile(
        section, "Lasers: single windows against all windows (RMS)",
        in_unit(number_at(*windows, {"range_disagreement_m"}), kMillimetres, "mm") + "\n" +
            in_unit(number_at(*windows, {"elevation_disagreement_rad"}), kDegreesPerRadian, "deg"));
  if (const std::string text = text_at(*windows, {"not_done"}); !text.empty())
    section.paragraphs.push_back("Solved in windows: " + text + ".");
  const Json* each = find(*windows, {"each"});
  if (each == nullptr || !each->is_array()) return;
  for (const Json& window : *each) {
    const std::vector<double> scans = list_at(window, {"scans"});
    if (const std::string why = text_at(window, {"objection"}); !why.empty() && scans.size() == 2)
      section.paragraphs.push_back("Scans " + count_text(scans[0]) + " to " +
                                   count_text(scans[1] - 1) +
                                   " have no correction of their own: " + why + ".");
  }
}

Section figures_section(const Json& report) {
  Section section{.id = "figures", .title = "Results"};
  if (const std::string objection = text_at(report, {"objection"}); !objection.empty())
    section.paragraphs.push_back("Nothing is corrected: " + objection + ".");
  if (const std::string warning = text_at(report, {"warning"}); !warning.empty())
    section.paragraphs.push_back("Warning: " + warning + ".");
  section.facts_as_tiles = true;
  const auto figure = [&](const char* key) { return number_at(report, {key}); };
  std::string residual = in_unit(figure("residual_given_m"), kCentimetres, "cm as given");
  const auto calibrated_m = figure("residual_calibrated_m");
  if (calibrated_m && *calibrated_m > 0)
    residual = in_unit(calibrated_m, kCentimetres, "cm") + "\n" + residual;
  add_tile(section, "Points left out of the fit: median distance to the planes of the others",
           std::move(residual));
  if (const auto planes = figure("planes"))
    add_tile(section, "Planes seen by several scans", count_text(*planes));
  add_tile(section, "Weakest direction: share of the planes' weight that constrains it",
           in_unit(figure("weakest_share"), 100, "%"));
  add_tile(section, "Largest correction of a pose",
           in_unit(figure("largest_shift_m"), kCentimetres, "cm") + "\n" +
               in_unit(figure("largest_rotation_rad"), kDegreesPerRadian, "deg"));
  add_mount(report, section);
  add_windows(report, section);
  add_tile(section, "Offsets of lasers (RMS)",
           in_unit(figure("range_offset_rms_m"), kMillimetres, "mm") + "\n" +
               in_unit(figure("elevation_offset_rms_rad"), kDegreesPerRadian, "deg"));
  return section;
}

/// Times since the first scan, or for several drives in sequence, numbers of scans. A drive begins
/// where times do not increase.
struct ScanAxis {
  std::vector<double> values;
  std::vector<bool> begins;  ///< a drive, other than the first
  std::string title;
};

ScanAxis scan_axis_of(const Json& report) {
  const std::vector<double> times_s = list_at(report, {"scans", "time_s"});
  ScanAxis axis;
  bool one_drive = true;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    axis.begins.push_back(i > 0 && !(times_s[i] > times_s[i - 1]));
    one_drive = one_drive && !axis.begins.back();
  }
  axis.title = one_drive ? "time since the first scan, s" : "number of the scan";
  for (std::size_t i = 0; i < times_s.size(); ++i)
    axis.values.push_back(one_drive ? times_s[i] - times_s.front() : static_cast<double>(i));
  return axis;
}

Plot pose_plot(const Json& report, const ScanAxis& axis, const char* key, double scale,
               const std::array<const char*, 3>& names) {
  Plot plot;
  plot.x_title = axis.title;
  constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::vector<double> values = component_at(report, {"scans", key}, k);
    PlotSeries series{names[k], {k, false}, {}};
    for (std::size_t i = 0; i < values.size() && i < axis.values.size(); ++i) {
      if (axis.begins[i]) series.points.push_back({kBreak, kBreak});
      series.points.push_back({axis.values[i], scale * values[i]});
    }
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Section poses_section(const Json& report) {
  const ScanAxis axis = scan_axis_of(report);
  if (axis.values.empty()) return {};
  Section section{.id = "poses", .title = "Poses"};
  section.paragraphs = {
      "Correction of the given pose of each scan, along and about the sensor's axes. The pose of "
      "the "
      "whole scene cannot be observed and stays as given."};
  Plot turns = pose_plot(report, axis, "rotation_rad", kDegreesPerRadian,
                         {"roll, about x", "pitch, about y", "yaw, about z"});
  turns.title = "Rotations";
  turns.y_title = "deg";
  Plot shifts = pose_plot(report, axis, "shift_m", kCentimetres, {"along x", "along y", "along z"});
  shifts.title = "Shifts";
  shifts.y_title = "cm";
  section.plots = {std::move(turns), std::move(shifts)};
  return section;
}

Plot laser_plot(const Json& report, const char* key, double scale) {
  Plot plot;
  plot.x_title = "laser, from the topmost";
  plot.style = PlotStyle::marks;
  plot.series = {{"", {0, false}, {}}};
  const std::vector<double> values = list_at(report, {"lasers", key});
  for (std::size_t i = 0; i < values.size(); ++i)
    plot.series[0].points.push_back({static_cast<double>(i), scale * values[i]});
  return plot;
}

Section lasers_section(const Json& report) {
  Plot ranges = laser_plot(report, "range_offset_m", kMillimetres);
  Plot elevations = laser_plot(report, "elevation_offset_rad", kDegreesPerRadian);
  if (ranges.series[0].points.empty()) return {};
  Section section{.id = "lasers", .title = "Lasers"};
  section.paragraphs = {
      "Corrections that are added to the values of each laser. Only differences between lasers can "
      "be observed: the means are zero."};
  ranges.title = "Offsets of ranges";
  ranges.y_title = "mm";
  elevations.title = "Offsets of elevations";
  elevations.y_title = "deg";
  section.plots = {std::move(ranges), std::move(elevations)};
  return section;
}

Section residuals_section(const Json& report) {
  const auto bin_m = number_at(report, {"residuals", "bin_m"});
  if (!bin_m) return {};
  Plot plot;
  plot.title = "Distances from planes, points left out of the fit";
  plot.x_title = "distance, cm";
  plot.y_title = "share of the points, %";
  plot.style = PlotStyle::steps;
  std::size_t slot = 0;
  for (const char* key : {"given", "calibrated"}) {
    std::vector<double> counts = list_at(report, {"residuals", key});
    double sum = 0;
    for (const double count : counts) sum += count;
    if (!(sum > 0)) continue;
    PlotSeries series{std::string(key) == "given" ? "as given" : key, {slot++, false}, {}};
    counts.pop_back();  // distances beyond the bins
    counts.push_back(counts.back());
    for (std::size_t i = 0; i < counts.size(); ++i)
      series.points.push_back(
          {kCentimetres * *bin_m * static_cast<double>(i), 100 * counts[i] / sum});
    plot.series.push_back(std::move(series));
  }
  if (plot.series.empty()) return {};
  Section section{.id = "residuals", .title = "Residuals"};
  section.paragraphs = {"Every eighth point is left out of the fit, to test it."};
  section.plots = {std::move(plot)};
  return section;
}

Section drives_section(const Json& report) {
  const Json* drives = find(report, {"drives"});
  if (drives == nullptr || !drives->is_array() || drives->empty()) return {};
  Section section{.id = "drives", .title = "Drives"};
  for (const Json& drive : *drives) {
    const std::string sensor = text_at(drive, {"sensor"}), beams = text_at(drive, {"beams"});
    std::string text = sensor.empty() ? "sensor not recognised" : sensor;
    if (!beams.empty()) text += "; beams: " + beams;
    if (const auto scans = number_at(drive, {"scans"}))
      text += "; " + whole_text(*scans) + " scans";
    add_tile(section, text_at(drive, {"name"}), text);
  }
  return section;
}

}  // namespace
}  // namespace page

std::string calibration_html(const nlohmann::ordered_json& report) {
  page::Document document;
  document.title = "Calibration";
  document.subtitle = "Errors of a recording, estimated from planes that several of its scans saw.";
  document.sections = {page::figures_section(report), page::poses_section(report),
                       page::lasers_section(report), page::residuals_section(report),
                       page::drives_section(report)};
  std::erase_if(document.sections, [](const page::Section& section) { return section.id.empty(); });
  document.footer = "The same figures are in report.json.";
  return page::html_page(document, {});
}

}  // namespace adasplats
