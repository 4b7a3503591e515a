// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#if defined(ADASPLATS_HAVE_CUDA)
#include "adasplats/gpu/base/sparse_device_array.h"

#include <cuda.h>
#include <cuda_runtime_api.h>

#include <algorithm>
#include <bit>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/gpu/base/cuda_check.h"
#include "adasplats/gpu/base/memory_account.h"

namespace adasplats::gpu {
namespace {

constexpr unsigned kDriverVersion = 12000;  // of the functions below

/// Finds a function of the driver, which is not linked.
template <class Function>
Function driver_function(const char* name) {
  void* function = nullptr;
  cudaDriverEntryPointQueryResult found = cudaDriverEntryPointSymbolNotFound;
  cuda_check(
      cudaGetDriverEntryPointByVersion(name, &function, kDriverVersion, cudaEnableDefault, &found),
      "ask the driver for its functions");
  if (found != cudaDriverEntryPointSuccess || function == nullptr)
    throw Error(ErrorKind::unavailable,
                std::string("the GPU driver has no ") + name + "; update the driver");
  return reinterpret_cast<Function>(function);
}

/// Driver functions that reserve addresses and map memory to them.
struct Driver {
  decltype(&cuMemGetAllocationGranularity) granularity =
      driver_function<decltype(&cuMemGetAllocationGranularity)>("cuMemGetAllocationGranularity");
  decltype(&cuMemAddressReserve) reserve =
      driver_function<decltype(&cuMemAddressReserve)>("cuMemAddressReserve");
  decltype(&cuMemAddressFree) free =
      driver_function<decltype(&cuMemAddressFree)>("cuMemAddressFree");
  decltype(&cuMemCreate) create = driver_function<decltype(&cuMemCreate)>("cuMemCreate");
  decltype(&cuMemRelease) release = driver_function<decltype(&cuMemRelease)>("cuMemRelease");
  decltype(&cuMemMap) map = driver_function<decltype(&cuMemMap)>("cuMemMap");
  decltype(&cuMemUnmap) unmap = driver_function<decltype(&cuMemUnmap)>("cuMemUnmap");
  decltype(&cuMemSetAccess) set_access =
      driver_function<decltype(&cuMemSetAccess)>("cuMemSetAccess");
};

const Driver& driver() {
  static const Driver functions;
  return functions;
}

CUmemAllocationProp memory_of(int device) {
  CUmemAllocationProp properties{};
  properties.type = CU_MEM_ALLOCATION_TYPE_PINNED;
  properties.location.type = CU_MEM_LOCATION_TYPE_DEVICE;
  properties.location.id = device;
  return properties;
}

void check(CUresult result, const char* doing) {
  if (result == CUDA_SUCCESS) return;
  cuda_check(result == CUDA_ERROR_OUT_OF_MEMORY ? cudaErrorMemoryAllocation : cudaErrorUnknown,
             doing);
}

CUdeviceptr address(const std::byte* data) { return reinterpret_cast<CUdeviceptr>(data); }

}  // namespace

ReservedDeviceMemory::ReservedDeviceMemory(std::size_t bytes) {
  constexpr const char* kDoing = "reserve addresses for the tiles of a city on the GPU";
  cuda_check(cudaGetDevice(&device_), kDoing);
  cuda_check(cudaFree(nullptr), kDoing);  // the driver's functions need its context
  const CUmemAllocationProp properties = memory_of(device_);
  check(driver().granularity(&page_bytes_, &properties, CU_MEM_ALLOC_GRANULARITY_MINIMUM), kDoing);
  pages_.resize(std::max<std::size_t>(1, (bytes + page_bytes_ - 1) / page_bytes_));
  bytes_ = pages_.size() * page_bytes_;
  CUdeviceptr reserved = 0;
  check(driver().reserve(&reserved, bytes_, 0, 0, 0), kDoing);
  data_ = std::bit_cast<std::byte*>(reserved);
}

ReservedDeviceMemory::~ReservedDeviceMemory() {
  for (std::size_t page = 0; page < pages_.size(); ++page)
    if (pages_[page].holders > 0) unmap(page);
  driver().free(address(data_), bytes_);
}

void ReservedDeviceMemory::hold(std::size_t begin, std::size_t end) {
  if (begin >= end) return;
  const std::size_t first = begin / page_bytes_, last = (end - 1) / page_bytes_;
  for (std::size_t page = first; page <= last; ++page) {
    try {
      if (pages_[page].holders == 0) map(page);
    } catch (...) {
      release(begin, page * page_bytes_);
      throw;
    }
    ++pages_[page].holders;
  }
}

void ReservedDeviceMemory::release(std::size_t begin, std::size_t end) {
  if (begin >= end) return;
  for (std::size_t page = begin / page_bytes_; page <= (end - 1) / page_bytes_; ++page)
    if (--pages_[page].holders == 0) unmap(page);
}

void ReservedDeviceMemory::map(std::size_t page) {
  constexpr const char* kDoing = "get memory of the GPU for a tile";
  const CUmemAllocationProp properties = memory_of(device_);
  CUmemGenericAllocationHandle memory = 0;
  MemoryAccount& account = MemoryAccount::of(device_);
  account.take(page_bytes_, kDoing);
  const CUresult created = driver().create(&memory, page_bytes_, &properties, 0);
  if (created != CUDA_SUCCESS) account.give_back(page_bytes_);
  check(created, kDoing);
  const CUdeviceptr at = address(data_ + page * page_bytes_);
  const CUmemAccessDesc access = {properties.location, CU_MEM_ACCESS_FLAGS_PROT_READWRITE};
  const CUresult mapped = driver().map(at, page_bytes_, 0, memory, 0);
  const CUresult result =
      mapped == CUDA_SUCCESS ? driver().set_access(at, page_bytes_, &access, 1) : mapped;
  if (result != CUDA_SUCCESS) {
    if (mapped == CUDA_SUCCESS) driver().unmap(at, page_bytes_);
    driver().release(memory);
    account.give_back(page_bytes_);
    check(result, kDoing);
  }
  pages_[page].memory = memory;
}

void ReservedDeviceMemory::unmap(std::size_t page) {
  driver().unmap(address(data_ + page * page_bytes_), page_bytes_);
  driver().release(pages_[page].memory);
  MemoryAccount::of(device_).give_back(page_bytes_);
  pages_[page] = {};
}

}  // namespace adasplats::gpu
#endif
