// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/gpu/optix/optix_library.h"

#include <dlfcn.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/gpu/optix/optix_api.h"

namespace adasplats {
namespace {

constexpr const char* kName = "libnvoptix.so.1";
constexpr const char* kOverride = "ADASPLATS_OPTIX_LIBRARY";
/// Folders searched after the loader's own paths: packages, containers, Windows Subsystem for
/// Linux.
constexpr std::array kFolders = {"/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu",
                                 "/usr/lib64", "/usr/local/nvidia/lib64", "/usr/lib/wsl/lib"};

constexpr const char* kCure =
    "it comes with the NVIDIA driver, 535 or newer; a container gets it with "
    "NVIDIA_DRIVER_CAPABILITIES=graphics,compute,utility; "
    "set ADASPLATS_OPTIX_LIBRARY if it is elsewhere; or use `device` cuda";

struct Abi {
  int number;
  std::size_t table_size;
  std::size_t pack_record, launch;  ///< indices in the table
};
constexpr std::array kAbis = {Abi{105, 52, 40, 41}, Abi{87, 48, 38, 39}};
constexpr std::size_t kLargestTable = 52;

using Table = std::array<void*, kLargestTable>;

template <class F>
void take(F& function, void* address) {
  function = std::bit_cast<F>(address);
}

/// Both ABIs have the same indices up to the functions that build micromaps.
optix::Functions functions_of(const Table& table, const Abi& abi) {
  optix::Functions functions;
  take(functions.error_name, table[0]);
  take(functions.error_string, table[1]);
  take(functions.context_create, table[2]);
  take(functions.context_destroy, table[3]);
  take(functions.module_create, table[12]);
  take(functions.module_destroy, table[15]);
  take(functions.program_group_create, table[18]);
  take(functions.program_group_destroy, table[19]);
  take(functions.pipeline_create, table[21]);
  take(functions.pipeline_destroy, table[22]);
  take(functions.build_sizes, table[24]);
  take(functions.build, table[25]);
  take(functions.compact, table[29]);
  take(functions.pack_record, table[abi.pack_record]);
  take(functions.launch, table[abi.launch]);
  return functions;
}

/// An opened library, or the reason why it could not be opened.
struct Opened {
  void* handle = nullptr;
  std::string path;
  std::string reason;
  const Abi* abi = nullptr;
  Table table{};
};

/// The reason why the loader rejected a file.
std::string why_not_opened(const std::string& path) {
  std::error_code ignored;
  const auto bytes = std::filesystem::file_size(path, ignored);
  if (!ignored && bytes == 0)
    return path +
           " is empty, as in a container started without the driver's graphics "
           "libraries";
  const char* text = dlerror();
  return "the OptiX library does not load (" + std::string(text == nullptr ? path : text) + ")";
}

/// Queries the newest supported ABI.
void ask_for_functions(Opened& opened) {
  const auto query =
      std::bit_cast<optix::QueryFunctionTable>(dlsym(opened.handle, "optixQueryFunctionTable"));
  if (query == nullptr) {
    opened.reason = opened.path + " is not the OptiX library (it has no optixQueryFunctionTable)";
    return;
  }
  for (const Abi& abi : kAbis) {
    const std::size_t bytes = abi.table_size * sizeof(void*);
    if (query(abi.number, 0, nullptr, nullptr, opened.table.data(), bytes) != 0) continue;
    opened.abi = &abi;
    return;
  }
  opened.reason = opened.path + " is too old: OptiX 8.0 is needed";
}

Opened try_open(const std::string& path) {
  Opened opened;
  opened.path = path;
  // Never unloaded: the driver's threads may outlive the last of our objects.
  opened.handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (opened.handle == nullptr) {
    opened.reason = why_not_opened(path);
    return opened;
  }
  ask_for_functions(opened);
  if (opened.abi == nullptr) dlclose(std::exchange(opened.handle, nullptr));
  return opened;
}

/// The first library that opens; otherwise the first one that exists; otherwise the reason.
Opened open_anywhere() {
  if (const char* named = std::getenv(kOverride); named != nullptr && *named != '\0')
    return try_open(named);
  if (Opened opened = try_open(kName); opened.handle != nullptr) return opened;
  std::optional<Opened> broken;
  for (const char* folder : kFolders) {
    const auto path = std::filesystem::path(folder) / kName;
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) continue;
    Opened opened = try_open(path.string());
    if (opened.handle != nullptr) return opened;
    if (!broken) broken = std::move(opened);
  }
  if (broken) return std::move(*broken);
  Opened none;
  none.reason = std::string("the OptiX library ") + kName + " was not found";
  return none;
}

}  // namespace

OptixSearch find_optix() {
  OptixSearch search;
#if defined(ADASPLATS_HAVE_CUDA)
  const Opened opened = open_anywhere();
  search.library = opened.path;
  search.available = opened.handle != nullptr;
  if (opened.handle != nullptr) {
    search.abi = opened.abi->number;
    dlclose(opened.handle);
  } else {
    search.reason = opened.reason + "; " + kCure;
  }
#else
  search.reason = "this build has no CUDA; build it where CMake finds nvcc (CUDA 12 or newer)";
#endif
  return search;
}

OptixLibrary::OptixLibrary() {
  const Opened opened = open_anywhere();
  if (opened.handle == nullptr) throw Error(ErrorKind::unavailable, opened.reason + "; " + kCure);
  handle_ = opened.handle;
  abi_ = opened.abi->number;
  functions_ = std::make_unique<optix::Functions>(functions_of(opened.table, *opened.abi));
}

OptixLibrary::~OptixLibrary() { dlclose(handle_); }

void OptixLibrary::check(int result, const char* doing, const std::string& log) const {
  if (result == 0) return;
  std::string message = std::string("cannot ") + doing +
                        " with OptiX: " + functions_->error_name(result) + " (" +
                        functions_->error_string(result) + ")";
  if (!log.empty()) message += ": " + log;
  throw Error(ErrorKind::unavailable, message + "; update the NVIDIA driver or use `device` cuda");
}

}  // namespace adasplats
