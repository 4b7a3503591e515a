// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/bags/packed_recording.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/bags/unpack.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMinLimitBytes = std::uint64_t{1} << 30;
constexpr std::uint64_t kMaxRatio = 256;  // recordings compress to a half or a tenth
constexpr std::size_t kPartBytes = std::size_t{1} << 20;

/// A unique temporary folder, removed with this object.
class UnpackedFolder {
 public:
  UnpackedFolder() {
    std::error_code problem;
    const fs::path parent = fs::temp_directory_path(problem);
    if (problem)
      throw Error(ErrorKind::cannot_create,
                  "no folder for temporary files to decompress a recording into; set TMPDIR");
    std::string pattern = (parent / "adasplats-unpacked-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw system_error(ErrorKind::cannot_create, pattern, "the folder cannot be created", errno);
    path_ = pattern;
  }
  ~UnpackedFolder() {
    std::error_code ignored;  // a destructor must not throw
    fs::remove_all(path_, ignored);
  }
  UnpackedFolder(const UnpackedFolder&) = delete;
  UnpackedFolder& operator=(const UnpackedFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Writes decompressed bytes to a file, up to a limit and as long as the disk has space.
class LimitedFile {
 public:
  LimitedFile(const fs::path& packed, std::uint64_t packed_bytes, fs::path to)
      : packed_(packed.string()),
        max_bytes_(kMinLimitBytes + kMaxRatio * packed_bytes),
        to_(std::move(to)),
        file_(to_, std::ios::binary) {}

  void add(std::string_view bytes) {
    written_ += bytes.size();
    if (written_ > max_bytes_)
      throw Error(ErrorKind::data, packed_ + ": decompresses to more than " +
                                       std::to_string(max_bytes_) + " bytes, " +
                                       std::to_string(kMaxRatio) +
                                       " times its size, which is implausible for a recording");
    unchecked_ += bytes.size();
    if (unchecked_ >= kCheckedEvery) require_disk_space();
    file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!file_) throw no_space();
  }
  void finish() {
    file_.close();
    if (!file_) throw no_space();
  }

 private:
  static constexpr std::uint64_t kCheckedEvery = std::uint64_t{64} << 20;

  void require_disk_space() {
    unchecked_ = 0;
    std::error_code problem;
    const fs::space_info space = fs::space(to_.parent_path(), problem);
    if (!problem && space.available < space.capacity / 20) throw no_space();
  }
  Error no_space() const {
    return {ErrorKind::io, packed_ + ": not enough disk space in " + to_.parent_path().string() +
                               " to decompress it (after " + std::to_string(written_) +
                               " bytes); set TMPDIR to a folder with more"};
  }

  std::string packed_;
  std::uint64_t max_bytes_, written_ = 0, unchecked_ = 0;
  fs::path to_;
  std::ofstream file_;
};

/// Replaces the name of the temporary file in errors by that of the compressed file.
template <class Do>
auto with_packed_name(const fs::path& unpacked, const fs::path& packed, const Do& act) {
  try {
    return act();
  } catch (const Error& error) {
    std::string text = error.what();
    const std::string name = unpacked.string();
    const std::size_t place = text.find(name);
    if (place == std::string::npos) throw;
    throw Error(error.kind(),
                text.replace(place, name.size(), packed.string() + " (decompressed)"));
  }
}

class UnpackedRecording final : public RecordingFile {
 public:
  UnpackedRecording(const fs::path& path, const OpenRecordingFile& open)
      : packed_(path), unpacked_(folder_.path() / without_packing(path).filename()) {
    InputFile input(path);
    LimitedFile file(path, input.size_bytes(), unpacked_);
    unpack_zstd_stream(
        [&](std::size_t done) -> std::string_view {
          input.skip(done);
          if (input.remaining() == 0) return {};
          const auto bytes = input.peek(
              static_cast<std::size_t>(std::min<std::uint64_t>(kPartBytes, input.remaining())));
          return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
        },
        [&](std::string_view bytes) { file.add(bytes); }, path.string());
    file.finish();
    file_ = with_packed_name(unpacked_, packed_, [&] { return open(unpacked_); });
  }
  void for_each_message(MessageVisitor visit) const override {
    with_packed_name(unpacked_, packed_, [&] { file_->for_each_message(visit); });
  }
  std::string message(const MessagePosition& place) const override {
    return with_packed_name(unpacked_, packed_, [&] { return file_->message(place); });
  }

 private:
  UnpackedFolder folder_;  // removed last
  fs::path packed_, unpacked_;
  std::unique_ptr<RecordingFile> file_;
};

class PackedMessages final : public RecordingFile {
 public:
  PackedMessages(std::unique_ptr<RecordingFile> file, std::string packing, std::string path)
      : file_(std::move(file)), packing_(std::move(packing)), path_(std::move(path)) {}
  void for_each_message(MessageVisitor visit) const override {
    file_->for_each_message([&](const RecordedMessage& packed) {
      const std::string bytes = unpacked(packed.bytes, packed.topic.name);
      visit({packed.topic, packed.time_ns, packed.place, bytes});
    });
  }
  std::string message(const MessagePosition& place) const override {
    return unpacked(file_->message(place), "its topic");
  }

 private:
  std::string unpacked(std::string_view packed, const std::string& topic) const {
    return unpack_sized(packing_, packed, path_ + ": a message of " + topic);
  }

  std::unique_ptr<RecordingFile> file_;
  std::string packing_, path_;
};

}  // namespace

fs::path without_packing(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  return extension == ".zstd" || extension == ".zst" ? path.parent_path() / path.stem() : path;
}

std::unique_ptr<RecordingFile> open_packed_recording(const fs::path& path,
                                                     const OpenRecordingFile& open) {
  return std::make_unique<UnpackedRecording>(path, open);
}

std::unique_ptr<RecordingFile> with_packed_messages(std::unique_ptr<RecordingFile> file,
                                                    std::string packing, const fs::path& path) {
  return std::make_unique<PackedMessages>(std::move(file), std::move(packing), path.string());
}

}  // namespace adasplats
