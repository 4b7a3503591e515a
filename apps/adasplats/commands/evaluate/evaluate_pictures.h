// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "adasplats/cloud/points/point_cloud.h"
#include "adasplats/evaluate/resimulate.h"
#include "adasplats/jobs/scene/view_choice.h"
#include "cli/session.h"

namespace adasplats::app {

/// Writes a PNG of the simulated points coloured by their distance to the nearest original point,
/// from 0 to 20 cm. Unless the view says otherwise the original decides where the camera stands, so
/// that pictures of several simulations can be laid over each other.
void write_distance_picture(const std::filesystem::path& file, const PointCloud& simulated,
                            const PointCloud& original, const ViewChoice& view, Session& session);

/// Writes a PNG of one scan's measured points coloured by the signed error of the range that was
/// predicted for them, up to 50 cm; grey: no hit. Seen from behind and above the sensor.
/// `width` pixels, 16:9.
void write_beam_picture(const std::filesystem::path& file, const ScanErrors& scan, int width,
                        Session& session);

}  // namespace adasplats::app
