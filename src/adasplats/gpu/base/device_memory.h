// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "adasplats/gpu/base/cuda_check.h"
#include "adasplats/gpu/base/memory_account.h"

namespace adasplats::gpu {

/// Private to gpu/: owners of CUDA resources. All are movable, not copyable, and release what they
/// own.

/// A queue of work on the current device.
class Stream {
 public:
  Stream() {
    cuda_check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "make a CUDA stream");
  }
  ~Stream() {
    if (stream_ != nullptr) cudaStreamDestroy(stream_);
  }
  Stream(Stream&& other) noexcept : stream_(std::exchange(other.stream_, nullptr)) {}
  Stream& operator=(Stream&& other) noexcept {
    std::swap(stream_, other.stream_);
    return *this;
  }

  cudaStream_t get() const { return stream_; }
  /// Waits for everything queued so far; kernel errors are reported here.
  void wait(std::string_view doing) const { cuda_check(cudaStreamSynchronize(stream_), doing); }

 private:
  cudaStream_t stream_ = nullptr;
};

/// A point in a stream, to wait for or to time.
class Event {
 public:
  Event() { cuda_check(cudaEventCreate(&event_), "make a CUDA event"); }
  ~Event() {
    if (event_ != nullptr) cudaEventDestroy(event_);
  }
  Event(Event&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}
  Event& operator=(Event&& other) noexcept {
    std::swap(event_, other.event_);
    return *this;
  }

  void record(cudaStream_t stream) { cuda_check(cudaEventRecord(event_, stream), "time the GPU"); }
  void wait(std::string_view doing) const { cuda_check(cudaEventSynchronize(event_), doing); }
  /// Seconds from `start` to this event; both must be complete.
  double seconds_since(const Event& start) const {
    float milliseconds = 0;
    cuda_check(cudaEventElapsedTime(&milliseconds, start.event_, event_), "time the GPU");
    return 1e-3 * static_cast<double>(milliseconds);
  }
  cudaEvent_t get() const { return event_; }

 private:
  cudaEvent_t event_ = nullptr;
};

/// Device memory for `size()` values, allocated and freed in stream order (freed memory is reused
/// without a call to the driver). Initially undefined. The stream must outlive the buffer, and
/// other streams must have finished using it.
template <class T>
class DeviceBuffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  DeviceBuffer() = default;
  DeviceBuffer(std::size_t size, cudaStream_t stream) : size_(size), stream_(stream) {
    if (size == 0) return;
    constexpr const char* kDoing = "get memory of the GPU";
    account_ = &MemoryAccount::current();
    account_->take(bytes(), kDoing);
    void* memory = nullptr;
    const cudaError_t status = cudaMallocAsync(&memory, bytes(), stream);
    if (status != cudaSuccess) account_->give_back(bytes());
    cuda_check(status, kDoing);
    data_ = static_cast<T*>(memory);
  }
  /// A copy of host memory; pageable memory may be reused when this returns.
  DeviceBuffer(std::span<const T> values, cudaStream_t stream)
      : DeviceBuffer(values.size(), stream) {
    upload(values);
  }
  ~DeviceBuffer() {
    if (data_ == nullptr) return;
    cudaFreeAsync(data_, stream_);
    account_->give_back(bytes());
  }
  DeviceBuffer(DeviceBuffer&& other) noexcept { swap(other); }
  DeviceBuffer& operator=(DeviceBuffer&& other) noexcept {
    DeviceBuffer taken(std::move(other));  // what this one held is freed now
    swap(taken);
    return *this;
  }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::size_t bytes() const { return size_ * sizeof(T); }

  /// Copies the first values.size() values from the host.
  void upload(std::span<const T> values) {
    if (values.empty()) return;
    cuda_check(
        cudaMemcpyAsync(data_, values.data(), values.size_bytes(), cudaMemcpyHostToDevice, stream_),
        "copy to the GPU");
  }
  /// Copies all values to the host after everything queued before.
  std::vector<T> download() const { return download(size_); }
  std::vector<T> download(std::size_t count) const {
    std::vector<T> values(count);
    if (count > 0) {
      cuda_check(
          cudaMemcpyAsync(values.data(), data_, count * sizeof(T), cudaMemcpyDeviceToHost, stream_),
          "copy from the GPU");
    }
    cuda_check(cudaStreamSynchronize(stream_), "copy from the GPU");
    return values;
  }
  /// Sets every byte.
  void fill_bytes(int byte) {
    if (size_ > 0) cuda_check(cudaMemsetAsync(data_, byte, bytes(), stream_), "clear GPU memory");
  }

 private:
  void swap(DeviceBuffer& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(stream_, other.stream_);
    std::swap(account_, other.account_);
  }

  T* data_ = nullptr;
  std::size_t size_ = 0;
  cudaStream_t stream_ = nullptr;
  MemoryAccount* account_ = nullptr;
};

/// Page-locked host memory: copies run at full speed, and the GPU can access it directly.
template <class T>
class PinnedBuffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  PinnedBuffer() = default;
  explicit PinnedBuffer(std::size_t size) : size_(size) {
    if (size == 0) return;
    void* memory = nullptr;
    cuda_check(cudaHostAlloc(&memory, size * sizeof(T), cudaHostAllocPortable),
               "get page-locked memory for copies from the GPU");
    data_ = static_cast<T*>(memory);
  }
  ~PinnedBuffer() {
    if (data_ != nullptr) cudaFreeHost(data_);
  }
  PinnedBuffer(PinnedBuffer&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}
  PinnedBuffer& operator=(PinnedBuffer&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::span<T> span() const { return {data_, size_}; }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Keeps the memory of freed buffers of a device for reuse by the process; releases it on
/// destruction.
class MemoryPoolGuard {
 public:
  explicit MemoryPoolGuard(int device);
  ~MemoryPoolGuard();
  MemoryPoolGuard(const MemoryPoolGuard&) = delete;
  MemoryPoolGuard& operator=(const MemoryPoolGuard&) = delete;

 private:
  cudaMemPool_t pool_ = nullptr;
};

}  // namespace adasplats::gpu
