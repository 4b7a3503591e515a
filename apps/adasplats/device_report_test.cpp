// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "device_report.h"

#include <gtest/gtest.h>

namespace adasplats::app {
namespace {

TEST(DeviceReport, NamesWhatComputes) {
  DeviceChoice gpus;
  gpus.kind = DeviceKind::cuda;
  gpus.driver = "13.0";
  gpus.gpus.resize(2);
  gpus.gpus[0].name = "Imagined 0";
  gpus.gpus[1].name = "Imagined 2";
  gpus.gpus[1].index = 2;
  EXPECT_EQ(device_json(gpus).dump(),
            R"({"kind":"cuda","name":"Imagined 0, Imagined 2","driver":"13.0","gpus":[0,2]})");
  const std::string cpu = device_json(DeviceChoice()).dump();
  EXPECT_TRUE(cpu.starts_with(R"({"kind":"cpu",)")) << cpu;
  EXPECT_TRUE(cpu.ends_with(R"("driver":null})")) << cpu;
}

}  // namespace
}  // namespace adasplats::app
