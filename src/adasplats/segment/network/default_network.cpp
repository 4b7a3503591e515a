// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "adasplats/segment/network/network.h"

// The file networks/default.network as it is (cmake/Networks.cmake).
asm(".section .rodata\n"
    ".balign 16\n"
    ".global kAdasplatsDefaultNetwork\n"
    "kAdasplatsDefaultNetwork:\n"
    ".incbin \"" ADASPLATS_DEFAULT_NETWORK
    "\"\n"
    ".global kAdasplatsDefaultNetworkEnd\n"
    "kAdasplatsDefaultNetworkEnd:\n"
    ".byte 0\n"
    ".section .note.GNU-stack,\"\",@progbits\n"
    ".text\n");
extern "C" const char kAdasplatsDefaultNetwork[];
extern "C" const char kAdasplatsDefaultNetworkEnd[];

namespace adasplats {

Network default_network() {
  const std::string_view content(
      kAdasplatsDefaultNetwork,
      static_cast<std::size_t>(kAdasplatsDefaultNetworkEnd - kAdasplatsDefaultNetwork));
  return parse_network(content, "the network of this program");
}

}  // namespace adasplats
