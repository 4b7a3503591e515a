// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "adasplats/core/temporary_folder_test.h"
#include "adasplats/io/base/atomic_file.h"
#include "adasplats/io/base/mutator_test.h"
#include "adasplats/io/packets/capture_samples_test.h"
#include "adasplats/io/packets/capture_writer.h"
#include "adasplats/io/packets/datagram_reader.h"

namespace adasplats {
namespace {

using capture_test::FrameSample;
using capture_test::ip_frame;
using capture_test::pcap_of;
using capture_test::pcapng_of;
using capture_test::udp_text;

constexpr std::uint64_t kFirst_ns = 1'700'000'000'123'456'000;

struct ReadDatagram {
  std::uint64_t time_ns;
  std::uint16_t port;
  std::string payload;
  CapturePosition place;
};

std::vector<ReadDatagram> all_of(DatagramReader& reader) {
  std::vector<ReadDatagram> all;
  while (const auto datagram = reader.next())
    all.push_back(
        {datagram->time_ns, datagram->to_port, std::string(datagram->payload), datagram->place});
  return all;
}

/// A datagram with tags, one in three parts whose last comes first, something else, one more.
std::vector<FrameSample> sample_frames() {
  std::string large(40, 'x');
  for (std::size_t k = 0; k < large.size(); ++k) large[k] = static_cast<char>('a' + k % 26);
  const std::string whole = udp_text(7502, large);  // 48 bytes
  return {{kFirst_ns, ip_frame(udp_text(2368, "one"), 1, 0, 2)},
          {kFirst_ns + 1'000'000, ip_frame(std::string_view(whole).substr(32), 7, 4)},
          {kFirst_ns + 2'000'000, ip_frame(udp_text(9, "odd"), 2, 0)},
          {kFirst_ns + 3'000'000, ip_frame(std::string_view(whole).substr(0, 16), 7, 0x2000)},
          {kFirst_ns + 4'000'000, std::string(60, '\2')},
          {kFirst_ns + 5'000'000, ip_frame(std::string_view(whole).substr(16, 16), 7, 0x2002)},
          {kFirst_ns + 6'000'000, ip_frame(udp_text(2368, ""), 3, 0)}};
}

void expect_samples(const std::filesystem::path& path) {
  DatagramReader reader(path);
  const std::vector<ReadDatagram> all = all_of(reader);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[0].payload, "one");
  EXPECT_EQ(all[0].port, 2368);
  EXPECT_EQ(all[0].time_ns, kFirst_ns);
  EXPECT_EQ(all[1].payload, "odd");
  EXPECT_EQ(all[2].payload, "abcdefghijklmnopqrstuvwxyzabcdefghijklmn");
  EXPECT_EQ(all[2].time_ns, kFirst_ns + 5'000'000);
  EXPECT_EQ(all[3].payload, "");
  EXPECT_EQ(reader.counts().frames, 7U);
  EXPECT_EQ(reader.counts().others, 1U);
  EXPECT_EQ(reader.counts().torn + reader.counts().cut, 0U);
  // Read again from where each begins.
  for (const ReadDatagram& one : all) {
    DatagramReader again(path, one.place);
    const std::vector<ReadDatagram> rest = all_of(again);
    ASSERT_FALSE(rest.empty());
    EXPECT_TRUE(
        std::ranges::any_of(rest, [&](const ReadDatagram& r) { return r.payload == one.payload; }));
  }
}

TEST(Capture, BothOrdersAndBothClocksOfPcap) {
  const TemporaryFolder folder;
  for (const bool big_endian : {false, true})
    for (const bool nano : {false, true})
      expect_samples(folder.write("a.pcap", pcap_of(sample_frames(), big_endian, nano)));
}

TEST(Capture, BothOrdersOfPcapng) {
  const TemporaryFolder folder;
  for (const bool big_endian : {false, true})
    expect_samples(folder.write("a.pcapng", pcapng_of(sample_frames(), big_endian)));
  // A second section in the other order, with interfaces of its own.
  const std::string two = pcapng_of(sample_frames(), true) + pcapng_of(sample_frames(), false);
  DatagramReader reader(folder.write("b.pcapng", two));
  EXPECT_EQ(all_of(reader).size(), 8U);
}

TEST(Capture, OtherLinks) {
  const TemporaryFolder folder;
  const std::string ip = ip_frame(udp_text(1, "p"), 1, 0).substr(14);
  const std::string family("\2\0\0\0", 4), type("\x08\0", 2);
  const std::pair<std::uint32_t, std::string> links[] = {{101, ip},
                                                         {228, ip},
                                                         {0, family + ip},
                                                         {113, std::string(14, '\0') + type + ip},
                                                         {276, type + std::string(18, '\0') + ip}};
  for (const auto& [link, frame] : links) {
    DatagramReader reader(
        folder.write("a.pcap", pcap_of({{kFirst_ns, frame}}, false, false, link)));
    const auto all = all_of(reader);
    ASSERT_EQ(all.size(), 1U) << link;
    EXPECT_EQ(all[0].payload, "p");
  }
}

TEST(Capture, MissingDataAreCounted) {
  const TemporaryFolder folder;
  std::vector<FrameSample> frames = sample_frames();
  frames.erase(frames.begin() + 3);  // a part
  std::string cut = ip_frame(udp_text(2368, "cut short"), 9, 0);
  cut.resize(cut.size() - 2);
  frames.push_back({kFirst_ns, cut});
  DatagramReader reader(folder.write("a.pcap", pcap_of(frames, false, false)));
  EXPECT_EQ(all_of(reader).size(), 3U);
  EXPECT_EQ(reader.counts().torn, 1U);
  EXPECT_EQ(reader.counts().cut, 1U);
  // A thousand datagrams of which parts are missing: bounded, each counted.
  frames.clear();
  for (std::uint16_t k = 0; k < 1000; ++k)
    frames.push_back({kFirst_ns, ip_frame(std::string(1480, 'x'), k, 0x2000)});
  DatagramReader many(folder.write("a.pcap", pcap_of(frames, false, false)));
  EXPECT_EQ(all_of(many).size(), 0U);
  EXPECT_EQ(many.counts().torn, 1000U);
}

TEST(Capture, RoundTrip) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "w.pcap";
  std::string large(20000, '\0');
  for (std::size_t k = 0; k < large.size(); ++k) large[k] = static_cast<char>(k * k / 7);
  const UdpEndpoint from{{2, 0, 0, 0, 0, 1}, {10, 0, 0, 1}, 2368}, to{{}, {10, 0, 0, 2}, 2369};
  CaptureWriter writer(path);
  const std::string payloads[] = {"", "a", large.substr(0, 1472), large.substr(0, 1473), large};
  for (const std::string& payload : payloads) writer.add(kFirst_ns / 1000, from, to, payload);
  expect_error(ErrorKind::data, {"w.pcap", "65507"},
               [&] { writer.add(0, from, to, std::string(65508, 'x')); });
  expect_error(ErrorKind::data, {"w.pcap", "2106"},
               [&] { writer.add(std::uint64_t{1} << 62U, from, to, "x"); });
  writer.finish();
  DatagramReader reader(path);
  const auto all = all_of(reader);
  ASSERT_EQ(all.size(), std::size(payloads));
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(all[k].payload, payloads[k]);
    EXPECT_EQ(all[k].port, 2369);
    EXPECT_EQ(all[k].time_ns, kFirst_ns);
  }
  EXPECT_EQ(reader.counts().frames, 1U + 1 + 1 + 2 + 14);
}

TEST(Capture, EveryTruncationIsAnError) {
  const TemporaryFolder folder;
  for (const std::string& whole :
       {pcap_of(sample_frames(), false, true), pcapng_of(sample_frames(), true)}) {
    std::size_t good = 0;
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto path = folder.write("cut.pcap", whole.substr(0, size));
      try {
        DatagramReader reader(path);
        all_of(reader);
        ++good;
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("cut.pcap"), std::string::npos);
      }
    }
    EXPECT_LE(good, 12U);  // where a record ends
  }
  expect_error(ErrorKind::data, {"no.pcap", "neither PCAP nor PCAPNG"},
               [&] { DatagramReader(folder.write("no.pcap", std::string(100, 'x'))); });
}

TEST(Capture, DamagedCapturesAreErrors) {
  const TemporaryFolder folder;
  io_test::Mutator mutator(5);
  const std::string seeds[] = {pcap_of(sample_frames(), false, false),
                               pcap_of(sample_frames(), true, true),
                               pcapng_of(sample_frames(), false), pcapng_of(sample_frames(), true)};
  std::size_t good = 0, bad = 0;
  for (int round = 0; round < 1500; ++round) {
    const std::string content = mutator.mutate(seeds[round % 4], seeds[(round + 1) % 4]);
    try {
      DatagramReader reader(folder.write("a.pcap", content));
      for (const ReadDatagram& one : all_of(reader)) ASSERT_LE(one.payload.size(), content.size());
      ++good;
    } catch (const Error&) {
      ++bad;
    }
  }
  EXPECT_GT(good, 75U);
  EXPECT_GT(bad, 75U);
}

}  // namespace
}  // namespace adasplats
