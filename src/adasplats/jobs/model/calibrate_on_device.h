// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/calibrate/windows.h"
#include "adasplats/jobs/session/session.h"

namespace adasplats {

/// calibrate() on the session's device, with the same result on all; where a GPU that nobody asked
/// for fails, warns and goes on with the CPU. The session must outlive it.
CalibrateCloud calibrate_on(Session& session);

}  // namespace adasplats
