// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // of OpenSSL

namespace adasplats {

/// SHA-256 (NIST FIPS 180-4) of bytes that are added part by part, as `sha256sum` prints it.
class Sha256 {
 public:
  Sha256();

  void add(const void* data, std::size_t bytes);
  void add(std::string_view text) { add(text.data(), text.size()); }
  /// 64 hexadecimal digits. Call once, last.
  std::string digest();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

/// A line of `sha256sum`.
struct FileDigest {
  std::string name;  ///< relative to a folder
  std::string sha256;
};

std::string sha256_of(std::string_view bytes);

/// Digest of the content of a file. Errors: no_input, io.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace adasplats
