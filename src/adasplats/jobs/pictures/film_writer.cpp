// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/film_writer.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/core/child_process.h"
#include "adasplats/core/error.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/jobs/pictures/webp_film.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Frames as numbered pictures in a folder beside the film, which ffmpeg then makes a film of.
class Mp4Film final : public FilmWriter {
 public:
  Mp4Film(fs::path ffmpeg, fs::path path, double frames_per_s)
      : ffmpeg_(std::move(ffmpeg)), path_(std::move(path)), frames_per_s_(frames_per_s) {
    const fs::path parent = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
    folder_ = parent / ("." + path_.filename().string() + "." + std::to_string(::getpid()));
    std::error_code error;
    if (!fs::create_directory(folder_, error))
      throw Error(ErrorKind::cannot_create, folder_.string() + ": cannot be made");
  }
  ~Mp4Film() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  void add(const Image& frame) override {
    char name[32];
    std::snprintf(name, sizeof name, "%06zu.png", frames_++);
    write_png(folder_ / name, frame.width, frame.height, frame.pixels);
  }

  void finish(ProgressSink& progress) override {
    const fs::path made = folder_ / "film.mp4";
    ChildProgram child;
    child.log = folder_ / "log.txt";
    child.arguments = {ffmpeg_.string(), "-nostdin", "-loglevel", "error", "-framerate",
                       std::to_string(frames_per_s_), "-i", (folder_ / "%06d.png").string(),
                       // Halves of colours need even sides.
                       "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-c:v", "libx264", "-crf", "20",
                       "-pix_fmt", "yuv420p", "-movflags", "+faststart", made.string()};
    const ChildResult result = run_child(child, progress);
    if (result.end != ChildEnd::done)
      throw Error(ErrorKind::unavailable, path_.string() + ": ffmpeg failed: " + result.message);
    std::error_code error;
    fs::rename(made, path_, error);  // of one file system: the folder stands beside the film
    if (error) throw Error(ErrorKind::io, path_.string() + ": " + error.message());
  }

 private:
  fs::path ffmpeg_, path_, folder_;
  double frames_per_s_;
  std::size_t frames_ = 0;
};

std::optional<fs::path> needed_program(const fs::path& path) {
  const std::string kind = path.extension().string();
  if (kind == ".webp") {
    if (!has_webp())
      throw Error(ErrorKind::unavailable,
                  path.string() + ": this build has no libwebp (libwebp-dev); .mp4 needs ffmpeg");
    return {};
  }
  if (kind != ".mp4")
    throw Error(ErrorKind::usage, path.string() + ": a film is a .webp or an .mp4");
  std::optional<fs::path> ffmpeg = find_on_path("ffmpeg");
  if (!ffmpeg)
    throw Error(ErrorKind::unavailable,
                path.string() +
                    ": there is no program ffmpeg (apt-get install ffmpeg); .webp needs "
                    "none");
  return ffmpeg;
}

}  // namespace

void check_film(const fs::path& path) { needed_program(path); }

std::unique_ptr<FilmWriter> make_film_writer(const fs::path& path, double frames_per_s) {
  if (const std::optional<fs::path> ffmpeg = needed_program(path))
    return std::make_unique<Mp4Film>(*ffmpeg, path, frames_per_s);
  return make_webp_film(path, frames_per_s);
}

}  // namespace adasplats
