// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace adasplats {

/// SHA-256 of bytes that come piece by piece (NIST FIPS 180-4), so that `sha256sum` can check what
/// a manifest says.
class Sha256 {
 public:
  void add(const void* data, std::size_t bytes);
  void add(std::string_view text) { add(text.data(), text.size()); }
  /// 64 hexadecimal digits. Call once, last.
  std::string digest();

 private:
  void mix_blocks(const unsigned char* data, std::size_t blocks);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block_ = {};
  std::uint64_t bytes_ = 0;
};

/// A file as `sha256sum` has it in a line.
struct FileDigest {
  std::string name;  ///< relative to a folder
  std::string sha256;
};

/// Of bytes in memory.
std::string sha256_of(std::string_view bytes);

/// Of a file's bytes. Errors: no_input, io.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace adasplats
