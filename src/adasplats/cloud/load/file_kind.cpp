// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/file_kind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "adasplats/cloud/poses/pose_columns.h"
#include "adasplats/cloud/poses/rotation.h"
#include "adasplats/core/error.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/point_format.h"

namespace adasplats {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 16;
constexpr double kTolerance = 1e-3;  // of rotations, as in read_trajectory

constexpr std::array<std::string_view, 3> kMeshes = {".obj", ".gltf", ".glb"};
constexpr std::string_view kSpz = ".spz";

bool is_one_of(std::string_view word, std::span<const std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

/// The complete lines at the start of a file, with any line ends; nothing if it cannot be opened or
/// is empty. Errors: io; with `is_needed` also no_input, of a file that cannot be opened.
std::optional<std::vector<std::string>> first_lines(const std::filesystem::path& path,
                                                    bool is_needed) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::vector<std::string> lines;
  try {
    InputFile file(path);
    const auto size =
        static_cast<std::size_t>(std::min<std::uint64_t>(kMaxBytes, file.size_bytes()));
    std::string_view text(reinterpret_cast<const char*>(file.peek(size).data()), size);
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    while (!text.empty()) {
      const std::size_t end = text.find_first_of("\r\n");
      if (end == std::string_view::npos && size == kMaxBytes) break;  // cut
      std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      while (line.ends_with(' ')) line.remove_suffix(1);
      if (!line.empty()) lines.emplace_back(line);
    }
  } catch (const Error& error) {
    std::error_code ignored;
    const bool is_closed = is_needed && error.kind() == ErrorKind::no_input &&
                           std::filesystem::is_regular_file(path, ignored);
    if (error.kind() == ErrorKind::io || is_closed) throw;
    return std::nullopt;  // reading the file reports the error
  }
  return lines;
}

FileKind kind_of_ply(const std::vector<std::string>& lines) {
  bool has_radius = false, has_normal = false, is_packed = false;
  std::size_t of_gaussians = 0;
  for (const std::string& line : lines) {
    if (line == "end_header") break;
    if (line.starts_with("element face ") && line != "element face 0") return FileKind::mesh;
    const bool is_property = line.starts_with("property ");
    has_radius = has_radius || (is_property && line.ends_with(" radius"));
    has_normal = has_normal || (is_property && line.ends_with(" nx"));
    for (const char* name : {" f_dc_0", " opacity", " scale_0", " rot_0"})
      if (is_property && line.ends_with(name)) ++of_gaussians;
    is_packed = is_packed || line == "property uint packed_position";
  }
  const bool is_model = (has_radius && has_normal) || of_gaussians == 4 || is_packed;
  return is_model ? FileKind::splat_model : FileKind::points;
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  while (!line.empty()) {
    const std::size_t begin = line.find_first_not_of(", ;\t");
    if (begin == std::string_view::npos) break;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(", ;\t"), line.size());
    std::string_view word = line.substr(0, end);
    line.remove_prefix(end);
    if (word.size() >= 2 && word.front() == '"' && word.back() == '"')
      word = word.substr(1, word.size() - 2);
    words.push_back(lower_case(word));
  }
  return words;
}

std::vector<double> numbers_of(const std::vector<std::string>& words) {
  std::vector<double> numbers;
  for (const std::string& word : words) {
    const auto number = parse_number<double>(word);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

/// An ascending time, a position and a quaternion in either order. Normals with a curvature of 0
/// have unit length too, but hardly ascend in the first column.
bool is_timed_pose(const std::vector<double>& v, double before_s) {
  if (v.size() != 8 || !(v[0] > before_s)) return false;
  const double norm = std::sqrt(v[4] * v[4] + v[5] * v[5] + v[6] * v[6] + v[7] * v[7]);
  return std::fabs(norm - 1) <= kTolerance;
}

bool is_matrix_pose(const std::vector<double>& v) {
  if (v.size() != 12) return false;
  const Mat3d rotation{{{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, {v[8], v[9], v[10]}}};
  return orthonormality_error(rotation) <= kTolerance;
}

bool is_comment(std::string_view line) { return line.starts_with('#') || line.starts_with("//"); }

/// Whether the first line that can be a point is one. Only comments, counts (PTS) and at most one
/// line of names may precede it, as in read_text_points. Prose (a readme, a licence, an index of
/// tiles) has none.
bool has_a_point(const std::vector<std::string>& lines) {
  constexpr std::size_t kCoordinates = 3;
  bool has_names = false;
  for (const std::string& line : lines) {
    if (is_comment(line)) continue;
    const std::vector<std::string> words = words_of(line);
    const bool begins_with_number = !words.empty() && parse_number<double>(words.front());
    if (begins_with_number && words.size() == 1) continue;
    if (begins_with_number || has_names) return numbers_of(words).size() >= kCoordinates;
    has_names = true;
  }
  return false;
}

/// Whether a line or comment (TUM) before the first numbers names a quaternion.
bool has_pose_names(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    if (pose_heading_of(line).columns) return true;
    if (!is_comment(line) && !numbers_of(words_of(line)).empty()) return false;
  }
  return false;
}

FileKind kind_of_text(const std::vector<std::string>& lines) {
  constexpr std::size_t kMinTimedPoses = 3;
  if (!has_a_point(lines)) return FileKind::other;
  if (has_pose_names(lines)) return FileKind::trajectory;
  std::size_t poses = 0, matrices = 0, others = 0;
  double before_s = -std::numeric_limits<double>::infinity();
  for (const std::string& line : lines) {
    if (is_comment(line)) continue;
    const std::vector<double> numbers = numbers_of(words_of(line));
    if (is_timed_pose(numbers, before_s)) {
      ++poses;
      before_s = numbers[0];
    } else if (is_matrix_pose(numbers)) {
      ++matrices;
    } else {
      ++others;
    }
  }
  if (others != 0) return FileKind::points;
  return matrices != 0 || poses >= kMinTimedPoses ? FileKind::trajectory : FileKind::points;
}

}  // namespace

FileKind kind_of_file(const std::filesystem::path& file) {
  const std::string extension = lower_case(file.extension().string());
  if (is_one_of(extension, kMeshes)) return FileKind::mesh;
  if (extension == kSpz) return FileKind::splat_model;
  const PointFormat* const format = format_of_extension(file);
  // Reading a damaged file reports the error.
  if (format != nullptr && format->means == ExtensionMeaning::points) return FileKind::points;
  const auto lines = first_lines(file, format != nullptr);
  if (format != nullptr && format->means == ExtensionMeaning::text)
    return lines ? kind_of_text(*lines) : FileKind::points;
  const bool is_ply = lines && !lines->empty() && lines->front() == "ply";
  const FileKind kind = is_ply ? kind_of_ply(*lines) : FileKind::points;
  return kind == FileKind::points && format == nullptr ? FileKind::other : kind;
}

bool has_extension_of_a_kind(const std::filesystem::path& file) {
  const std::string extension = lower_case(file.extension().string());
  return format_of_extension(file) != nullptr || is_one_of(extension, kMeshes) || extension == kSpz;
}

std::string_view plural_name_of(FileKind kind) {
  switch (kind) {
    case FileKind::points: return "points";
    case FileKind::mesh: return "meshes";
    case FileKind::splat_model: return "splat models";
    case FileKind::trajectory: return "trajectories";
    case FileKind::other: break;
  }
  return "other files";
}

}  // namespace adasplats
