// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/present_disks.h"

namespace adasplats {

PresentDisks::PresentDisks(std::span<const Disk> disks, const Executor& executor) {
  for (std::size_t i = 0; i < disks.size(); ++i) {
    if (!(disks[i].radius > 0)) continue;
    disks_.push_back(disks[i]);
    ids_.push_back(static_cast<std::uint32_t>(i));
  }
  tracer_ = make_cpu_tracer({disks_, nullptr}, executor);
}

}  // namespace adasplats
