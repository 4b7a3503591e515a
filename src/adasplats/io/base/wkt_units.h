// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace adasplats {

/// Which coordinates of a projected or vertical system, in words (OGC 01-009, ISO 19162), have
/// another unit than metres, such as "z in foot (0.3048 m), by the WKT"; nothing where all are in
/// metres or the text does not say. Units of angles, of ellipsoids and of a projection's parameters
/// are not those of coordinates.
std::optional<std::string> foreign_units_of_wkt(std::string_view text);

/// How the text begins, up to its first comma, where it is a system of longitudes and latitudes;
/// nothing where it is a projected one (which names its base, too), one of Cartesian coordinates
/// about the earth's centre, or something else.
std::optional<std::string> geographic_system_of_wkt(std::string_view text);

}  // namespace adasplats
