// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "adasplats/sensors/packet_layout.h"

namespace adasplats {

// Private to sensors/: firing times of Hesai's models, from Hesai's fire time correction files.
// They are the same for all units of a model. Lasers count from 0 as in the angle correction file.

/// When each laser fires after the first one, s; for models that fire all lasers in every column
/// and are not in the library.
std::vector<double> hesai_firing_times_s(PacketFormat format);

/// Time since the start of a block, s. QT128: of the firing sequence (0 or 1) with 96 lasers; 0 for
/// lasers that do not fire in it.
double late_s_of_qt128(unsigned sequence, std::size_t laser);
/// OT128: by its time in High Resolution mode and the block's azimuth state.
double late_s_of_ot128(double fine_s, bool is_fine, unsigned azimuth_state, std::size_t laser);
double late_s_of_at128(std::size_t laser);

/// The model whose angle correction file has these elevations and azimuths, in the order of
/// lasers; nothing if its packets are not supported.
std::optional<PacketFormat> hesai_model_of(const std::vector<double>& elevations_deg,
                                           const std::vector<double>& azimuths_deg);

}  // namespace adasplats
