// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// DLPack, for sharing arrays with NumPy, PyTorch, CuPy and JAX: the structures of version 0.x,
/// which every consumer accepts. Source: DLPack specification, dmlc.github.io/dlpack (C API), and
/// the Python array API standard's __dlpack__.
namespace adasplats::dlpack {

enum class DeviceType : std::int32_t { cpu = 1, cuda = 2 };

struct Device {
  DeviceType type = DeviceType::cpu;
  std::int32_t number = 0;
};

enum class TypeCode : std::uint8_t { integer = 0, unsigned_integer = 1, floating = 2 };

struct DataType {
  TypeCode code = TypeCode::floating;
  std::uint8_t bits = 32;
  std::uint16_t lanes = 1;
};

struct Tensor {
  void* data = nullptr;
  Device device;
  std::int32_t axes = 0;
  DataType type;
  std::int64_t* shape = nullptr;
  std::int64_t* strides = nullptr;  ///< in elements
  std::uint64_t byte_offset = 0;
};

/// The consumer calls `deleter` once, from any thread, when it is done.
struct ManagedTensor {
  Tensor tensor;
  void* owner = nullptr;
  void (*deleter)(ManagedTensor* self) = nullptr;
};
static_assert(sizeof(Tensor) == 48 && sizeof(ManagedTensor) == 64);

/// Names of the capsule before and after a consumer has taken the tensor.
inline constexpr const char* kFresh = "dltensor";
inline constexpr const char* kUsed = "used_dltensor";

}  // namespace adasplats::dlpack
