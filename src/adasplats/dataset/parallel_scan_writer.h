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
  int threads = 1;  ///< that encode and write, beside the caller's; at least 1
  FileWrites writes = FileWrites::atomic;
  bool hashed = false;  ///< whether `written` needs the SHA-256 of files; else they are empty
  /// More files of a scan; several threads call it at once.
  std::function<std::vector<EncodedFile>(std::size_t index, const ScanView& scan)> more_files;
  /// Hears of every scan whose files are written, in the order of write() and one at a time, on any
  /// thread; the main file is the last one.
  std::function<void(std::size_t index, std::size_t points, std::span<const FileDigest> files)>
      written;
};

/// Writes scans beside the thread that makes them: several threads encode and write their files,
/// what all scans have in common is appended in the order in which scans came. The same bytes for
/// any number of threads. Memory: three scans and their bytes a thread; who is faster waits.
class ParallelScanWriter {
 public:
  /// `writer` has to outlive it.
  ParallelScanWriter(ScanWriter& writer, ParallelWriteOptions options);
  /// Without finish() what is not written yet is given up.
  ~ParallelScanWriter();
  ParallelScanWriter(const ParallelScanWriter&) = delete;
  ParallelScanWriter& operator=(const ParallelScanWriter&) = delete;

  /// Takes a scan; waits while too many are under way. What a thread failed with is thrown here or
  /// in finish(), whichever is called next. One call at a time, by ascending numbers.
  void write(std::size_t index, HeldScan scan);
  /// Waits until all scans are written, then for ScanWriter::finish(). Call once, last.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace adasplats
