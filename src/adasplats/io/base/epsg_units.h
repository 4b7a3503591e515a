// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace adasplats {

/// Codes of the EPSG registry.
inline constexpr std::uint16_t kEpsgMetre = 9001;

/// The name of a unit by its code, "US survey feet (1200/3937 m)"; nothing for the metre and for
/// units that are not lengths.
std::optional<std::string> foreign_length_of(std::uint16_t unit);

/// The unit of x and y in the projected system EPSG:`system`, or of heights in the vertical system
/// EPSG:`system`: the metre except for the systems in epsg_unit_table.h. Nothing if the system is
/// newer than that table.
std::optional<std::uint16_t> unit_of_projected_system(std::uint16_t system);
std::optional<std::uint16_t> unit_of_vertical_system(std::uint16_t system);

}  // namespace adasplats
