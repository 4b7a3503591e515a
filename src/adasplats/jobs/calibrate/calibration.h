// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adasplats/calibrate/calibrate.h"
#include "adasplats/calibrate/windows.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// calibrate() on the session's device; the result is the same on all devices. If a GPU that the
/// user did not ask for fails, warns and continues on the CPU. The session must outlive the result.
CalibrateCloud calibrate_on(Session& session);

/// A calibration for reports: the evidence and the size of the corrections.
nlohmann::ordered_json calibration_json(const CalibrationReport& report,
                                        const Calibration& calibration);

}  // namespace adasplats
