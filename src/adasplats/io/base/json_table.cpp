// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/json_table.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxValuesOfRow = 100'000;
constexpr int kDeepest = 32;
constexpr std::size_t kMaxTextsBytes = std::size_t{1} << 24;

/// A number beyond the range of a double (1e999) is not a parse_error.
Error no_json(const std::filesystem::path& file, const json::exception& problem) {
  const auto* const damage = dynamic_cast<const json::parse_error*>(&problem);
  return {
      ErrorKind::data,
      file.string() + (damage != nullptr ? ": byte " + std::to_string(damage->byte) +
                                               ": invalid JSON; the file is damaged or truncated"
                                         : ": contains a number beyond the range of a double")};
}

double finite_real(const json& value, const JsonRow& row, const std::string& what) {
  if (!value.is_number()) throw row.fault("expected a number" + what);
  const double number = value.get<double>();
  if (!std::isfinite(number)) throw row.fault("expected a finite number" + what);
  return number;
}

std::string quoted(const char* key) { return " '" + std::string(key) + "'"; }

}  // namespace

Error JsonRow::fault(const std::string& what) const {
  return {ErrorKind::data,
          file_->string() + ": element " + std::to_string(number_) + " (from 0): " + what};
}

const json& JsonRow::member(const char* key) const {
  if (!value_->is_object()) throw fault("expected an object");
  const auto found = value_->find(key);
  if (found == value_->end()) throw fault("has no" + quoted(key));
  return *found;
}

bool JsonRow::has(const char* key) const { return value_->is_object() && value_->contains(key); }

std::string JsonRow::text(const char* key) const {
  const json& value = member(key);
  if (!value.is_string()) throw fault("expected a text" + quoted(key));
  return value.get<std::string>();
}

double JsonRow::real(const char* key) const { return finite_real(member(key), *this, quoted(key)); }

double JsonRow::real() const { return finite_real(*value_, *this, ""); }

std::int64_t JsonRow::integer(const char* key) const {
  const json& value = member(key);
  // A number beyond 63 bits would become negative.
  const bool fits =
      value.is_number_integer() &&
      (!value.is_number_unsigned() || std::in_range<std::int64_t>(value.get<std::uint64_t>()));
  if (!fits) throw fault("expected a whole number" + quoted(key));
  return value.get<std::int64_t>();
}

bool JsonRow::boolean(const char* key) const {
  const json& value = member(key);
  if (!value.is_boolean()) throw fault("expected true or false," + quoted(key));
  return value.get<bool>();
}

JsonRow JsonRow::object(const char* key) const { return {*file_, number_, member(key)}; }

template <std::size_t kCount>
std::array<double, kCount> JsonRow::reals(const char* key) const {
  const json& value = member(key);
  if (!value.is_array() || value.size() != kCount)
    throw fault("expected " + std::to_string(kCount) + " numbers" + quoted(key));
  std::array<double, kCount> numbers{};
  for (std::size_t k = 0; k < kCount; ++k) numbers[k] = finite_real(value[k], *this, quoted(key));
  return numbers;
}

std::array<double, 3> JsonRow::triple(const char* key) const { return reals<3>(key); }

Mat3d JsonRow::rotation(const std::array<double, 4>& wxyz, const char* key) const {
  constexpr double kTolerance = 1e-3;
  const auto [w, x, y, z] = wxyz;
  const double norm = std::sqrt(w * w + x * x + y * y + z * z);
  if (!(std::fabs(norm - 1) <= kTolerance))
    throw fault("the quaternion" + quoted(key) + " is not a rotation: its length is " +
                exact_text(norm) + ", expected 1");
  return rotation_from_quaternion(w / norm, x / norm, y / norm, z / norm);
}

std::array<double, 9> JsonRow::matrix(const char* key) const {
  constexpr std::size_t kSide = 3;
  const json& rows = member(key);
  const auto is_row = [](const json& row) { return row.is_array() && row.size() == kSide; };
  if (!rows.is_array() || rows.size() != kSide || !std::ranges::all_of(rows, is_row))
    throw fault("expected three rows of three numbers" + quoted(key));
  std::array<double, 9> numbers{};
  for (std::size_t k = 0; k < numbers.size(); ++k)
    numbers[k] = finite_real(rows[k / kSide][k % kSide], *this, quoted(key));
  return numbers;
}

RigidTransform JsonRow::pose(const char* translation, const char* rotation_key) const {
  const auto [x, y, z] = reals<3>(translation);
  return {rotation(reals<4>(rotation_key), rotation_key), {x, y, z}};
}

void for_each_json_row(const std::filesystem::path& file,
                       const std::function<void(const JsonRow&)>& visit) {
  std::error_code problem;
  if (!std::filesystem::is_regular_file(file, problem))
    throw Error(ErrorKind::no_input, file.string() + ": no such file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(ErrorKind::no_input, file.string() + ": cannot be read");
  std::size_t rows = 0, values = 0;
  const auto look = [&](int depth, json::parse_event_t event, json& parsed) {
    using Event = json::parse_event_t;
    if (depth == 0 && event != Event::array_start && event != Event::array_end)
      throw Error(ErrorKind::data, file.string() + ": expected an array");
    if (depth > kDeepest || ++values > kMaxValuesOfRow)
      throw Error(ErrorKind::data,
                  file.string() + ": element " + std::to_string(rows) +
                      " (from 0) has more than 100,000 values; this is not a table");
    if (depth != 1 || event == Event::object_start || event == Event::array_start) return true;
    visit(JsonRow(file, rows, parsed));
    ++rows;
    values = 0;
    return false;  // discard the element
  };
  try {
    [[maybe_unused]] const json rest = json::parse(stream, look);
  } catch (const json::exception& problem_there) {
    if (stream.bad()) throw Error(ErrorKind::io, file.string() + ": reading failed");
    throw no_json(file, problem_there);
  }
}

void for_each_json_text(const std::filesystem::path& file,
                        const std::function<void(const std::string&, const std::string&)>& visit) {
  std::error_code ignored;
  if (std::filesystem::file_size(file, ignored) > kMaxTextsBytes && !ignored)
    throw Error(ErrorKind::data,
                file.string() + ": is larger than 16 MiB; this is not a table of names");
  json texts;
  try {
    texts = json::parse(read_file(file));
  } catch (const json::exception& problem) {
    throw no_json(file, problem);
  }
  if (!texts.is_object()) throw Error(ErrorKind::data, file.string() + ": expected an object");
  for (const auto& [key, text] : texts.items()) {
    if (!text.is_string())
      throw Error(ErrorKind::data, file.string() + ": '" + key + "': expected a text");
    visit(key, text.get<std::string>());
  }
}

}  // namespace adasplats
