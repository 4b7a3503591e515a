// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "dlpack.h"
#include "scenes.h"

namespace adasplats::python {

/// An array in GPU memory that Python exports through DLPack.
struct DeviceArray {
  std::shared_ptr<void> keep;  ///< owner of the memory; may be freed without the GIL
  const void* data = nullptr;
  int device = 0;  ///< CUDA device index
  dlpack::DataType type;
  std::vector<std::int64_t> shape;
  std::vector<std::int64_t> strides;  ///< in elements
  std::function<void()> wait;         ///< waits for the values; empty: they are complete
};

/// Adds the class to Scene.
void add_device_arrays(SceneClass& type);

}  // namespace adasplats::python
