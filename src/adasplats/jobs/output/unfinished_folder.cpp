// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/output/unfinished_folder.h"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <set>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kDigits = 64;

/// Whether a line is "SHA-256  NAME".
bool is_digest_line(const std::string& line) {
  return line.size() >= kDigits + 3 && line.compare(kDigits, 2, "  ") == 0 &&
         line.find_first_not_of("0123456789abcdef") == kDigits;
}

std::string shown(const Json* value) {
  if (value == nullptr) return "nothing";
  std::string text = value->dump(-1, ' ', false, Json::error_handler_t::replace);
  constexpr std::size_t kMaxLength = 60;
  return text.size() <= kMaxLength ? text : text.substr(0, kMaxLength) + "...";
}

const Json* find(const Json& object, const std::string& key) {
  const auto found = object.find(key);
  return found != object.end() ? &*found : nullptr;
}

std::string difference(const Json& earlier, const Json& now, bool more_allowed) {
  std::set<std::string> keys;
  for (const auto& [key, value] : now.items()) keys.insert(key);
  if (!more_allowed)
    for (const auto& [key, value] : earlier.items()) keys.insert(key);
  for (const std::string& key : keys) {
    const Json* const a = find(earlier, key);
    const Json* const b = find(now, key);
    if (a != nullptr && b != nullptr && *a == *b) continue;
    if (a != nullptr && b != nullptr && a->is_object() && b->is_object())
      return key + "." + difference(*a, *b, false);
    return key + " was " + shown(a) + " and is " + shown(b);
  }
  return "";
}

}  // namespace

fs::path unfinished_of(const fs::path& folder) {
  return folder.parent_path() / ("." + folder.filename().string() + ".unfinished");
}

std::string difference_of_runs(const Json& earlier, const Json& now) {
  return difference(earlier, now, true);
}

std::optional<Journal> read_journal(const fs::path& unfinished) {
  const fs::path file = unfinished / kJournalFile;
  if (!fs::exists(file)) return std::nullopt;
  Journal journal;
  std::string& text = journal.complete_lines;
  text = read_file(file);
  const std::size_t complete = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  journal.is_torn = complete != text.size();
  text.resize(complete);
  std::size_t line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    const std::string line = text.substr(begin, end - begin);
    ++line_number;
    if (!is_digest_line(line))
      throw Error(ErrorKind::data,
                  file.string() + ":" + std::to_string(line_number) + " is damaged");
    journal.files[line.substr(kDigits + 2)] = line.substr(0, kDigits);
    begin = end + 1;
  }
  return journal;
}

fs::path note_of(const fs::path& file) { return file.string() + ".sha256"; }

void write_note(const fs::path& file, const std::string& sha256) {
  write_file(note_of(file), sha256 + "  " + file.filename().string() + "\n");
}

std::optional<std::string> read_note(const fs::path& file) {
  std::error_code none;
  if (!fs::is_regular_file(note_of(file), none)) return std::nullopt;
  std::string text = read_file(note_of(file));
  if (text.empty() || text.back() != '\n') return std::nullopt;
  text.pop_back();
  if (!is_digest_line(text) || text.substr(kDigits + 2) != file.filename().string())
    return std::nullopt;
  return text.substr(0, kDigits);
}

void write_digests(const fs::path& file, std::span<const FileDigest> digests) {
  std::string text;
  for (const auto& [name, sha256] : digests)
    text.append(sha256).append("  ").append(name).append("\n");
  write_file(file, text);
}

std::optional<std::vector<FileDigest>> read_digests(const fs::path& file) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return std::nullopt;
  const std::string text = read_file(file);
  std::vector<FileDigest> digests;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) return std::nullopt;
    const std::string line = text.substr(begin, end - begin);
    if (!is_digest_line(line)) return std::nullopt;
    digests.push_back({line.substr(kDigits + 2), line.substr(0, kDigits)});
    begin = end + 1;
  }
  return digests;
}

}  // namespace adasplats
