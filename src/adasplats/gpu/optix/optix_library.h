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

/// What a search for OptiX found. It is a library of the NVIDIA driver.
struct OptixSearch {
  bool available = false;
  std::string reason;   ///< where it is not available: why, and what to do about it
  std::string library;  ///< path or name of what was opened
  int abi = 0;          ///< 105 (OptiX 9.0) or 87 (OptiX 8.0)
};

/// Looks for OptiX: the file that the environment variable ADASPLATS_OPTIX_LIBRARY names, else
/// libnvoptix.so.1 where libraries are, else in the folders where drivers put it. Never throws. A
/// GPU is another matter: find_gpus().
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

  /// Throws where an OptiX call failed: unavailable, with what was being done, the library's name
  /// of the error and `log`, what it wrote about it.
  void check(int result, const char* doing, const std::string& log = {}) const;

 private:
  void* handle_ = nullptr;
  std::unique_ptr<optix::Functions> functions_;
  int abi_ = 0;
};

}  // namespace adasplats
