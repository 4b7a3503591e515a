// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace adasplats {

/// The names of the values of an enumeration on the command line, in files and in Python.
template <class T>
using Words = std::span<const std::pair<std::string_view, T>>;

/// The word of a value. Throws std::logic_error for a value without one.
template <class T>
std::string_view word_of(T value, std::type_identity_t<Words<T>> words) {
  for (const auto& [word, each] : words)
    if (each == value) return word;
  throw std::logic_error("a value without a word");
}

/// The value of a word. Errors: std::invalid_argument.
template <class T, std::size_t N>
T value_of(std::string_view word, const std::pair<std::string_view, T> (&words)[N]) {
  for (const auto& [each, value] : words)
    if (each == word) return value;
  throw std::invalid_argument("no such word: " + std::string(word));
}

/// The words, in order.
template <class T>
std::vector<std::string> list_of(Words<T> words) {
  std::vector<std::string> list;
  for (const auto& [word, value] : words) list.emplace_back(word);
  return list;
}

}  // namespace adasplats
