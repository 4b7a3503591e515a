// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/provenance/machine.h"

#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/core/setting.h"
#include "adasplats/gpu/base/device.h"

namespace adasplats {
namespace {

using Json = nlohmann::ordered_json;

/// The text after the separator in the first line of `file` that begins with `key`.
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

Json cpu_name() { return value_in("/proc/cpuinfo", "model name", ':'); }

/// The first word of digits and dots in the version file of NVIDIA's kernel module.
Json kernel_driver() {
  std::ifstream file("/proc/driver/nvidia/version");
  for (std::string word; file >> word;) {
    if (word.find('.') != std::string::npos &&
        word.find_first_not_of("0123456789.") == std::string::npos) {
      return word;
    }
  }
  return nullptr;
}

#if defined(__clang__)
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

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

Json machine_json(int threads) {
  return {{"cpu", cpu_name()},
          {"cores", threads},
          {"memory_bytes", machine_memory_bytes()},
          {"system", value_in("/etc/os-release", "PRETTY_NAME", '=')},
          {"compiler", kCompiler}};
}

Json device_json(const DeviceChoice& device) {
  Json json = {{"kind", device_word(device.kind)}};
  if (device.on_gpu()) {
    json["name"] = names_of(device.gpus);
    json["driver"] = device.driver;
    json["kernel_driver"] = kernel_driver();
    json["gpus"] = device.gpu_numbers();
    for (const GpuDevice& gpu : device.gpus)
      json["peak_bytes"].push_back(peak_gpu_memory(gpu.index));
  } else {
    json["name"] = cpu_name();
    json["driver"] = nullptr;
    if (!device.reason.empty()) json["reason"] = with_settings_as_options(device.reason);
  }
  return json;
}

}  // namespace adasplats
