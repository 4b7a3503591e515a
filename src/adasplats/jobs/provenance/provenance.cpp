// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/provenance/provenance.h"

#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "adasplats/jobs/provenance/build_commit.h"
#include "adasplats/jobs/provenance/machine.h"

namespace adasplats {
namespace {

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

}  // namespace

Provenance provenance_of(int threads, const DeviceChoice& device) {
  const std::string_view state = kBuildState;
  Provenance provenance;
  provenance.version = ADASPLATS_VERSION;
  provenance.commit = kBuildCommit;
  if (state != "unknown") provenance.dirty = state == "dirty";
  provenance.date = utc_now();
  provenance.command = own_command_line();
  provenance.threads = threads;
  provenance.device = device;
  return provenance;
}

nlohmann::ordered_json to_json(const Provenance& provenance) {
  using Json = nlohmann::ordered_json;
  return {{"version", provenance.version},
          {"commit", provenance.commit},
          {"dirty", provenance.dirty ? Json(*provenance.dirty) : Json()},
          {"date", provenance.date},
          {"command", provenance.command},
          {"machine", machine_json(provenance.threads)},
          {"device", device_json(provenance.device)}};
}

std::string shell_word(const std::string& word) {
  const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string command_text(const std::vector<std::string>& arguments) {
  std::string text = "adasplats";
  for (const std::string& argument : arguments) text += " " + shell_word(argument);
  return text;
}

std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  std::string word;
  std::getline(file, word, '\0');
  while (std::getline(file, word, '\0')) words.push_back(word);
  return words;
}

std::string own_command_line() {
  std::error_code failure;
  std::string text =
      shell_word(std::filesystem::read_symlink("/proc/self/exe", failure).filename().string());
  if (failure) return "";
  for (const std::string& word : own_arguments()) text += " " + shell_word(word);
  return text;
}

}  // namespace adasplats
