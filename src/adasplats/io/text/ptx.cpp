// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adasplats/core/maths/rigid_transform.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/point_files.h"

namespace adasplats {
namespace {

/// The header of a scan. PTX uses row vectors: p_world = p_scanner * matrix, so the matrix' rows
/// are the columns of the linear part and its last row is the scanner's position.
struct ScanHeader {
  std::uint64_t points = 0;
  Mat3d world_from_scanner;  ///< need not be a rotation: files with scales exist
  Vec3d scanner_world;
  /// Neither the matrix nor the stated position moves the points.
  bool is_identity = false;
};

class PtxReader {
 public:
  explicit PtxReader(const std::filesystem::path& path) : file_(path), lines_(file_) {}

  Table read() {
    while (const std::optional<std::string_view> line = lines_.next_filled()) read_scan(*line);
    if (values_.empty()) throw lines_.error_here("the file has no scans");
    if (identities_ == scans_ && scans_ > 1)
      throw lines_.error_here("all " + std::to_string(scans_) +
                              " stations of the file have the identity matrix: each is in its own "
                              "frame; register them, or give one station per file");
    Table table;
    table.rows = values_.front().size();
    std::vector<std::string> names = {"x", "y", "z", "intensity"};
    if (numbers_per_line_ == 7) names.insert(names.end(), {"red", "green", "blue"});
    names.insert(names.end(), {"sensor_x", "sensor_y", "sensor_z"});
    for (std::size_t k = 0; k < names.size(); ++k)
      table.columns.push_back(Column{names[k], std::move(values_[k])});
    if (without_return_ > 0)
      table.notes.push_back(
          {NoteKind::no_return, std::to_string(without_return_) + " points without a return"});
    if (identities_ == scans_)
      table.notes.push_back({NoteKind::own_frame,
                             "its station has the identity matrix: the world is the scanner's own "
                             "frame, with the scanner at 0, 0, 0"});
    return table;
  }

  /// Whether the first scan is in its own frame. Reads its header.
  bool begins_in_own_frame() { return read_header(next_line()).is_identity; }

 private:
  void read_scan(std::string_view first_line) {
    const ScanHeader scan = read_header(first_line);
    ++scans_;
    identities_ += scan.is_identity ? 1 : 0;
    // "0 0 0 0" and its line end.
    constexpr std::uint64_t kMinBytes = 8;
    const std::uint64_t room = (file_.remaining() + 1) / kMinBytes;
    if (scan.points > room) {
      throw lines_.error_here("found room for at most " + std::to_string(room) +
                              " points after this line, the scan's header states " +
                              std::to_string(scan.points));
    }
    if (values_.empty()) values_.resize(7);
    for (std::uint64_t k = 0; k < scan.points; ++k) take_point(scan, next_line());
  }

  ScanHeader read_header(std::string_view first_line) {
    const std::uint64_t columns = parse_count(first_line);
    const std::uint64_t rows = parse_count(next_line());
    ScanHeader scan;
    if (__builtin_mul_overflow(columns, rows, &scan.points))
      throw lines_.error_here("columns x rows is above 2^64");
    // The scanner's position and axes; the matrix repeats them with its scale.
    const std::array<double, 3> stated = parse_numbers<3>(next_line());
    for (int k = 0; k < 3; ++k) parse_numbers<3>(next_line());
    Mat3d linear;
    for (int k = 0; k < 3; ++k) {
      const std::array<double, 4> row = parse_numbers<4>(next_line());
      linear.rows[k] = {row[0], row[1], row[2]};
    }
    scan.world_from_scanner = linear.transposed();
    const std::array<double, 4> last = parse_numbers<4>(next_line());
    scan.scanner_world = {last[0], last[1], last[2]};
    scan.is_identity = linear.rows[0] == Vec3d{1, 0, 0} && linear.rows[1] == Vec3d{0, 1, 0} &&
                       linear.rows[2] == Vec3d{0, 0, 1} && scan.scanner_world == Vec3d{} &&
                       stated == std::array<double, 3>{};
    return scan;
  }

  void take_point(const ScanHeader& scan, std::string_view line) {
    std::array<double, 7> numbers{};
    std::size_t count = 0;
    BlankTokens tokens(line);
    for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next()) {
      const std::optional<double> number = parse_number<double>(token);
      if (!number || count == numbers.size())
        throw lines_.error_here("found " + shown(token) + ", expected " + expected_numbers());
      numbers[count++] = *number;
    }
    if (numbers_per_line_ == 0 && (count == 4 || count == 7)) {
      numbers_per_line_ = count;
      values_.resize(count + 3);
    }
    if (count != numbers_per_line_) {
      throw lines_.error_here("found " + std::to_string(count) + " numbers, expected " +
                              expected_numbers());
    }
    const Vec3d p_scanner = {numbers[0], numbers[1], numbers[2]};
    if (p_scanner == Vec3d{}) {
      ++without_return_;
      return;
    }
    const Vec3d p_world = scan.world_from_scanner * p_scanner + scan.scanner_world;
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      values_[k].push_back(p_world[axis]);
      values_[count + k].push_back(scan.scanner_world[axis]);
    }
    for (std::size_t k = 3; k < count; ++k) values_[k].push_back(numbers[k]);
  }

  std::string_view next_line() {
    const std::optional<std::string_view> line = lines_.next_filled();
    if (!line) throw lines_.error_here("the file ends within a scan");
    return *line;
  }

  std::uint64_t parse_count(std::string_view line) const {
    const std::optional<std::uint64_t> count =
        parse_number<std::uint64_t>(BlankTokens(line).rest());
    if (!count)
      throw lines_.error_here("found " + shown(line) +
                              ", expected a scan's number of columns "
                              "or rows");
    return *count;
  }

  template <std::size_t kCount>
  std::array<double, kCount> parse_numbers(std::string_view line) const {
    std::array<double, kCount> numbers{};
    BlankTokens tokens(line);
    for (double& number : numbers) {
      const std::string_view token = tokens.next();
      const std::optional<double> value = parse_number<double>(token);
      if (!value || !std::isfinite(*value)) {
        throw lines_.error_here("found " + shown(token) + " in a scan's header, expected " +
                                std::to_string(kCount) + " numbers");
      }
      number = *value;
    }
    return numbers;
  }

  std::string expected_numbers() const {
    return numbers_per_line_ == 0 ? "x y z intensity, or these and r g b"
                                  : std::to_string(numbers_per_line_) + " as in the lines before";
  }

  InputFile file_;
  LineReader lines_;
  std::size_t numbers_per_line_ = 0;
  std::uint64_t without_return_ = 0;
  std::uint64_t scans_ = 0, identities_ = 0;
  std::vector<std::vector<double>> values_;
};

}  // namespace

Table read_ptx(const std::filesystem::path& path) { return PtxReader(path).read(); }

bool is_ptx_in_own_frame(const std::filesystem::path& path) {
  return lower_case(path.extension().string()) == ".ptx" && PtxReader(path).begins_in_own_frame();
}

}  // namespace adasplats
