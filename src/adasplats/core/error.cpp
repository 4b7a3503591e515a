// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/error.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <system_error>

namespace adasplats {

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::usage: return 64;
    case ErrorKind::data: return 65;
    case ErrorKind::no_input: return 66;
    case ErrorKind::unavailable: return 69;
    case ErrorKind::software: return 70;
    case ErrorKind::cannot_create: return 73;
    case ErrorKind::io: return 74;
    case ErrorKind::config: return 78;
  }
  return 70;
}

Error data_error(const FilePosition& place, const std::string& message) {
  std::string text = place.file.string() + ":";
  if (place.line) text += std::to_string(*place.line) + ":";
  if (place.byte_offset) text += " byte " + std::to_string(*place.byte_offset) + ":";
  return Error(ErrorKind::data, text + " " + message);
}

Error system_error(ErrorKind kind, const std::filesystem::path& file, const std::string& message,
                   int errno_value) {
  return Error(
      kind, file.string() + ": " + message + ": " + std::generic_category().message(errno_value));
}

namespace {

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

/// Lower-case letters and digits: "OS-1_64" and "os1-64" mean the same name.
std::string bare(const std::string& word) {
  std::string letters;
  for (const char c : word) {
    if (c >= 'A' && c <= 'Z') {
      letters += static_cast<char>(c - 'A' + 'a');
    } else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) {
      letters += c;
    }
  }
  return letters;
}

constexpr std::size_t kMinLetters = 2;  // of a part of a word

/// The candidates that `fits`, the shortest first; none if a user could not read them on one line.
template <class Fits>
std::vector<std::string> words_that(const Fits& fits, const std::vector<std::string>& candidates) {
  constexpr std::size_t kMaxWords = 6;
  std::vector<std::string> found;
  std::ranges::copy_if(candidates, std::back_inserter(found), fits);
  if (found.size() > kMaxWords) found.clear();
  std::ranges::stable_sort(found, {}, &std::string::size);
  return found;
}

std::vector<std::string> words_containing(const std::string& word,
                                          const std::vector<std::string>& candidates) {
  const std::string part = bare(word);
  if (part.size() < kMinLetters) return {};
  return words_that(
      [&](const std::string& each) { return bare(each).find(part) != std::string::npos; },
      candidates);
}

std::vector<std::string> words_beginning_with(const std::string& word,
                                              const std::vector<std::string>& candidates) {
  if (bare(word).size() < kMinLetters) return {};
  return words_that([&](const std::string& each) { return each.starts_with(word); }, candidates);
}

}  // namespace

std::vector<std::string> similar_words(const std::string& word,
                                       const std::vector<std::string>& candidates) {
  if (std::vector<std::string> longer = words_beginning_with(word, candidates); !longer.empty())
    return longer;
  std::optional<std::string> best;
  // More edits than half the letters of the word make another word, not a typo.
  std::size_t best_distance = std::max<std::size_t>(2, word.size() / 2) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  if (best) return {*best};
  return words_containing(word, candidates);
}

std::optional<std::string> nearest_word(const std::string& word,
                                        const std::vector<std::string>& candidates) {
  std::vector<std::string> similar = similar_words(word, candidates);
  if (similar.empty()) return std::nullopt;
  return std::move(similar.front());
}

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::vector<std::string> similar = similar_words(word, candidates);
  std::string text;
  for (std::size_t i = 0; i < similar.size(); ++i)
    text += (i == 0 ? ", did you mean '" : (i + 1 == similar.size() ? " or '" : ", '")) +
            similar[i] + "'";
  return text.empty() ? text : text + "?";
}

std::string unknown_word(const std::string& what, const std::string& word,
                         const std::vector<std::string>& known) {
  const std::string found = "unknown " + what + " '" + word + "'";
  if (const std::string meant = did_you_mean(word, known); !meant.empty()) return found + meant;
  std::string all;
  for (const std::string& k : known) all += (all.empty() ? "" : ", ") + k;
  return found + (known.empty() ? "" : "; expected one of " + all);
}

}  // namespace adasplats
