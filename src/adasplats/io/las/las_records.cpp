// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/las/las_records.h"

#include <array>

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

}  // namespace adasplats
