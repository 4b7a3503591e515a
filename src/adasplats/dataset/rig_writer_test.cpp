// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/dataset/rig_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "adasplats/core/maths/random.h"
#include "adasplats/core/temporary_folder_test.h"

namespace adasplats {
namespace {

// Oracle: a stable sort by time. Sources add in turns, as scans of the sensors of a rig.
TEST(TimeMerge, ItemsAreInTheOrderOfTime) {
  constexpr std::size_t kSources = 3;
  TimeMerge<std::pair<std::uint64_t, int>> merge(kSources);
  std::vector<std::pair<std::uint64_t, int>> all, taken;
  const auto take = [&](std::pair<std::uint64_t, int> item) { taken.push_back(item); };
  const auto add_all = [&](std::size_t source, std::uint64_t time) {
    const std::pair<std::uint64_t, int> item(time, static_cast<int>(all.size()));
    all.push_back(item);
    merge.add(source, time, item);
  };
  merge.add(5, {5, 0});
  all.emplace_back(5, 0);
  Random random(3, 0, 0);
  std::vector<std::uint64_t> latest(kSources, 10);
  for (int turn = 0; turn < 20; ++turn)
    for (std::size_t source = 0; source < kSources; ++source) {
      for (int k = 0; k < 7; ++k)
        add_all(source, latest[source] += static_cast<std::uint64_t>(random.uniform(0, 3)));
      merge.take(take);
    }
  const std::size_t before_end = taken.size();
  merge.take(take, true);
  EXPECT_GT(before_end, all.size() / 2);  // few wait
  std::ranges::stable_sort(all, {}, &std::pair<std::uint64_t, int>::first);
  EXPECT_EQ(taken, all);
}

// Oracle: by hand. Stated senders stay; the others are the free ports from 2368 upwards.
TEST(RigWriter, SendersDiffer) {
  std::vector<RigWriterSensor> sensors(3);
  sensors[0].name = "a";
  sensors[1].name = "b";
  sensors[1].writing.packets.sender = UdpEndpoint{{}, {192, 168, 1, 201}, 2368};
  const std::vector<UdpEndpoint> senders = rig_senders(sensors);
  EXPECT_EQ(senders[0].port, 2369);
  EXPECT_EQ(senders[1].port, 2368);
  EXPECT_EQ(senders[2].port, 2370);
  sensors[0].writing.packets.sender = sensors[1].writing.packets.sender;
  expect_error(ErrorKind::usage, {"'b'", "port"}, [&] { rig_senders(sensors); });
  EXPECT_EQ(rig_scan_number(4, 1, 3), 13U);
}

}  // namespace
}  // namespace adasplats
