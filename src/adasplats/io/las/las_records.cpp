// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_records.h"

#include <array>
#include <string>
#include <utility>
#include <variant>

namespace adasplats {

const LasFormat& las_format(std::size_t number) {
  static constexpr std::array<LasFormat, kLasFormatCount> kFormats = {{{20, false, 0, 0},
                                                                       {28, false, 20, 0},
                                                                       {26, false, 0, 20},
                                                                       {34, false, 20, 28},
                                                                       {57, false, 20, 0},
                                                                       {63, false, 20, 28},
                                                                       {30, true, 22, 0},
                                                                       {36, true, 22, 30},
                                                                       {38, true, 22, 30},
                                                                       {59, true, 22, 0},
                                                                       {67, true, 22, 30}}};
  return kFormats.at(number);
}

LasColumns::LasColumns(const LasFormat& format, std::size_t expected_points)
    : has_gps_time_(format.gps_time_offset != 0), has_colour_(format.colour_offset != 0) {
  for (std::vector<double>* values : {&x_, &y_, &z_}) values->reserve(expected_points);
  if (has_gps_time_) gps_time_.reserve(expected_points);
  for (std::vector<std::uint16_t>* values : {&intensity_, &point_source_id_})
    values->reserve(expected_points);
  for (std::vector<std::uint8_t>* values :
       {&classification_, &return_number_, &number_of_returns_, &user_data_})
    values->reserve(expected_points);
  if (!has_colour_) return;
  for (std::vector<std::uint16_t>* values : {&red_, &green_, &blue_})
    values->reserve(expected_points);
}

void LasColumns::push(const LasPoint& point) {
  if (point.is_withheld) withheld_.push_back(size());
  x_.push_back(point.position.x);
  y_.push_back(point.position.y);
  z_.push_back(point.position.z);
  intensity_.push_back(point.intensity);
  classification_.push_back(point.classification);
  return_number_.push_back(point.return_number);
  number_of_returns_.push_back(point.number_of_returns);
  point_source_id_.push_back(point.point_source_id);
  user_data_.push_back(point.user_data);
  if (has_gps_time_) gps_time_.push_back(point.gps_time);
  if (!has_colour_) return;
  red_.push_back(point.red);
  green_.push_back(point.green);
  blue_.push_back(point.blue);
}

Table LasColumns::take() {
  Table table;
  table.rows = x_.size();
  const auto add = [&table](const char* name, auto& values) {
    table.columns.push_back(Column{name, std::move(values)});
  };
  add("x", x_);
  add("y", y_);
  add("z", z_);
  add("intensity", intensity_);
  add("classification", classification_);
  add("return_number", return_number_);
  add("number_of_returns", number_of_returns_);
  if (has_gps_time_) add("gps_time", gps_time_);
  if (has_colour_) {
    add("red", red_);
    add("green", green_);
    add("blue", blue_);
  }
  add("point_source_id", point_source_id_);
  add("user_data", user_data_);
  return table;
}

void LasColumns::drop_withheld(Table& table) const {
  if (withheld_.empty()) return;
  for (Column& column : table.columns) {
    std::visit(
        [this](auto& values) {
          auto next = withheld_.begin();
          std::size_t end = 0;
          for (std::size_t row = 0; row < values.size(); ++row) {
            if (next != withheld_.end() && *next == row)
              ++next;
            else
              values[end++] = values[row];
          }
          values.resize(end);
        },
        column.values);
  }
  table.comments.push_back("withheld: " + std::to_string(withheld_.size()) + " of " +
                           std::to_string(table.rows) + " points");
  table.rows -= withheld_.size();
}

}  // namespace adasplats
