// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "adasplats/dataset/encoded_scan.h"
#include "adasplats/dataset/scan_writer.h"
#include "adasplats/io/base/sha256.h"
#include "adasplats/simulate/scan/scan_view.h"

namespace adasplats {

struct ParallelWriteOptions {
  int threads = 1;  ///< that encode and write, in addition to the caller's; at least 1
  FileWrites writes = FileWrites::atomic;
  bool hashed = false;  ///< whether `written` needs the SHA-256 of files; otherwise they are empty
  /// Returns additional files of a scan; must be thread-safe.
  std::function<std::vector<EncodedFile>(std::size_t index, const ScanView& scan)> more_files;
  /// Called for every scan with written files, in the order of write() and one at a time, on any
  /// thread; the main file is the last one.
  std::function<void(std::size_t index, std::size_t points, std::span<const FileDigest> files)>
      written;
};

/// Writes scans in the background: several threads encode and write their files; data common to all
/// scans is appended in the order of the scans. The bytes do not depend on the number of threads.
/// Memory: three scans and their bytes per thread; a faster caller waits.
class ParallelScanWriter {
 public:
  /// `writer` must outlive it.
  ParallelScanWriter(ScanWriter& writer, ParallelWriteOptions options);
  /// Without finish(), pending scans are discarded.
  ~ParallelScanWriter();
  ParallelScanWriter(const ParallelScanWriter&) = delete;
  ParallelScanWriter& operator=(const ParallelScanWriter&) = delete;

  /// Queues a scan; waits while too many are pending. Exceptions of threads are rethrown here or in
  /// finish(), whichever is called next. Not thread-safe; numbers must ascend.
  void write(std::size_t index, HeldScan scan);
  /// Waits until all scans are written, then calls ScanWriter::finish(). Call once, last.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
