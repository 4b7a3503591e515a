// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/jobs/session/session.h"
#include "adasplats/segment/segment_cloud.h"

namespace adasplats {

/// segment_cloud() on the session's device; where a GPU that nobody asked for fails, warns and goes
/// on with the CPU.
Segmentation segment_on_device(const PointCloud& cloud, const Network& network,
                               const SegmentOptions& options, Session& session);

}  // namespace adasplats
