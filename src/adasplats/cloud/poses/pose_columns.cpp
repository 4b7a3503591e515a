// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/poses/pose_columns.h"

#include <algorithm>
#include <initializer_list>
#include <span>
#include <utility>

#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

using Word = std::string_view;

/// What a column may be. The first eight are those of PoseColumns::of.
enum class PoseRole : std::uint8_t {
  time,
  x,
  y,
  z,
  qw,
  qx,
  qy,
  qz,
  nanoseconds,
  numbered,  ///< of a quaternion by a number
  other
};

constexpr std::array<Word, 8> kRoleNames = {"time", "x", "y", "z", "qw", "qx", "qy", "qz"};
constexpr Word kTimeWords[] = {"time", "timestamp", "timestamps", "stamp", "t", "sec", "secs"};
/// Only if no column has one of those names.
constexpr Word kOtherTimeWords[] = {"gpstime", "unixtime", "utctime", "ts",
                                    "epoch",   "seconds",  "times"};
constexpr Word kNanosecondWords[] = {"nsec", "nsecs", "nanosec", "nanosecs"};
constexpr Word kPositionWords[] = {"p", "t", "pos", "position", "translation", "trans", "location"};
constexpr Word kQuaternionWords[] = {"q", "quat", "quaternion", "orientation", "rotation", "rot"};
constexpr std::pair<Word, double> kTimeUnits[] = {
    {"s", 1},     {"seconds", 1},         {"ms", 1e-3}, {"milliseconds", 1e-3},
    {"us", 1e-6}, {"microseconds", 1e-6}, {"ns", 1e-9}, {"nanoseconds", 1e-9}};
constexpr const char* kExpected =
    "expected a time (time, timestamp, timestamp_ns, ...), a position (x, y, z; tx, ...; "
    "position.x, ...) and a quaternion whose names say its order (qw, qx, qy, qz; quat_w, ...; "
    "orientation.w, ...)";

constexpr Word kAngleWords[] = {"roll", "pitch", "yaw", "heading", "azimuth"};
constexpr const char* kConvertAngles =
    "; angles are not read, since makers differ in their axes and order: convert them to a "
    "quaternion (for x forward, y left and z up, Python's "
    "scipy.spatial.transform.Rotation.from_euler('ZYX', [yaw, pitch, roll]).as_quat() is qx, qy, "
    "qz, qw)";

bool is_one_of_words(Word word, std::span<const Word> words) {
  return std::ranges::find(words, word) != words.end();
}

bool is_letter_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); }

/// A name in parts: "pose.orientation.w" is pose, orientation, w; "[ns]" behind it is a unit.
struct NameParts {
  std::vector<std::string> words;
  std::string unit;  ///< in brackets
  bool has_unit = false;

  bool has_any(std::span<const Word> among) const {
    return std::ranges::any_of(words,
                               [&](const std::string& w) { return is_one_of_words(w, among); });
  }
};

NameParts parts_of(std::string_view field) {
  NameParts parts;
  std::string name = lower_case(field);
  if (const std::size_t bracket = name.find_first_of("[("); bracket != std::string::npos) {
    const std::size_t end = std::min(name.find_first_of("])", bracket), name.size());
    parts.unit = name.substr(bracket + 1, end - bracket - 1);
    parts.has_unit = !parts.unit.empty();
    name.resize(bracket);
  }
  std::string word;
  for (const char c : name + " ") {
    if (is_letter_or_digit(c)) {
      word += c;
    } else if (!word.empty()) {
      parts.words.push_back(std::exchange(word, {}));
    }
  }
  return parts;
}

const double* time_unit_of(Word word) {
  for (const auto& [name, unit_s] : kTimeUnits)
    if (name == word) return &unit_s;
  return nullptr;
}

struct ColumnMeaning {
  PoseRole role = PoseRole::other;
  double unit_s = 1;
  /// Of times: 2 a message's own time rather than when it was recorded, 0 one of kOtherTimeWords.
  int rank = 1;
  std::string problem;
};

PoseRole quaternion_role(char component) {
  switch (component) {
    case 'w': return PoseRole::qw;
    case 'x': return PoseRole::qx;
    case 'y': return PoseRole::qy;
    case 'z': return PoseRole::qz;
    default: return component >= '0' && component <= '9' ? PoseRole::numbered : PoseRole::other;
  }
}

PoseRole position_role(char axis) {
  return axis == 'x' ? PoseRole::x : axis == 'y' ? PoseRole::y : PoseRole::z;
}

ColumnMeaning meaning_of_time(NameParts parts) {
  ColumnMeaning meaning;
  if (is_one_of_words(parts.words.back(), kNanosecondWords)) {
    meaning.role = PoseRole::nanoseconds;
    return meaning;
  }
  if (parts.words.size() > 1)
    if (const double* const unit_s = time_unit_of(parts.words.back())) {
      meaning.unit_s = *unit_s;
      parts.words.pop_back();
    }
  if (is_one_of_words(parts.words.back(), kOtherTimeWords))
    meaning.rank = 0;
  else if (!is_one_of_words(parts.words.back(), kTimeWords))
    return {};
  else if (std::ranges::find(parts.words, "header") != parts.words.end())
    meaning.rank = 2;
  meaning.role = PoseRole::time;
  if (!parts.has_unit) return meaning;
  if (const double* const unit_s = time_unit_of(parts.unit))
    meaning.unit_s = *unit_s;
  else
    meaning.problem = "a time in " + shown(parts.unit) + ", expected s, ms, us or ns";
  return meaning;
}

ColumnMeaning meaning_of_column(std::string_view field) {
  NameParts parts = parts_of(field);
  if (parts.words.empty()) return {};
  if (parts.words.size() > 1 && parts.words.back() == "m") parts.words.pop_back();
  const std::string& last = parts.words.back();
  const bool is_quaternion = parts.has_any(kQuaternionWords);
  ColumnMeaning meaning;
  if (last.size() == 2 && last[0] == 'q') meaning.role = quaternion_role(last[1]);
  if (last.size() == 1 && is_quaternion && parts.words.size() > 1)
    meaning.role = quaternion_role(last[0]);
  if (meaning.role != PoseRole::other || is_quaternion) return meaning;
  const char axis = last.back();
  const bool is_axis = axis >= 'x' && axis <= 'z';
  const bool is_short = last.size() == 2 && (last[0] == 't' || last[0] == 'p');
  const bool is_alone = last.size() == 1 && parts.words.size() == 1;
  const bool is_named = last.size() == 1 && parts.has_any(kPositionWords);
  if (!is_axis || !(is_short || is_alone || is_named)) return meaning_of_time(std::move(parts));
  meaning.role = position_role(axis);
  if (parts.has_unit && parts.unit != "m")
    meaning.problem = "a position in " + shown(parts.unit) + ", expected m";
  return meaning;
}

std::string list_of_fields(const std::vector<std::string_view>& fields) {
  std::string list;
  for (const std::string_view field : fields)
    list += (list.empty() ? "" : ", ") + std::string(field);
  return list;
}

/// Columns by their roles, as far as they are named.
class RoleTable {
 public:
  explicit RoleTable(const std::vector<std::string_view>& fields) : fields_(fields) {
    for (std::size_t i = 0; i < fields.size(); ++i) take(i, meaning_of_column(fields[i]));
  }

  PoseHeading heading() const {
    std::size_t named = 0;
    std::string missing;
    for (std::size_t role = 0; role < kRoleNames.size(); ++role) {
      if (columns_[role])
        ++named;
      else
        missing += (missing.empty() ? "" : ", ") + std::string(kRoleNames[role]);
    }
    constexpr std::size_t kSome = 3;  // a point's x, y and z are no heading of poses...
    const bool has_some = named > kSome || (named == kSome && (numbered_ || columns_[0]));
    PoseHeading heading;
    if (!missing.empty()) {
      if (has_some)
        heading.problem =
            "names the columns " + list_of_fields(fields_) + ": no " + missing +
            (numbered_ ? "; a quaternion by numbers does not say which is the scalar" : "") + "; " +
            kExpected + (has_angles() ? kConvertAngles : "");
      return heading;
    }
    if (!problem_.empty()) {
      heading.problem = problem_ + "; " + kExpected;
      return heading;
    }
    PoseColumns& columns = heading.columns.emplace();
    for (std::size_t role = 0; role < kRoleNames.size(); ++role) columns.of[role] = *columns_[role];
    columns.nanoseconds = nanoseconds_;
    columns.time_unit_s = unit_s_;
    columns.count = fields_.size();
    return heading;
  }

 private:
  bool has_angles() const {
    return std::ranges::any_of(
        fields_, [](std::string_view field) { return parts_of(field).has_any(kAngleWords); });
  }

  void take(std::size_t column, const ColumnMeaning& meaning) {
    if (meaning.role == PoseRole::other) return;
    if (problem_.empty()) problem_ = meaning.problem;
    if (meaning.role == PoseRole::numbered) {
      numbered_ = true;
      return;
    }
    if (meaning.role == PoseRole::nanoseconds) {
      if (!nanoseconds_) nanoseconds_ = column;
      return;
    }
    const auto role = static_cast<std::size_t>(meaning.role);
    const bool is_time = meaning.role == PoseRole::time;
    if (columns_[role]) {
      if (is_time && time_rank_ != meaning.rank) {
        if (time_rank_ > meaning.rank) return;
      } else {
        if (problem_.empty())
          problem_ = "both " + shown(fields_[*columns_[role]]) + " and " + shown(fields_[column]) +
                     " may be " + std::string(kRoleNames[role]);
        return;
      }
    }
    columns_[role] = column;
    if (!is_time) return;
    unit_s_ = meaning.unit_s;
    time_rank_ = meaning.rank;
  }

  const std::vector<std::string_view>& fields_;
  std::array<std::optional<std::size_t>, 8> columns_;
  std::optional<std::size_t> nanoseconds_;
  double unit_s_ = 1;
  int time_rank_ = 0;
  bool numbered_ = false;
  std::string problem_;
};

std::vector<std::string_view> split_at(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(BlankTokens(line.substr(0, end)).rest());
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

}  // namespace

PoseColumns PoseColumns::tum() {
  PoseColumns columns;
  columns.of = {0, 1, 2, 3, 7, 4, 5, 6};
  columns.count = columns.of.size();
  return columns;
}

std::vector<std::string_view> split_pose_fields(std::string_view line) {
  for (const char separator : {',', ';'})
    if (line.find(separator) != std::string_view::npos) return split_at(line, separator);
  return split_blanks(line);
}

PoseHeading pose_heading_of(std::string_view line) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  while (!line.empty() && (line.front() == '#' || line.front() == '%')) line.remove_prefix(1);
  const std::vector<std::string_view> fields = split_pose_fields(line);
  return RoleTable(fields).heading();
}

}  // namespace adasplats
