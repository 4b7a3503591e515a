// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace adasplats {

/// A kind of objects.
struct ObjectKind {
  std::string_view word;     ///< that its labels contain
  std::string_view moving;   ///< its class of SemanticKITTI
  std::string_view at_rest;  ///< the same of objects at rest
  bool is_vehicle;           ///< symmetric, and parked at times
};

/// The kind of an object by its label in any data set, such as "Medium-sized Truck", or by the name
/// of its class.
ObjectKind object_kind_of(std::string_view label);

}  // namespace adasplats
