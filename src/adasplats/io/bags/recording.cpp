// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/bags/recording.h"

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<RecordingFile> open_recording_file(const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".mcap") return open_mcap(path);
  throw data_error({path, {}, {}},
                   "unknown kind of recording " + shown(extension) + ", understood are .mcap");
}

}  // namespace

Recording::Recording(const fs::path& path) : path_(path) {
  files_.push_back(open_recording_file(path));
}

void Recording::for_each_message(MessageVisitor visit) const {
  for (std::size_t k = 0; k < files_.size(); ++k)
    files_[k]->for_each_message([&](const RecordedMessage& message) {
      RecordedMessage placed = message;
      placed.place.file = static_cast<std::uint32_t>(k);
      visit(placed);
    });
}

std::string Recording::message(const MessagePlace& place) const {
  return files_.at(place.file)->message(place);
}

bool is_recording(const fs::path& path) { return lower_case(path.extension().string()) == ".mcap"; }

std::string short_type_name(std::string_view type) {
  constexpr std::string_view kMiddle = "/msg/";
  const std::size_t place = type.find(kMiddle);
  if (place == std::string_view::npos) return std::string(type);
  return std::string(type.substr(0, place)) + "/" +
         std::string(type.substr(place + kMiddle.size()));
}

}  // namespace adasplats
