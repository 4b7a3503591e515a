// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/sha256.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/input_file.h"
#include "adasplats/io/base/sha256_blocks.h"

namespace adasplats {
void Sha256::mix_blocks(const unsigned char* data, std::size_t blocks) {
  static const bool by_instructions = has_sha256_instructions();
  if (by_instructions) return mix_blocks_by_instructions(state_, data, blocks);
  mix_blocks_portably(state_, data, blocks);
}

void Sha256::add(const void* data, std::size_t bytes) {
  const auto* from = static_cast<const unsigned char*>(data);
  while (bytes > 0) {
    const std::size_t filled = bytes_ % 64;
    if (filled == 0 && bytes >= 64) {
      const std::size_t whole = bytes / 64 * 64;
      mix_blocks(from, whole / 64);
      from += whole;
      bytes -= whole;
      bytes_ += whole;
      continue;
    }
    const std::size_t taken = std::min(bytes, 64 - filled);
    std::memcpy(block_.data() + filled, from, taken);
    from += taken;
    bytes -= taken;
    bytes_ += taken;
    if (bytes_ % 64 == 0) mix_blocks(block_.data(), 1);
  }
}

std::string Sha256::digest() {
  // Section 5.1.1: a one, zeros, the length in bits.
  const std::uint64_t bits = bytes_ * 8;
  std::string padding(1 + (119 - bytes_ % 64) % 64, '\0');
  padding[0] = '\x80';
  for (int shift = 56; shift >= 0; shift -= 8) padding += static_cast<char>(bits >> shift & 0xff);
  add(padding);
  std::string text;
  for (const std::uint32_t word : state_)
    for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[word >> shift & 0xf];
  return text;
}

std::string sha256_of(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.digest();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  const InputDescriptor file(path);
  std::vector<char> buffer(std::size_t{1} << 18);
  Sha256 hash;
  while (true) {
    const ssize_t got = ::read(file.get(), buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw system_error(ErrorKind::io, path, "cannot be read", errno);
    if (got == 0) return hash.digest();
    hash.add(buffer.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace adasplats
