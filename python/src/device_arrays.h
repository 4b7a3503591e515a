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

/// An array in GPU memory that Python hands on through DLPack.
struct DeviceArray {
  std::shared_ptr<void> keep;  ///< what its memory lives in; may be freed without the GIL
  const void* data = nullptr;
  int device = 0;  ///< CUDA's number
  dlpack::DataType type;
  std::vector<std::int64_t> shape;
  std::vector<std::int64_t> strides;  ///< in elements
  std::function<void()> wait;         ///< until its values are there; none: they are
};

/// Adds the class to Scene.
void add_device_arrays(SceneClass& type);

}  // namespace adasplats::python
