// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/base64.h"

#include <openssl/evp.h>

#include <limits>
#include <stdexcept>

namespace adasplats {
namespace {

constexpr std::string_view kBase64Digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

const unsigned char* unsigned_bytes(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

}  // namespace

std::string to_base64(std::string_view bytes) {
  if (bytes.size() > std::size_t{1} << 30) throw std::logic_error("to_base64: more than 1 GiB");
  std::string text((bytes.size() + 2) / 3 * 4, '\0');
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), unsigned_bytes(bytes),
                  static_cast<int>(bytes.size()));
  return text;
}

std::optional<std::string> from_base64(std::string_view text) {
  text = text.substr(0, text.find_last_not_of('=') + 1);
  // OpenSSL accepts = anywhere and blanks at both ends.
  if (text.find_first_not_of(kBase64Digits) != std::string_view::npos ||
      text.size() > std::numeric_limits<int>::max() - 4U)
    return std::nullopt;
  std::string padded(text);
  padded.resize((text.size() + 3) / 4 * 4, '=');
  std::string bytes(padded.size() / 4 * 3, '\0');
  EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()), unsigned_bytes(padded),
                  static_cast<int>(padded.size()));
  bytes.resize(text.size() * 6 / 8);
  return bytes;
}

}  // namespace adasplats
