// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/tree_names.h"

#include "adasplats/io/base/sha256.h"

namespace adasplats {

std::string padded_number(std::size_t index, std::size_t digits) {
  const std::string number = std::to_string(index);
  return std::string(number.size() < digits ? digits - number.size() : 0, '0') + number;
}

std::string token_of(std::string_view name) {
  constexpr std::size_t kDigits = 32;
  return sha256_of(name).substr(0, kDigits);
}

std::string uuid_of(std::string_view name) {
  std::string uuid = token_of(name);
  for (const std::size_t place : {8, 13, 18, 23}) uuid.insert(place, "-");
  return uuid;
}

}  // namespace adasplats
