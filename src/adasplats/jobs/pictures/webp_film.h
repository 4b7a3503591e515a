// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "adasplats/jobs/pictures/film_writer.h"

namespace adasplats {

bool has_webp();
/// Animated WebP that repeats. Only where has_webp().
std::unique_ptr<FilmWriter> make_webp_film(const std::filesystem::path& path, double frames_per_s);

}  // namespace adasplats
