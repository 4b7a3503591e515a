// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "adasplats/io/base/table.h"

// For the fuzz program alone: what is fuzzed, and what is expected of it beside that it does not
// crash.
namespace adasplats::fuzz {

/// What a reader is given.
struct Input {
  std::string_view bytes;
  std::filesystem::path folder;  ///< where the target's files are
  std::filesystem::path file;    ///< the first of them; empty for a target without files
};

/// A reader of bytes that somebody else made.
struct FuzzTarget {
  std::string_view name;  ///< also the folder of its seeds, tests/fuzz/corpus/NAME
  /// Names, with blanks between, of the files that the input is written to: split where a line "%%"
  /// is, in this order. None: the reader takes the bytes.
  std::string_view files;
  /// Sources and folders below src/adasplats that it is for, with blanks between.
  std::string_view sources;
  /// Reads it. adasplats::Error may come out, nothing else.
  void (*read)(const Input&);
  std::size_t max_bytes = 4096;  ///< of an input
  /// The most that one allocation may take. The readers say what memory they need in multiples of
  /// the input.
  std::size_t allocation_mb = 64;
};

/// All of them (fuzz_targets.cpp).
std::span<const FuzzTarget> fuzz_targets();

/// Ends the program with a message where it does not hold: libFuzzer keeps the input.
void require(bool holds, const char* what);

/// Columns as long as the table; no more than 88 rows a byte, which LZF may have (PCD).
void require_sound(const Table& table, std::size_t input_bytes);
/// Indices of vertices that are there.
void require_sound(const MeshTable& mesh);

}  // namespace adasplats::fuzz
