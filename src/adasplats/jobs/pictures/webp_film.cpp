// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/webp_film.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

#if defined(ADASPLATS_HAVE_WEBP)
#include <webp/encode.h>
#include <webp/mux.h>

namespace adasplats {
namespace {

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

}  // namespace

bool has_webp() { return true; }

std::unique_ptr<FilmWriter> make_webp_film(const std::filesystem::path& path, double frames_per_s) {
  return std::make_unique<WebpFilm>(path, frames_per_s);
}

}  // namespace adasplats

#else

namespace adasplats {

bool has_webp() { return false; }

std::unique_ptr<FilmWriter> make_webp_film(const std::filesystem::path&, double) {
  throw std::logic_error("this build has no libwebp");
}

}  // namespace adasplats

#endif
