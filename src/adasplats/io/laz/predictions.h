// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace adasplats {

/// An approximate median of the last numbers, the prediction of LASzip: of five sorted numbers the
/// largest is replaced as long as new ones are below the middle, else the smallest.
class RunningMedian {
 public:
  std::int32_t get() const { return values_[2]; }

  void add(std::int32_t value) {
    const std::int32_t middle = values_[2];
    if (drops_largest_) {
      std::size_t place = 4;
      for (; place > 0 && value < values_[place - 1]; --place) values_[place] = values_[place - 1];
      values_[place] = value;
      drops_largest_ = value < middle;
    } else {
      std::size_t place = 0;
      for (; place < 4 && values_[place + 1] < value; ++place) values_[place] = values_[place + 1];
      values_[place] = value;
      drops_largest_ = !(middle < value);
    }
  }

 private:
  std::array<std::int32_t, 5> values_{};  // ascending
  bool drops_largest_ = true;
};

// Similar returns of a beam share models and predictions, chosen by the number of the return and
// the number of returns of the beam (tables of LASzip, laszip_common_v2.hpp and _v3.hpp; files
// exist in which either number is 0 or both are swapped).

/// For counts below 8: one of 16 groups.
inline std::size_t group_of_return(unsigned returns, unsigned number) {
  constexpr std::array<std::string_view, 8> kGroups = {"fedcba98", "e0136aa9", "d1247bba",
                                                       "c3458ccb", "b6789ddc", "aabcdeed",
                                                       "9abcdefe", "89abcdef"};
  const char digit = kGroups[returns][number];
  return static_cast<std::size_t>(digit <= '9' ? digit - '0' : digit - 'a' + 10);
}

/// For counts below 16: one of 6 groups.
inline std::size_t coarse_group_of_return(unsigned returns, unsigned number) {
  constexpr std::array<std::string_view, 16> kGroups = {
      "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
      "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
      "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
      "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455"};
  return static_cast<std::size_t>(kGroups[returns][number] - '0');
}

/// Number of returns that follow, 0 to 7: points of equal depth have similar heights.
inline std::size_t depth_of_return(unsigned returns, unsigned number) {
  const unsigned depth = returns > number ? returns - number : number - returns;
  return depth < 7 ? depth : 7;
}

}  // namespace adasplats
