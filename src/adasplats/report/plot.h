// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "adasplats/report/document.h"

namespace adasplats::page {

/// A plot of numbers over numbers, of any sign, as inline SVG; zero is always on the value axis.
/// Points that are not finite break a line.
std::string plot_svg(const Plot& plot);

/// Multiples of 1, 2 or 5 times a power of ten that hold [lowest, highest], at most nine.
std::vector<double> ticks_around(double lowest, double highest);

}  // namespace adasplats::page
