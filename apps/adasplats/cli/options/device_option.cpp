// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/device_option.h"

#include <algorithm>
#include <charconv>

#include "cli/options/option_types.h"

namespace adasplats::app {
namespace {

Choices<DeviceKind> choices_of_devices() {
  Choices<DeviceKind> choices;
  for (const auto& [word, kind] : device_words()) choices.emplace_back(word, kind);
  return choices;
}

[[noreturn]] void refuse(const std::string& why, const std::string& text) {
  refuse_value("--gpus", why + ", found '" + text + "'");
}

/// "0,2": different numbers, not negative.
std::vector<int> parse_gpus(const std::string& text) {
  std::vector<int> gpus;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (;;) {
    int gpu = 0;
    const auto [stop, failure] = std::from_chars(at, end, gpu);
    if (failure != std::errc() || gpu < 0 || (stop != end && *stop != ',')) {
      refuse("expected numbers of GPUs with commas between them, or all", text);
    }
    if (std::find(gpus.begin(), gpus.end(), gpu) != gpus.end()) {
      refuse("expected every GPU once", text);
    }
    gpus.push_back(gpu);
    if (stop == end) return gpus;
    at = stop + 1;
  }
}

}  // namespace

void add_device_options(OptionSet& app, DeviceOptions& options, GpuCount count) {
  constexpr const char* kGroup = "Device options";
  add_choice<DeviceKind>(app, "--device", options.kind, choices_of_devices(),
                         "What computes: cuda and optix need an NVIDIA GPU; auto takes cuda where "
                         "there is one, else cpu")
      ->group(kGroup);
  if (count == GpuCount::one) return;
  app.add_option_function<std::string>(
         "--gpus",
         [&options](const std::string& text) {
           options.all_gpus = text == "all";
           options.gpus = options.all_gpus ? std::vector<int>() : parse_gpus(text);
         },
         "GPUs that share the work, as info --devices numbers them (0,1), or all; the default is "
         "the first")
      ->type_name("LIST|all")
      ->group(kGroup);
}

}  // namespace adasplats::app
