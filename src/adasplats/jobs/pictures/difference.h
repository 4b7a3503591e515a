// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "adasplats/jobs/scene/model_scene.h"
#include "adasplats/simulate/image/image.h"

namespace adasplats {

/// What a camera sees of the first model, coloured by how much farther along each ray the second
/// is: blue where it is nearer, red where farther, beyond 20 cm at the end of the scale; where only
/// one of them is, a colour of its own.
Image draw_difference(const ModelScene& first, const ModelScene& second, const Camera& camera,
                      const Executor& executor);

/// Refuses models that have no place in common; `first_file`, `second_file`: of them, for the
/// message. Errors: data (their boxes do not overlap).
void require_overlap(const ModelScene& first, const std::filesystem::path& first_file,
                     const ModelScene& second, const std::filesystem::path& second_file);

void write_difference_legend(Image& image, const std::string& first, const std::string& second);

}  // namespace adasplats
