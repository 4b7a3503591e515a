// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "adasplats/core/progress.h"
#include "adasplats/simulate/image/image.h"

namespace adasplats {

/// Whether films of that name can be written: .webp (animated WebP; needs libwebp when the library
/// is built), .mp4 (H.264; needs a program ffmpeg with libx264 on PATH). Errors: usage (another
/// name), unavailable (what it needs is not there).
void check_film(const std::filesystem::path& path);

/// Writes a film frame by frame. The file gets its name when it is complete.
class FilmWriter {
 public:
  virtual ~FilmWriter() = default;
  virtual void add(const Image& frame) = 0;
  /// Call once, last. Errors: unavailable (the encoder failed, with its last line), io.
  virtual void finish(ProgressSink& progress) = 0;
};

/// Errors: those of check_film(); cannot_create.
std::unique_ptr<FilmWriter> make_film_writer(const std::filesystem::path& path,
                                             double frames_per_s);

}  // namespace adasplats
