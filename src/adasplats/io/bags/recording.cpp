// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/bags/recording.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/bags/packed_recording.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadataName = "metadata.yaml";
constexpr std::string_view kMetadataKey = "rosbag2_bagfile_information";

/// A kind of recording, by the extension.
struct RecordingKind {
  std::string_view name, extension;
  std::unique_ptr<RecordingFile> (*open)(const fs::path& path);
};
constexpr RecordingKind kRecordingKinds[] = {{"MCAP", ".mcap", &open_mcap},
                                             {"ROS 1 bag", ".bag", &open_rosbag},
                                             {"ROS 2 bag", ".db3", &open_sqlite}};

const RecordingKind* kind_of_recording(const fs::path& path) {
  const std::string extension = lower_case(without_packing(path).extension().string());
  for (const RecordingKind& kind : kRecordingKinds)
    if (kind.extension == extension) return &kind;
  return nullptr;
}

std::string list_of(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

std::unique_ptr<RecordingFile> open_recording_file(const fs::path& path) {
  const RecordingKind* const kind = kind_of_recording(path);
  if (kind != nullptr && without_packing(path) != path)
    return open_packed_recording(path, kind->open);
  if (kind != nullptr) return kind->open(path);
  throw data_error({path, {}, {}}, "unknown kind of recording " + shown(path.extension().string()) +
                                       ", supported are " + list_of(recording_extensions()));
}

/// "value" of "  key: value", also in quotes; nothing for lines with other keys.
std::optional<std::string> yaml_value(std::string_view line, std::string_view key) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  if (!line.starts_with(key)) return std::nullopt;
  line.remove_prefix(key.size());
  const std::size_t begin = line.find_first_not_of(" \"'");
  if (begin == std::string_view::npos) return std::string();
  const std::size_t end = line.find_last_not_of(" \"'\r");
  return std::string(line.substr(begin, end + 1 - begin));
}

}  // namespace

Ros2Bag ros2_bag_in(const fs::path& folder) {
  const fs::path metadata = folder / kMetadataName;
  InputFile input(metadata);
  LineReader reader(input);
  std::vector<fs::path> files;
  std::string packing, mode;
  bool in_list = false;
  while (const auto line = reader.next_filled()) {
    if (const auto format = yaml_value(*line, "compression_format:")) packing = lower_case(*format);
    if (const auto packed = yaml_value(*line, "compression_mode:")) {
      mode = lower_case(*packed);
      if (!mode.empty() && mode != "none" && mode != "file" && mode != "message")
        throw data_error({metadata, {}, reader.line()},
                         "unsupported compression mode " + shown(*packed) +
                             "; decompress the bag with `ros2 bag convert`");
    }
    const auto file = in_list ? yaml_value(*line, "- ") : std::nullopt;
    if (file) {
      const fs::path name = *file;
      // Up to version 3 of the format names include the folder. Files outside the folder are
      // rejected.
      const fs::path above = name.parent_path();
      if (!name.has_filename() || name.filename() == ".." ||
          !(above.empty() || above == fs::absolute(folder / "").parent_path().filename()))
        throw data_error({metadata, {}, reader.line()},
                         "expected the name of a file in the same folder, found " + shown(*file));
      files.push_back(folder / name.filename());
    }
    in_list = file || yaml_value(*line, "relative_file_paths:");
  }
  if (files.empty())
    throw Error(ErrorKind::data,
                metadata.string() + ": no files in relative_file_paths, expected .mcap or .db3");
  if (mode != "message")
    packing.clear();
  else if (packing.empty())
    packing = "zstd";  // the only one in ROS 2
  return {std::move(files), std::move(packing)};
}

Recording::Recording(const fs::path& path) : path_(path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) {
    files_.push_back(open_recording_file(path));
    return;
  }
  const Ros2Bag bag = ros2_bag_in(path);
  for (const fs::path& file : bag.files) {
    files_.push_back(open_recording_file(file));
    if (!bag.message_packing.empty())
      files_.back() = with_packed_messages(std::move(files_.back()), bag.message_packing, file);
  }
}

void Recording::for_each_message(MessageVisitor visit) const {
  for (std::size_t k = 0; k < files_.size(); ++k)
    files_[k]->for_each_message([&](const RecordedMessage& message) {
      RecordedMessage placed = message;
      placed.place.file = static_cast<std::uint32_t>(k);
      visit(placed);
    });
}

std::string Recording::message(const MessagePosition& place) const {
  return files_.at(place.file)->message(place);
}

bool is_recording(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return kind_of_recording(path) != nullptr;
  const fs::path metadata = path / kMetadataName;
  if (!fs::is_regular_file(metadata, ignored) || fs::is_empty(metadata, ignored)) return false;
  InputFile file(metadata);
  const auto size =
      static_cast<std::size_t>(std::min<std::uint64_t>(file.size_bytes(), kMetadataKey.size()));
  const auto bytes = file.peek(size);
  return std::string_view(reinterpret_cast<const char*>(bytes.data()), size) == kMetadataKey;
}

std::vector<std::string> recording_extensions() {
  std::vector<std::string> extensions;
  for (const RecordingKind& kind : kRecordingKinds) extensions.emplace_back(kind.extension);
  return extensions;
}

std::string recording_format_names() {
  std::vector<std::string> names;
  for (const RecordingKind& kind : kRecordingKinds) names.emplace_back(kind.name);
  return list_of(names);
}

std::string short_type_name(std::string_view type) {
  constexpr std::string_view kMiddle = "/msg/";
  const std::size_t place = type.find(kMiddle);
  if (place == std::string_view::npos) return std::string(type);
  return std::string(type.substr(0, place)) + "/" +
         std::string(type.substr(place + kMiddle.size()));
}

}  // namespace adasplats
