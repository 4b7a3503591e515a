// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/mutator_test.h"
#include "adasplats/segment/network/network.h"
#include "adasplats/segment/network/network_text_test.h"
#include "adasplats/segment/network/run_network.h"

// Broken network files, the same in each run: they may only throw adasplats::Error, and networks
// that load must run. Most useful under the sanitizers.
namespace adasplats {
namespace {

using io_test::Mutator;
using network_test::has_products;
using network_test::network_of_all_layers;
using network_test::NetworkText;
using network_test::pole_network;
using network_test::pole_network_of_8_bits;

std::vector<NetworkText> seeds() {
  return {pole_network(), pole_network_of_8_bits(), network_of_all_layers()};
}

/// Breaks the entire file in half of the rounds, else its header or its weights.
std::string broken(const NetworkText& seed, const NetworkText& other, std::size_t round,
                   Mutator& mutator) {
  const std::string head = seed.header.dump();
  switch (round % 4) {
    case 0: return NetworkText::text_of(mutator.mutate(head, other.header.dump()), seed.data);
    case 1: return NetworkText::text_of(head, mutator.mutate(seed.data, other.data));
    default: return mutator.mutate(seed.text(), other.text());
  }
}

/// Whether the file loads; runs the network on a few points if it does.
bool is_read_and_runs(const std::string& content) {
  Network network;
  try {
    network = parse_network(content, "n.network");
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("n.network"), std::string::npos);
    return false;
  }
  if (!has_products()) return true;
  const Executor executor(1);
  std::vector<Vec3f> points;
  for (int i = 0; i < 12; ++i)
    points.push_back({0.4F * static_cast<float>(i % 4), 0.3F * static_cast<float>(i / 4), 0.1F});
  const std::vector<PyramidLevel> levels = make_pyramid(
      means_by_cell(points, network.shape.cell_m, executor).means, network.shape, executor);
  const std::size_t cells = levels.front().points.size();
  const std::vector<float> logits = run_network(
      network, levels, std::vector<float>(cells * network.features.size(), 1.0F), executor);
  EXPECT_EQ(logits.size(), cells * network.classes.size());
  return true;
}

TEST(NetworkFuzz, SeedsAreValid) {
  for (const NetworkText& seed : seeds()) EXPECT_TRUE(is_read_and_runs(seed.text()));
}

TEST(NetworkFuzz, BrokenNetworks) {
  const std::vector<NetworkText> all = seeds();
  Mutator mutator(3);
  constexpr std::size_t kRounds = 3000;
  std::size_t was_read = 0;
  for (std::size_t round = 0; round < kRounds; ++round)
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::string content = broken(all[k], all[(k + round) % all.size()], round, mutator);
      ASSERT_NO_THROW(was_read += is_read_and_runs(content) ? 1 : 0)
          << "seed " << k << ", round " << round;
    }
  // The mutations must leave some files readable and break others.
  EXPECT_GT(was_read, kRounds * all.size() / 20);
  EXPECT_LT(was_read, kRounds * all.size() * 19 / 20);
}

TEST(NetworkFuzz, EveryTruncation) {
  for (const NetworkText& seed : seeds()) {
    const std::string text = seed.text();
    for (std::size_t size = 0; size < text.size(); ++size)
      EXPECT_FALSE(is_read_and_runs(text.substr(0, size)));
  }
}

}  // namespace
}  // namespace adasplats
