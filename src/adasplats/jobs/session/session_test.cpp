// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/session/session.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <type_traits>

namespace adasplats {
namespace {

TEST(OwnSession, IsASessionOfWhatWasAsked) {
  OwnSession own({.kind = DeviceKind::cpu, .gpus = {}}, 2, 7);
  Session& session = own;
  EXPECT_EQ(session.executor.threads(), 2);
  EXPECT_EQ(session.device.kind, DeviceKind::cpu);
  EXPECT_EQ(session.seed, 7U);
  session.progress.warn("nobody hears");
  const std::size_t sum = session.executor.sum_chunks(
      10, 3, std::size_t{0}, [](std::size_t begin, std::size_t end) { return end - begin; });
  EXPECT_EQ(sum, 10U);
}

static_assert(!std::is_copy_constructible_v<OwnSession>,
              "a copy would refer to the first one's parts");

}  // namespace
}  // namespace adasplats
