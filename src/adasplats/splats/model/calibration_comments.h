// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/sequence/calibration.h"

namespace adasplats {

/// Adds the comments of a PLY that hold a calibration; sensors of a rig follow each other.
void add_calibration_comments(const Calibration& calibration, std::vector<std::string>& comments);

/// The calibration of such comments; others are ignored. Errors: data.
Calibration calibration_of_comments(std::span<const std::string> comments,
                                    const std::filesystem::path& path);

}  // namespace adasplats
