// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "compare/machine.h"

#include <unistd.h>

#include <fstream>
#include <string>

namespace adasplats::app {
namespace {

using Json = nlohmann::ordered_json;

/// What stands behind the separator in the first line of `file` that begins with `key`.
Json value_in(const char* file, const std::string& key, char separator) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t at = line.find(separator);
    if (at == std::string::npos) continue;
    std::string value = line.substr(at + 1);
    const std::size_t first = value.find_first_not_of(" \t\"");
    const std::size_t last = value.find_last_not_of(" \t\"");
    if (first != std::string::npos) return value.substr(first, last - first + 1);
  }
  return nullptr;
}

std::uint64_t machine_memory_bytes() {
  const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
  return pages > 0 && page_bytes > 0
             ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes)
             : 0;
}

}  // namespace

std::uint64_t usable_memory_bytes() {
  std::uint64_t bytes = machine_memory_bytes();
  // Control groups, version 2 and 1, as a container sees them; "max" is not a number.
  for (const char* file :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::uint64_t limit = 0;
    if (std::ifstream(file) >> limit && limit > 0 && limit < bytes) bytes = limit;
  }
  return bytes;
}

Json cpu_name() { return value_in("/proc/cpuinfo", "model name", ':'); }

Json machine_json(int threads) {
  return {{"cpu", cpu_name()},
          {"cores", threads},
          {"memory_bytes", machine_memory_bytes()},
          {"system", value_in("/etc/os-release", "PRETTY_NAME", '=')}};
}

}  // namespace adasplats::app
