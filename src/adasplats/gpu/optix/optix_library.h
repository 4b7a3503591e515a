// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace adasplats {

namespace optix {
struct Functions;
}

/// Result of a search for OptiX, which is a library of the NVIDIA driver.
struct OptixSearch {
  bool available = false;
  std::string reason;   ///< why it is not available, and the remedy; empty if it is
  std::string library;  ///< path or name of the opened library
  int abi = 0;          ///< 105 (OptiX 9.0) or 87 (OptiX 8.0)
};

/// Searches for OptiX: the file named by the environment variable ADASPLATS_OPTIX_LIBRARY,
/// otherwise libnvoptix.so.1 in the loader's paths, otherwise in the folders used by drivers. Never
/// throws. Does not check for a GPU: see find_gpus().
OptixSearch find_optix();

/// Private to gpu/: the opened library.
class OptixLibrary {
 public:
  /// Errors: unavailable, with the reason of find_optix().
  OptixLibrary();
  ~OptixLibrary();
  OptixLibrary(const OptixLibrary&) = delete;
  OptixLibrary& operator=(const OptixLibrary&) = delete;

  const optix::Functions& functions() const { return *functions_; }
  int abi() const { return abi_; }

  /// Throws if an OptiX call failed: unavailable, with the action, the library's name of the error
  /// and its `log`.
  void check(int result, const char* doing, const std::string& log = {}) const;

 private:
  void* handle_ = nullptr;
  std::unique_ptr<optix::Functions> functions_;
  int abi_ = 0;
};

}  // namespace adasplats
