// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0

// CameraInfo of ROS: the YAML of camera_calibration, messages as 'ros2 topic echo' prints them, the
// same as JSON; and the YAML of OpenCV's FileStorage. Of YAML only what these write: keys with
// numbers, texts and lists, on two levels.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/io/base/number_text.h"
#include "adasplats/sensors/camera_files.h"
#include "adasplats/sensors/text_fields.h"

namespace adasplats {

namespace {

using Json = nlohmann::json;

/// A number or a text.
Json scalar_of(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
      text.back() == text.front())
    return std::string(text.substr(1, text.size() - 2));
  if (const auto number = parse_number<double>(text)) return *number;
  if (text == ".nan" || text == ".NaN" || text == ".NAN") return std::nan("");
  return std::string(text);
}

/// Reads the lines of a file into an object of values, lists and objects of these.
class CameraYaml {
 public:
  CameraYaml(std::string_view text, const std::filesystem::path& file)
      : rest_(text), place_{file, std::nullopt, 0} {}

  Json read() {
    while (const auto line = next()) {
      const std::string_view content = trimmed(*line);
      if (content.empty() || content.front() == '%' || content.starts_with("---")) continue;
      if (content.front() == '-' && (content.size() == 1 || content[1] == ' ')) {
        if (last_ == nullptr) throw fault("a list without a key");
        if (!last_->is_array()) *last_ = Json::array();
        last_->push_back(scalar_of(content.substr(1)));
        continue;
      }
      read_pair(content, line->front() == ' ' || line->front() == '\t');
    }
    return std::move(root_);
  }

 private:
  Error fault(const std::string& message) const {
    return camera_fault(place_.file, "line " + std::to_string(*place_.line) + ": " + message);
  }

  /// The next line without its comment.
  std::optional<std::string_view> next() {
    if (rest_.empty()) return std::nullopt;
    place_.line = *place_.line + 1;
    const std::string_view line = take(rest_, '\n');
    return line.starts_with('#') ? "" : line.substr(0, line.find(" #"));
  }

  void read_pair(std::string_view content, bool is_indented) {
    const std::size_t colon = content.find(':');
    if (colon == std::string_view::npos) throw fault("expected KEY: VALUE");
    const std::string key(trimmed(content.substr(0, colon)));
    std::string_view value = trimmed(content.substr(colon + 1));
    if (value.starts_with("!!"))
      value = trimmed(value.substr(std::min(value.find(' '), value.size())));
    if (is_indented && group_ == nullptr) throw fault("an indented key without one above");
    if (is_indented && !group_->is_object()) *group_ = Json::object();
    last_ = is_indented ? &(*group_)[key] : &root_[key];
    *last_ = value.starts_with('[') ? list_from(value) : scalar_of(value);
    if (!is_indented) group_ = last_;
  }

  /// A list in brackets, which may span lines.
  Json list_from(std::string_view first) {
    std::string text(first);
    while (text.find(']') == std::string::npos) {
      const auto line = next();
      if (!line) throw fault("a list without its end ]");
      text.append(" ").append(trimmed(*line));
    }
    const std::string_view inside = trimmed(std::string_view(text).substr(1, text.find(']') - 1));
    Json list = Json::array();
    if (!inside.empty())
      for (const std::string_view field : fields_of(inside, ',')) list.push_back(scalar_of(field));
    return list;
  }

  std::string_view rest_;
  FilePosition place_;
  Json root_ = Json::object();
  Json* group_ = nullptr;  ///< value of the last key that is not indented
  Json* last_ = nullptr;   ///< value of the last key
};

/// A message with keys of either version of ROS, or of OpenCV.
class CameraInfo {
 public:
  CameraInfo(Json json, const std::filesystem::path& file) : json_(std::move(json)), file_(file) {
    if (!json_.is_object())
      throw camera_fault(file_, "is not an object with the keys of CameraInfo");
  }

  const Json* find(std::initializer_list<const char*> keys) const {
    for (const char* key : keys)
      if (const auto found = json_.find(key); found != json_.end()) return &*found;
    return nullptr;
  }

  /// Finite numbers of a list, or of the list `data` of a matrix; nothing if the key is missing.
  std::optional<std::vector<double>> numbers(std::initializer_list<const char*> keys) const {
    const Json* value = find(keys);
    if (value == nullptr) return std::nullopt;
    if (value->is_object() && value->contains("data")) value = &(*value)["data"];
    if (!value->is_array()) throw fault(keys, "is not a list of numbers");
    std::vector<double> numbers;
    for (const Json& each : *value) {
      if (!each.is_number() || !std::isfinite(each.get<double>()))
        throw fault(keys, "has a value that is not a finite number");
      numbers.push_back(each.get<double>());
    }
    return numbers;
  }

  int size(std::initializer_list<const char*> keys) const {
    const Json* value = find(keys);
    if (value == nullptr) return 0;
    const double size = value->is_number() ? value->get<double>() : -1;
    if (!(size >= 1 && size <= 1 << 15) || size != std::floor(size))
      throw fault(keys, "is not a whole number from 1 to 32768");
    return static_cast<int>(size);
  }

  std::string text(std::initializer_list<const char*> keys) const {
    const Json* value = find(keys);
    return value != nullptr && value->is_string() ? value->get<std::string>() : std::string();
  }

  Error fault(std::initializer_list<const char*> keys, const std::string& message) const {
    return camera_fault(file_, std::string(*keys.begin()) + " " + message);
  }

 private:
  Json json_;
  const std::filesystem::path& file_;
};

Json parsed(std::string_view text, const std::filesystem::path& file) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || text[first] != '{') return CameraYaml(text, file).read();
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    throw camera_fault(file, std::string("is not valid JSON: ") + error.what());
  }
}

/// Files of OpenCV do not state the model.
std::string model_by_count(std::size_t count, const std::filesystem::path& file) {
  if (count == 0) return "none";
  if (count == 5) return "plumb_bob";
  if (count == 8) return "rational_polynomial";
  throw camera_fault(file, "no distortion_model, and " + std::to_string(count) +
                               " distortion coefficients: expected plumb_bob, rational_polynomial "
                               "or equidistant");
}

}  // namespace

FileCamera read_ros_camera(std::string_view text, const std::filesystem::path& file,
                           const std::string& wanted) {
  const CameraInfo info(parsed(text, file), file);
  FileCamera result;
  result.camera.name = info.text({"camera_name"});
  if (result.camera.name.empty()) result.camera.name = file.stem().string();
  choose_camera({result.camera.name}, wanted, file);
  const auto matrix = info.numbers({"camera_matrix", "K", "k"});
  if (!matrix) throw camera_fault(file, "no camera_matrix (K)");
  Lens& lens = result.camera.lens;
  lens = pinhole_lens(*matrix, file.string() + ": camera_matrix (K)");
  lens.width = info.size({"image_width", "width"});
  lens.height = info.size({"image_height", "height"});
  result.coefficients =
      info.numbers({"distortion_coefficients", "D", "d"}).value_or(std::vector<double>());
  result.model = info.text({"distortion_model"});
  if (result.model.empty()) result.model = model_by_count(result.coefficients.size(), file);
  if (result.coefficients.empty() && result.model == "plumb_bob") result.model = "none";
  return result;
}

}  // namespace adasplats
