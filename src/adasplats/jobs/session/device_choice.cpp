// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/session/device_choice.h"

#include <algorithm>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// Whether the user requests a GPU.
bool asks_for_gpu(const DeviceOptions& options) {
  return options.kind == DeviceKind::cuda || options.kind == DeviceKind::optix ||
         !options.gpus.empty();
}

std::string asked_for(const DeviceOptions& options) {
  return options.gpus.empty() ? "device " + device_word(options.kind) : "gpus";
}

std::string numbers_of(const std::vector<GpuDevice>& gpus) {
  std::string text;
  for (const GpuDevice& gpu : gpus) text += (text.empty() ? "" : ", ") + std::to_string(gpu.index);
  return text;
}

GpuDevice gpu_of_number(const std::vector<GpuDevice>& found, int number) {
  const auto gpu = std::find_if(found.begin(), found.end(),
                                [number](const GpuDevice& g) { return g.index == number; });
  if (gpu == found.end()) {
    throw Error(ErrorKind::usage, "there is no GPU " + std::to_string(number) +
                                      "; the usable GPUs are " + numbers_of(found));
  }
  return *gpu;
}

std::vector<GpuDevice> chosen_gpus(const DeviceOptions& options,
                                   const std::vector<GpuDevice>& found) {
  if (options.all_gpus) return found;
  if (options.gpus.empty()) return {found.front()};
  std::vector<GpuDevice> gpus;
  for (const int number : options.gpus) gpus.push_back(gpu_of_number(found, number));
  return gpus;
}

}  // namespace

std::span<const std::pair<std::string_view, DeviceKind>> device_words() {
  static constexpr std::pair<std::string_view, DeviceKind> kWords[] = {
      {"auto", DeviceKind::automatic},
      {"cpu", DeviceKind::cpu},
      {"cuda", DeviceKind::cuda},
      {"optix", DeviceKind::optix}};
  return kWords;
}

std::string device_word(DeviceKind kind) {
  for (const auto& [word, value] : device_words()) {
    if (value == kind) return std::string(word);
  }
  return "";
}

std::string names_of(const std::vector<GpuDevice>& gpus) {
  std::string text;
  for (const GpuDevice& gpu : gpus) text += (text.empty() ? "" : ", ") + gpu.name;
  return text;
}

std::vector<int> DeviceChoice::gpu_numbers() const {
  std::vector<int> numbers;
  numbers.reserve(gpus.size());
  for (const GpuDevice& gpu : gpus) numbers.push_back(gpu.index);
  return numbers;
}

DeviceChoice choose_device(const DeviceOptions& options) {
  DeviceChoice choice;
  if (options.kind == DeviceKind::cpu) {
    if (options.all_gpus || !options.gpus.empty()) {
      throw Error(ErrorKind::usage, "`gpus` has no effect with `device` cpu; give one of them");
    }
    if (options.memory_gb > 0)
      throw Error(ErrorKind::usage, "`gpu_memory` has no effect with `device` cpu");
    return choice;
  }
  const GpuSearch search = find_gpus();
  choice.is_automatic = !asks_for_gpu(options);
  if (search.devices.empty()) {
    choice.reason = search.reason;
    if (choice.is_automatic) return choice;
    throw Error(ErrorKind::unavailable,
                asked_for(options) + ": " + search.reason + ", or use device cpu");
  }
  choice.kind = options.kind == DeviceKind::automatic ? DeviceKind::cuda : options.kind;
  choice.gpus = chosen_gpus(options, search.devices);
  for (const GpuDevice& gpu : choice.gpus)
    if (options.memory_gb > 0)
      limit_gpu_memory(gpu.index, static_cast<std::size_t>(options.memory_gb * 1e9));
  choice.driver = search.driver;
  return choice;
}

bool try_on_gpu(DeviceChoice& device, ProgressSink& progress, FunctionRef<void()> work) {
  if (!device.on_gpu()) return false;
  try {
    work();
    return true;
  } catch (const Error& error) {
    if (!device.is_automatic || error.kind() != ErrorKind::unavailable) throw;
    device = DeviceChoice();
    device.is_automatic = true;
    device.reason = error.what();
    progress.warn("the GPU failed and the CPU is used instead: " + device.reason);
    return false;
  }
}

std::string device_key(const DeviceChoice& device) {
  return device.on_gpu() ? device_word(device.kind) + " " + names_of(device.gpus)
                         : device_word(device.kind);
}

}  // namespace adasplats
