// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "adasplats/report/chart.h"
#include "adasplats/report/report_page.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

Json sample_report() {
  return Json::parse(R"({"applied": true, "planes": 1234, "residual_given_m": 0.02,
    "residual_calibrated_m": 0.01, "weakest_share": 0.2, "largest_shift_m": 0.05,
    "largest_rotation_rad": 0.001, "range_offset_rms_m": 0.01, "elevation_offset_rms_rad": 0.0001,
    "drives": [{"name": "<00>", "sensor": "s", "beams": "b", "scans": 3}],
    "scans": {"time_s": [5, 5.1, 5.2], "rotation_rad": [[0, 0.001, 0], [0, 0, 0], [0, 0, 0]],
              "shift_m": [[-0.05, 0, 0], [0, 0, 0], [0.05, 0, 0]]},
    "lasers": {"range_offset_m": [0.01, -0.01], "elevation_offset_rad": [0, 0]},
    "residuals": {"bin_m": 0.01, "given": [1, 3, 2, 0], "calibrated": [5, 1, 0, 0]}})");
}

TEST(CalibrationPage, HasAllPlotsAndNothingUnescaped) {
  const std::string html = calibration_html(sample_report());
  for (const char* text : {"Rotations", "Shifts", "Offsets of ranges", "Offsets of elevations",
                           "Distances from planes", "1.00 cm", "&lt;00&gt;"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  EXPECT_EQ(html.find("<00>"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(CalibrationPage, ShowsTheMountAndItsUnobservableDirections) {
  Json report = sample_report();
  report["mount"] = Json::parse(R"({"applied": true, "yaw_pitch_roll_deg": [5, 0, -0.25],
    "shift_m": [0.5, 0, 0], "yaw_pitch_roll_sd_deg": [0.01, 0.01, 0.01],
    "shift_sd_m": [0.01, 0.01, 0], "not_observed": [{"name": "lever arm along z"}]})");
  const std::string html = calibration_html(report);
  for (const char* text : {"Boresight", "5.00, 0, -0.250 deg", "Lever arm", "50.0, 0, 0 cm",
                           "left as given: lever arm along z."})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  report["mount"]["objection"] = "it is not clear";
  const std::string refused = calibration_html(report);
  EXPECT_NE(refused.find("The mount is as given: it is not clear."), std::string::npos);
  EXPECT_EQ(refused.find("Boresight"), std::string::npos);
}

TEST(CalibrationPage, GivesTheReasonForNoCorrection) {
  const std::string html =
      calibration_html({{"applied", false}, {"objection", "too few planes"}, {"planes", 3}});
  EXPECT_NE(html.find("Nothing is corrected: too few planes."), std::string::npos);
  EXPECT_EQ(html.find("<figure"), std::string::npos);
}

TEST(CalibrationPage, AcceptsAnyJson) {
  const Json wrong[] = {nullptr,
                        3,
                        Json::array(),
                        {{"mount", {{"shift_m", {"x"}}, {"not_observed", 3}}}},
                        {{"scans", {{"time_s", {1, "x", nullptr}}}}},
                        {{"residuals", {{"bin_m", 1}, {"given", Json::array()}}}}};
  for (const Json& report : wrong)
    EXPECT_NE(calibration_html(report).find("</html>"), std::string::npos) << report;
  Json broken = sample_report();
  broken["scans"]["shift_m"][1] = nullptr;
  broken["lasers"]["range_offset_m"] = {nullptr, "y"};
  EXPECT_EQ(calibration_html(broken).find("nan"), std::string::npos);
}

// Oracle: analytic.
TEST(Plot, TicksEncloseTheValuesAndAreRound) {
  EXPECT_EQ(page::ticks_around(-3, 11), (std::vector<double>{-4, -2, 0, 2, 4, 6, 8, 10, 12}));
  EXPECT_EQ(page::ticks_around(0, 1).front(), 0);
  EXPECT_EQ(page::ticks_around(2, 2), (std::vector<double>{0, 1}));
}

TEST(Plot, InterruptsLinesAtPointsThatAreNotFinite) {
  constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
  page::Plot plot;
  plot.series = {{"", {0, false}, {{0, 1}, {1, 2}, {kGap, kGap}, {2, 3}, {3, 4}}}};
  const std::string svg = page::plot_svg(plot);
  const std::string path = svg.substr(svg.find("d=\""));
  EXPECT_EQ(
      std::count(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(path.find("/>")), 'M'),
      2);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace adasplats
