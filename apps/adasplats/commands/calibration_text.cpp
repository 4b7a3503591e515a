// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands/calibration_text.h"

#include "adasplats/core/constants.h"
#include "cli/text_table.h"

namespace adasplats::app {

std::string calibration_text(const CalibrationReport& report, const Calibration& calibration) {
  if (!report.objection.empty()) return "Nothing calibrated: " + report.objection + "\n";
  const CalibrationSizes sizes = sizes_of(calibration);
  std::string text = "Calibrated by " + grouped(report.planes) + " planes: poses by up to " +
                     centimetres(sizes.largest_shift_m) + " and " +
                     fixed(sizes.largest_rotation_rad / kDegree, 2) + " deg";
  if (!calibration.lasers.empty())
    text += ", lasers by " + centimetres(sizes.range_rms_m) + " and " +
            fixed(sizes.elevation_rms_rad / kDegree, 3) + " deg (RMS)";
  return text + "; points left out of it lie " + centimetres(report.calibrated_m) +
         " from planes (" + centimetres(report.given_m) +
         " before); as a whole the place stays where the given poses have it\n";
}

}  // namespace adasplats::app
