// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/sha256.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>
#include <new>
#include <stdexcept>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/input_file.h"

namespace adasplats {
namespace {

void require_success(int result) {
  if (result != 1) throw std::runtime_error("OpenSSL cannot compute SHA-256");
}

/// The algorithm, in a library context of our own: if memory runs out while OpenSSL 3.0 sets up its
/// default context, the next use crashes. Kept until the program ends.
const EVP_MD* sha256_algorithm() {
  static const EVP_MD* const algorithm = [] {
    std::unique_ptr<OSSL_LIB_CTX, void (*)(OSSL_LIB_CTX*)> library(OSSL_LIB_CTX_new(),
                                                                   &OSSL_LIB_CTX_free);
    const EVP_MD* const found = library ? EVP_MD_fetch(library.get(), "SHA256", nullptr) : nullptr;
    if (found == nullptr) throw std::bad_alloc();
    static_cast<void>(library.release());
    return found;
  }();
  return algorithm;
}

}  // namespace

Sha256::Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
  if (!context_ || EVP_DigestInit_ex(context_.get(), sha256_algorithm(), nullptr) != 1)
    throw std::bad_alloc();
}

void Sha256::add(const void* data, std::size_t bytes) {
  require_success(EVP_DigestUpdate(context_.get(), data, bytes));
}

std::string Sha256::digest() {
  std::array<unsigned char, 32> digest{};
  require_success(EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr));
  std::string text;
  for (const unsigned char byte : digest)
    for (const int shift : {4, 0}) text += "0123456789abcdef"[byte >> shift & 0xf];
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
