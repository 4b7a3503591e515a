// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/session/device_choice.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

/// A choice of GPUs that need not exist: nothing is done on them.
DeviceChoice imagined_gpus(bool is_automatic) {
  DeviceChoice choice;
  choice.kind = DeviceKind::cuda;
  choice.is_automatic = is_automatic;
  choice.driver = "13.0";
  for (const int number : {0, 2}) {
    GpuDevice gpu;
    gpu.index = number;
    gpu.name = "Imagined " + std::to_string(number);
    choice.gpus.push_back(gpu);
  }
  return choice;
}

class Warnings final : public ProgressSink {
 public:
  void warn(std::string_view message) override { messages.emplace_back(message); }
  std::vector<std::string> messages;
};

/// The message of the Error of that kind which the options give; empty: none.
std::string refusal(const DeviceOptions& options, ErrorKind kind) {
  try {
    choose_device(options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  return "";
}

DeviceOptions options_of(DeviceKind kind, std::vector<int> gpus = {}, bool all_gpus = false) {
  DeviceOptions options;
  options.kind = kind;
  options.gpus = std::move(gpus);
  options.all_gpus = all_gpus;
  return options;
}

TEST(ChooseDevice, TheCpuIsTakenWithoutLookingForGpus) {
  const DeviceChoice choice = choose_device(options_of(DeviceKind::cpu));
  EXPECT_FALSE(choice.on_gpu());
  EXPECT_TRUE(choice.reason.empty());
  EXPECT_NE(refusal(options_of(DeviceKind::cpu, {0}), ErrorKind::usage), "");
  EXPECT_NE(refusal(options_of(DeviceKind::cpu, {}, true), ErrorKind::usage), "");
}

// Oracle: find_gpus().
TEST(ChooseDevice, WithoutGpusAutoIsTheCpuAndAllElseIsRefused) {
  const GpuSearch search = find_gpus();
  if (!search.devices.empty()) GTEST_SKIP() << "this machine has a GPU";
  for (const bool all_gpus : {false, true}) {
    const DeviceChoice choice = choose_device(options_of(DeviceKind::automatic, {}, all_gpus));
    EXPECT_FALSE(choice.on_gpu());
    EXPECT_EQ(choice.reason, search.reason);
  }
  for (const DeviceOptions& options :
       {options_of(DeviceKind::cuda), options_of(DeviceKind::optix),
        options_of(DeviceKind::automatic, {0}), options_of(DeviceKind::cuda, {}, true)}) {
    const std::string message = refusal(options, ErrorKind::unavailable);
    EXPECT_NE(message.find(search.reason), std::string::npos) << message;
    EXPECT_NE(message.find("device cpu"), std::string::npos) << message;
  }
}

// Oracle: find_gpus().
TEST(ChooseDevice, WithGpusAutoIsTheFirstOne) {
  const GpuSearch search = find_gpus();
  if (search.devices.empty()) GTEST_SKIP() << search.reason;
  const int first = search.devices.front().index;
  const DeviceChoice choice = choose_device(options_of(DeviceKind::automatic));
  EXPECT_EQ(choice.kind, DeviceKind::cuda);
  EXPECT_TRUE(choice.is_automatic);
  EXPECT_EQ(choice.gpu_numbers(), std::vector<int>{first});
  EXPECT_FALSE(choose_device(options_of(DeviceKind::optix)).is_automatic);
  EXPECT_EQ(choose_device(options_of(DeviceKind::cuda, {}, true)).gpus.size(),
            search.devices.size());
  const std::string message =
      refusal(options_of(DeviceKind::cuda, {first, 9999}), ErrorKind::usage);
  EXPECT_NE(message.find("9999"), std::string::npos) << message;
}

TEST(TryOnGpu, TheCpusWorkIsNotDone) {
  DeviceChoice device;
  Warnings warnings;
  EXPECT_FALSE(try_on_gpu(device, warnings, [] { FAIL(); }));
  EXPECT_TRUE(warnings.messages.empty());
}

TEST(TryOnGpu, WhatSucceedsIsDoneOnce) {
  DeviceChoice device = imagined_gpus(true);
  Warnings warnings;
  int calls = 0;
  EXPECT_TRUE(try_on_gpu(device, warnings, [&] { ++calls; }));
  EXPECT_EQ(calls, 1);
  EXPECT_TRUE(device.on_gpu());
  EXPECT_TRUE(warnings.messages.empty());
}

TEST(TryOnGpu, AutoGoesOnWithTheCpuAndSaysSo) {
  DeviceChoice device = imagined_gpus(true);
  Warnings warnings;
  int calls = 0;
  const auto fail = [&] {
    ++calls;
    throw Error(ErrorKind::unavailable, "the GPU has not enough memory");
  };
  EXPECT_FALSE(try_on_gpu(device, warnings, fail));
  EXPECT_FALSE(try_on_gpu(device, warnings, fail));
  EXPECT_EQ(calls, 1) << "the CPU from then on";
  EXPECT_FALSE(device.on_gpu());
  ASSERT_EQ(warnings.messages.size(), 1U);
  EXPECT_NE(warnings.messages[0].find("not enough memory"), std::string::npos);
  EXPECT_EQ(device.reason, "the GPU has not enough memory");
}

TEST(TryOnGpu, AGpuThatWasAskedForMustDoIt) {
  DeviceChoice device = imagined_gpus(false);
  Warnings warnings;
  EXPECT_THROW(try_on_gpu(device, warnings,
                          [] { throw Error(ErrorKind::unavailable, "not enough memory"); }),
               Error);
  EXPECT_TRUE(device.on_gpu());
  EXPECT_TRUE(warnings.messages.empty());
}

TEST(TryOnGpu, OtherFaultsAreNotTheGpus) {
  DeviceChoice device = imagined_gpus(true);
  Warnings warnings;
  EXPECT_THROW(try_on_gpu(device, warnings, [] { throw Error(ErrorKind::data, "no points"); }),
               Error);
  EXPECT_THROW(try_on_gpu(device, warnings, [] { throw std::logic_error("a bug"); }),
               std::logic_error);
  EXPECT_TRUE(device.on_gpu());
  EXPECT_TRUE(warnings.messages.empty());
}

TEST(DeviceKey, TellsGpusFromTheCpu) {
  EXPECT_NE(device_key(imagined_gpus(false)), device_key(DeviceChoice()));
  EXPECT_EQ(names_of(imagined_gpus(false).gpus), "Imagined 0, Imagined 2");
}

}  // namespace
}  // namespace adasplats
