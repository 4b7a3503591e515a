// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "device_report.h"

#include "compare/machine.h"

namespace adasplats::app {

nlohmann::ordered_json device_json(const DeviceChoice& device) {
  nlohmann::ordered_json json = {{"kind", device_word(device.kind)}};
  if (device.on_gpu()) {
    json["name"] = names_of(device.gpus);
    json["driver"] = device.driver;
    json["gpus"] = device.gpu_numbers();
  } else {
    json["name"] = cpu_name();
    json["driver"] = nullptr;
    if (!device.reason.empty()) json["reason"] = device.reason;
  }
  return json;
}

}  // namespace adasplats::app
