// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/film_writer.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "adasplats/core/child_process.h"
#include "adasplats/core/error.h"
#include "adasplats/io/arrays/png.h"
#include "adasplats/io/base/atomic_file.h"

#if defined(ADASPLATS_HAVE_WEBP)
#include <webp/encode.h>
#include <webp/mux.h>
#endif

namespace adasplats {
namespace {

namespace fs = std::filesystem;

/// Writes frames as numbered pictures in a folder next to the film; ffmpeg then encodes them.
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
    fs::rename(made, path_, error);  // same file system: the folder is next to the film
    if (error) throw Error(ErrorKind::io, path_.string() + ": " + error.message());
  }

 private:
  fs::path ffmpeg_, path_, folder_;
  double frames_per_s_;
  std::size_t frames_ = 0;
};

#if defined(ADASPLATS_HAVE_WEBP)
constexpr bool kHasWebp = true;

/// Animated WebP that repeats.
class WebpFilm final : public FilmWriter {
 public:
  WebpFilm(std::filesystem::path path, double frames_per_s)
      : path_(std::move(path)), frame_ms_(1000 / frames_per_s) {}
  ~WebpFilm() override { WebPAnimEncoderDelete(encoder_); }
  WebpFilm(const WebpFilm&) = delete;
  WebpFilm& operator=(const WebpFilm&) = delete;

  void add(const Image& frame) override {
    if (encoder_ == nullptr) begin(frame);
    WebPPicture picture;
    WebPPictureInit(&picture);
    picture.use_argb = 1;
    picture.width = frame.width;
    picture.height = frame.height;
    bool good = WebPPictureImportRGB(&picture, frame.pixels.data(), 3 * frame.width) != 0;
    WebPConfig config;
    good = good && WebPConfigPreset(&config, WEBP_PRESET_PICTURE, 80) != 0;
    config.method = 3;
    good = good && WebPAnimEncoderAdd(encoder_, &picture, time_ms(frames_), &config) != 0;
    WebPPictureFree(&picture);
    if (!good) fail();
    ++frames_;
  }

  void finish(ProgressSink&) override {
    if (encoder_ == nullptr) throw std::logic_error("a film without frames");
    WebPData data;
    WebPDataInit(&data);
    if (WebPAnimEncoderAdd(encoder_, nullptr, time_ms(frames_), nullptr) == 0 ||
        WebPAnimEncoderAssemble(encoder_, &data) == 0)
      fail();
    const std::string bytes(reinterpret_cast<const char*>(data.bytes), data.size);
    WebPDataClear(&data);
    write_file(path_, bytes);
  }

 private:
  int time_ms(std::size_t frame) const {
    return static_cast<int>(std::lround(frame_ms_ * static_cast<double>(frame)));
  }
  void begin(const Image& frame) {
    WebPAnimEncoderOptions options;
    if (WebPAnimEncoderOptionsInit(&options) == 0) fail();
    encoder_ = WebPAnimEncoderNew(frame.width, frame.height, &options);
    if (encoder_ == nullptr) fail();
  }
  [[noreturn]] void fail() const {
    const char* const why = encoder_ == nullptr ? nullptr : WebPAnimEncoderGetError(encoder_);
    throw Error(ErrorKind::unavailable, path_.string() + ": libwebp failed" +
                                            (why == nullptr ? "" : std::string(": ") + why));
  }

  std::filesystem::path path_;
  double frame_ms_;
  std::size_t frames_ = 0;
  WebPAnimEncoder* encoder_ = nullptr;
};
#else
constexpr bool kHasWebp = false;
#endif

/// The program that a film of this name needs; nothing for WebP. Errors: those of check_film().
std::optional<fs::path> needed_program(const fs::path& path) {
  const std::string kind = path.extension().string();
  if (kind == ".webp") {
    if (!kHasWebp)
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
#if defined(ADASPLATS_HAVE_WEBP)
  return std::make_unique<WebpFilm>(path, frames_per_s);
#else
  throw std::logic_error("make_film_writer: needed_program() accepts WebP only with libwebp");
#endif
}

}  // namespace adasplats
