// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/memory.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <memory>
#include <string>

#include "adasplats/core/error.h"

namespace adasplats {

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux gives kibibytes
}

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  // The size on x86 and most ARM; elsewhere the call fails without effect. Arrays of less than
  // eight pages would lose too much at the ends.
  constexpr std::size_t kPage = std::size_t{2} << 20U;
  if (bytes < 8 * kPage) return;
  void* first = memory;
  std::size_t left = bytes;
  if (std::align(kPage, kPage, first, left) == nullptr) return;
  static_cast<void>(::madvise(first, left / kPage * kPage, MADV_HUGEPAGE));
#endif
}

ReservedMemory::ReservedMemory(std::size_t bytes) : bytes_(bytes) {
  if (bytes == 0) return;
  void* const data = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                            MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (data == MAP_FAILED)
    throw Error(ErrorKind::unavailable,
                "cannot reserve " + std::to_string(bytes >> 30U) +
                    " GiB of address space (check ulimit -v and vm.overcommit_memory)");
  data_ = static_cast<std::byte*>(data);
}

ReservedMemory::~ReservedMemory() {
  if (data_ != nullptr) ::munmap(data_, bytes_);
}

void ReservedMemory::release(std::size_t begin, std::size_t end) {
  static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t first = (begin + page - 1) / page * page;
  const std::size_t last = end / page * page;
  if (first < last) static_cast<void>(::madvise(data_ + first, last - first, MADV_DONTNEED));
}

}  // namespace adasplats
