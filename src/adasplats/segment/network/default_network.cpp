// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "adasplats/segment/network/network.h"

// The file networks/default.network as it is (cmake/Networks.cmake).
asm(".section .rodata\n"
    ".balign 16\n"
    ".global adasplats_default_network\n"
    "adasplats_default_network:\n"
    ".incbin \"" ADASPLATS_DEFAULT_NETWORK
    "\"\n"
    ".global adasplats_default_network_end\n"
    "adasplats_default_network_end:\n"
    ".byte 0\n"
    ".section .note.GNU-stack,\"\",@progbits\n"
    ".text\n");
extern "C" const char adasplats_default_network[];
extern "C" const char adasplats_default_network_end[];

namespace adasplats {

Network default_network() {
  const std::string_view content(
      adasplats_default_network,
      static_cast<std::size_t>(adasplats_default_network_end - adasplats_default_network));
  return parse_network(content, "the network of this program");
}

}  // namespace adasplats
