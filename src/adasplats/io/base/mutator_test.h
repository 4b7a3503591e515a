// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>
#include <string>
#include <string_view>

namespace adasplats::io_test {

/// Breaks a file in one to four ways.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::string mutate(std::string content, const std::string& other) {
    const std::size_t steps = 1 + below(4);
    for (std::size_t step = 0; step < steps && !content.empty(); ++step)
      mutate_once(content, other);
    return content;
  }

 private:
  std::size_t below(std::size_t limit) { return static_cast<std::size_t>(random_() % limit); }

  /// Every other time within the first bytes, where the header is.
  std::size_t place_in(const std::string& content) {
    const std::size_t limit =
        below(2) == 0 ? std::min<std::size_t>(400, content.size()) : content.size();
    return below(limit);
  }

  void mutate_once(std::string& content, const std::string& other) {
    const std::size_t place = place_in(content);
    switch (below(7)) {
      case 0: content[place] = static_cast<char>(content[place] ^ (1 << below(8))); break;
      case 1: content[place] = static_cast<char>(random_()); break;
      case 2: content.resize(place); break;
      case 3: {  // splice
        const std::size_t from = below(other.size());
        content.insert(place, other.substr(from, 1 + below(40)));
        break;
      }
      case 4: content.erase(place, 1 + below(20)); break;
      case 5: replace_number(content, place); break;
      default: {
        const std::uint64_t extreme = kExtremes[below(std::size(kExtremes))];
        for (std::size_t k = 0; k < 8 && place + k < content.size(); ++k)
          content[place + k] = static_cast<char>(extreme >> (8 * k));
      }
    }
  }

  /// Writes an extreme number over the next digits of a text.
  void replace_number(std::string& content, std::size_t place) {
    constexpr std::string_view kDigits = "0123456789";
    const std::size_t begin = content.find_first_of(kDigits, place);
    if (begin == std::string::npos) return;
    std::size_t end = content.find_first_not_of(kDigits, begin);
    end = std::min(end, content.size());
    constexpr const char* kNumbers[] = {
        "-1",    "0",   "4294967295",          "4294967296", "2147483648", "18446744073709551615",
        "1e999", "nan", "9223372036854775807", "1e-999",     "65536",      "1537228672809129302"};
    content.replace(begin, end - begin, kNumbers[below(std::size(kNumbers))]);
  }

  static constexpr std::uint64_t kExtremes[] = {0,
                                                0xffffffffffffffff,
                                                0x7fffffffffffffff,
                                                0x8000000000000000,
                                                0x7ff0000000000000,
                                                0x0000000100000001,
                                                0x7f800000ffffffff};
  std::mt19937_64 random_;
};

}  // namespace adasplats::io_test
