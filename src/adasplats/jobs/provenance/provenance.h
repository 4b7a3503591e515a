// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "adasplats/jobs/session/device_choice.h"

namespace adasplats {

/// Where a figure comes from: what every report and benchmark carries. Models, scans and their
/// manifests carry none of it: their bytes depend on data and settings alone.
struct Provenance {
  std::string version;        ///< of the library
  std::string commit;         ///< it was built from; "unknown" where the build could not say
  std::optional<bool> dirty;  ///< the sources differed from the commit; nothing: unknown
  std::string date;           ///< of now, UTC: 2026-01-31T12:00:00Z
  std::string command;        ///< of this process
  int threads = 0;
  DeviceChoice device;
};

/// Of work that this process does now.
Provenance provenance_of(int threads, const DeviceChoice& device = {});

/// {"version", "commit", "dirty", "date", "command", "machine", "device"}, see machine_json() and
/// device_json(); null: unknown.
nlohmann::ordered_json to_json(const Provenance& provenance);

/// A word as a POSIX shell takes it: in quotes where it needs them.
std::string shell_word(const std::string& word);

/// The program with these arguments as a user types it in a shell.
std::string command_text(const std::vector<std::string>& arguments);

/// What this process was started with, behind the program; empty where the system does not say.
std::vector<std::string> own_arguments();

/// How this process was started, the program without its folder; empty where the system does not
/// say.
std::string own_command_line();

}  // namespace adasplats
