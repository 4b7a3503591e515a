// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace adasplats::app {

/// Rows of text in columns: the first column flush left, the others flush right.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header);

  /// Cells from the left; missing ones are blank.
  void add_row(std::vector<std::string> cells);
  /// The table with a line under the header; every line ends with a line break.
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

/// "12,345,678".
std::string grouped(std::uint64_t number);
/// With that many decimals; "-" for NaN.
std::string fixed(double number, int digits);
/// A share of 0..1 as "12.3 %"; "-" for NaN.
std::string percent(double share);
/// Metres as "1.23 cm"; "-" for NaN.
std::string centimetres(double metres);

}  // namespace adasplats::app
