// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "adasplats/gpu/base/device.h"

#if defined(ADASPLATS_HAVE_CUDA)
#include <algorithm>
#include <cfloat>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <optional>
#include <string>

#include "adasplats/core/error.h"
#include "adasplats/core/maths/random.h"
#include "adasplats/gpu/base/engines.h"
#include "adasplats/gpu/base/hilbert_order.h"
#include "adasplats/gpu/base/memory_account.h"
#include "adasplats/gpu/base/sort_keys.h"
#include "adasplats/gpu/neighbors/cloud_on_device.h"
#include "adasplats/gpu/neighbors/neighborhoods_lists.h"
#include "adasplats/gpu/paper/select_rounds.h"
#include "adasplats/neighbors/hilbert.h"
#include "adasplats/neighbors/point_index.h"
#include "adasplats/splats/build_model.h"
#include "adasplats/splats/consistent/scanned_room_test.h"
#include "adasplats/splats/model/canonical_order.h"
#include "adasplats/splats/model/same_bytes_test.h"
#include "adasplats/splats/model_engine.h"
#include "adasplats/splats/paper/select.h"

namespace adasplats::gpu {
namespace {

using namespace room;  // NOLINT(google-build-using-namespace)

#define ADASPLATS_NEEDS_GPU() \
  if (find_gpus().devices.empty()) GTEST_SKIP() << find_gpus().reason

template <class T>
DeviceBuffer<T> on_device(const std::vector<T>& values, const Stream& stream) {
  return DeviceBuffer<T>(std::span<const T>(values), stream.get());
}

/// The error thrown by a call; no kind if none.
struct Thrown {
  std::optional<ErrorKind> kind;
  std::string what;
};

template <class F>
Thrown error_of(F&& call) {
  try {
    call();
  } catch (const Error& error) {
    return {error.kind(), error.what()};
  }
  return {};
}

enum class Shape { uniform, clustered, duplicates, collinear, grid, equal };

std::vector<Vec3f> make_points(Shape shape, std::size_t count) {
  std::vector<Vec3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(3, static_cast<std::uint64_t>(shape), shape == Shape::duplicates ? i / 50 : i);
    const auto uniform = [&] { return static_cast<float>(random.uniform(-20, 20)); };
    Vec3f p{uniform(), uniform(), uniform()};
    switch (shape) {
      case Shape::uniform:
      case Shape::duplicates: break;
      case Shape::clustered: {  // densities from 1 to 10^9
        const auto size = static_cast<float>(std::pow(10.0, -random.uniform(0, 3)));
        p = static_cast<float>(i % 7) * Vec3f{3, 1, 2} + size * (0.05F * p);
        break;
      }
      case Shape::collinear: p = {p.x, 0, 0}; break;
      case Shape::grid: p = {std::round(p.x), std::round(p.y), 0}; break;
      case Shape::equal: p = {1, 2, 3}; break;
    }
    points.push_back(p);
  }
  const Executor executor(2);
  std::vector<Vec3f> sorted;
  for (const std::uint32_t i : hilbert_order(points, executor)) sorted.push_back(points[i]);
  return sorted;
}

/// Oracle: the neighbourhoods of PointIndex, each ascending by key.
std::vector<std::vector<std::uint32_t>> expected_lists(const std::vector<Vec3f>& points,
                                                       NeighborLimit limit) {
  const Executor executor(2);
  const PointIndex index = PointIndex::from_sorted(points, executor);
  std::vector<std::vector<std::uint32_t>> lists(points.size());
  index.for_each_neighborhood(
      executor, [&](std::uint32_t) { return limit; },
      [&](std::uint32_t rank, const NeighborList& found) {
        std::vector<std::uint64_t> keys;
        for (std::uint32_t k = 0; k < found.size; ++k) keys.push_back(found.key(k));
        std::sort(keys.begin(), keys.end());
        for (const std::uint64_t key : keys) lists[rank].push_back(static_cast<std::uint32_t>(key));
      });
  return lists;
}

std::vector<std::vector<std::uint32_t>> downloaded(const DeviceLists& lists) {
  const auto begins = lists.begins.download();
  const auto sizes = lists.sizes.download(), ranks = lists.ranks.download();
  std::vector<std::vector<std::uint32_t>> result(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i)
    result[i].assign(ranks.begin() + static_cast<std::ptrdiff_t>(begins[i]),
                     ranks.begin() + static_cast<std::ptrdiff_t>(begins[i] + sizes[i]));
  return result;
}

/// Number of lists that differ from the oracle.
std::size_t wrong_lists(const std::vector<Vec3f>& points, NeighborLimit limit) {
  const Stream stream;
  const auto positions = on_device(points, stream);
  const DevicePointIndex index(positions.data(), points.size(), stream.get());
  const auto expected = expected_lists(points, limit);
  const auto ascending = downloaded(find_lists(index, limit, true, stream.get()));
  auto unordered = downloaded(find_lists(index, limit, false, stream.get()));
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<std::uint32_t> by_rank = expected[i];
    std::sort(by_rank.begin(), by_rank.end());
    std::sort(unordered[i].begin(), unordered[i].end());
    if (ascending[i] != expected[i] || unordered[i] != by_rank) ++wrong;
  }
  return wrong;
}

class EveryShape : public testing::TestWithParam<Shape> {};

TEST_P(EveryShape, NeighborhoodsMatchPointIndex) {
  ADASPLATS_NEEDS_GPU();
  for (const std::size_t count : {0, 1, 2, 31, 32, 33, 1024, 1025, 20000}) {
    const std::vector<Vec3f> points = make_points(GetParam(), count);
    for (const std::uint32_t neighbors : {1U, 3U, 40U, 64U, 65U, 120U, 160U, 161U, 512U}) {
      if (count == 20000 && neighbors != 40 && neighbors != 120 && neighbors != 161) continue;
      for (const float radius : {FLT_MAX, 0.5F, 0.0F}) {
        const float squared = radius < FLT_MAX ? radius * radius : FLT_MAX;
        EXPECT_EQ(wrong_lists(points, {neighbors, squared}), 0U)
            << count << " points, " << neighbors << " neighbours, radius " << radius;
      }
    }
  }
}

TEST_P(EveryShape, CountsMatchPointIndex) {
  ADASPLATS_NEEDS_GPU();
  const Stream stream;
  const Executor executor(2);
  for (const std::size_t count : {0, 1, 33, 1025, 5000}) {
    const std::vector<Vec3f> points = make_points(GetParam(), count);
    const auto positions = on_device(points, stream);
    const DevicePointIndex index(positions.data(), count, stream.get());
    const PointIndex oracle = PointIndex::from_sorted(points, executor);
    for (const float radius : {0.0F, 0.3F, 3.0F, 100.0F})
      EXPECT_EQ(count_within(index, radius, stream.get()).download(),
                oracle.count_within(radius, executor));
  }
}

TEST_P(EveryShape, OrderMatchesTheCpu) {
  ADASPLATS_NEEDS_GPU();
  const Stream stream;
  const Executor executor(2);
  for (const std::size_t count : {0, 1, 2, 33, 20000}) {
    std::vector<Vec3f> points = make_points(GetParam(), count);
    for (std::size_t i = points.size(); i-- > 1;)
      std::swap(points[i], points[Random(5, 0, i).next_bits() % (i + 1)]);
    const auto positions = on_device(points, stream);
    EXPECT_EQ(hilbert_order(positions.data(), count, stream.get()).download(),
              hilbert_order(points, executor));
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape,
                         testing::Values(Shape::uniform, Shape::clustered, Shape::duplicates,
                                         Shape::collinear, Shape::grid, Shape::equal));

TEST(Neighborhoods, TooManyAreRejected) {
  ADASPLATS_NEEDS_GPU();
  const Stream stream;
  const auto positions = on_device(make_points(Shape::uniform, 10), stream);
  const DevicePointIndex index(positions.data(), 10, stream.get());
  const Thrown thrown = error_of([&] { find_lists(index, {513}, false, stream.get()); });
  EXPECT_EQ(thrown.kind, ErrorKind::usage);
  EXPECT_NE(thrown.what.find("`device` cpu"), std::string::npos) << thrown.what;
}

TEST(SortKeys, SortsSelectsAndAdds) {
  ADASPLATS_NEEDS_GPU();
  const Stream stream;
  const Executor executor(2);
  for (const std::size_t count : {0, 1, 1000, 100'000}) {
    std::vector<std::uint64_t> keys(count);
    std::vector<std::uint8_t> flags(count);
    std::vector<std::uint32_t> counts(count), flagged_numbers;
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      Random random(2, 0, i);
      keys[i] = random.next_bits() % 5000 << (i % 3 * 20);
      flags[i] = random.next_bits() % 3 == 0 ? 1 : 0;
      counts[i] = static_cast<std::uint32_t>(random.next_bits() >> 32);
      values[i] = static_cast<float>(random.normal());
      if (flags[i] != 0) flagged_numbers.push_back(static_cast<std::uint32_t>(i));
    }
    auto device_keys = on_device(keys, stream);
    const auto order = sort_order(device_keys, stream.get()).download();
    std::vector<std::uint32_t> expected_order, expected_begins;
    executor.sort_keys(keys, expected_order);
    EXPECT_EQ(order, expected_order);
    EXPECT_EQ(device_keys.download(), keys);
    for (std::size_t i = 0; i < count; ++i)
      if (i == 0 || keys[i] != keys[i - 1])
        expected_begins.push_back(static_cast<std::uint32_t>(i));
    expected_begins.push_back(static_cast<std::uint32_t>(count));
    EXPECT_EQ(run_begins(device_keys.data(), count, stream.get()).download(), expected_begins);
    EXPECT_EQ(flagged(on_device(flags, stream).data(), count, stream.get()).download(),
              flagged_numbers);
    const auto device_counts = on_device(counts, stream);
    const auto sums = running_sums(device_counts.data(), count, stream.get()).download();
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(sums[i], sum);
      sum += counts[i];
    }
    EXPECT_EQ(sums.back(), sum);
    EXPECT_EQ(sum_of(device_counts.data(), count, stream.get()), sum);
    const double expected =
        executor.sum_chunks(count, 4096, 0.0, [&](std::size_t begin, std::size_t end) {
          double part = 0;
          for (std::size_t i = begin; i < end; ++i) part += static_cast<double>(values[i]);
          return part;
        });
    EXPECT_EQ(sum_in_chunks(on_device(values, stream).data(), count, stream.get()), expected);
  }
}

/// Clouds with points that differ in only one attribute or in none.
TEST(CanonicalOrder, MatchesTheCpu) {
  ADASPLATS_NEEDS_GPU();
  const Stream stream;
  const Executor executor(2);
  for (const std::size_t places : {1, 37, 4000}) {
    PointCloud cloud;
    for (std::size_t i = 0; i < 8000; ++i) {
      Random random(8, places, i);
      const std::vector<Vec3f> at = {{static_cast<float>(random.next_bits() % places), 1, 0}};
      cloud.positions.push_back(at[0]);
      cloud.classes.push_back(static_cast<std::uint16_t>(random.next_bits() % 2 * 60000));
      cloud.instances.push_back(static_cast<std::uint16_t>(random.next_bits() % 2));
      cloud.scan_indices.push_back(static_cast<std::uint32_t>(random.next_bits() % 2 * 3000000000));
      cloud.intensities.push_back(static_cast<float>(random.next_bits() % 3) - 1.0F);
      cloud.sensor_positions.push_back({static_cast<float>(random.next_bits() % 3) - 1.0F, 0,
                                        static_cast<float>(random.next_bits() % 2)});
    }
    const DeviceCloud device_cloud = copy_to_device(cloud, stream.get());
    const PointCloud got =
        adasplats::gather(cloud, canonical_order(device_cloud, stream.get()).download());
    const PointCloud expected =
        adasplats::gather(cloud, adasplats::canonical_order(cloud, executor));
    EXPECT_EQ(got.positions, expected.positions);
    EXPECT_EQ(got.classes, expected.classes);
    EXPECT_EQ(got.instances, expected.instances);
    EXPECT_EQ(got.scan_indices, expected.scan_indices);
    EXPECT_EQ(got.intensities, expected.intensities);
    EXPECT_EQ(got.sensor_positions, expected.sensor_positions);
  }
}

DeviceLists uploaded(const std::vector<std::vector<std::uint32_t>>& lists, const Stream& stream) {
  std::vector<std::uint64_t> begins = {0};
  std::vector<std::uint32_t> sizes, ranks;
  for (const auto& list : lists) {
    sizes.push_back(static_cast<std::uint32_t>(list.size()));
    ranks.insert(ranks.end(), list.begin(), list.end());
    begins.push_back(ranks.size());
  }
  return {on_device(begins, stream), on_device(sizes, stream), on_device(ranks, stream)};
}

void expect_same_selection(const std::vector<float>& radii,
                           const std::vector<std::vector<std::uint32_t>>& lists) {
  const Stream stream;
  const Executor executor(2);
  DiscardLists discards;
  discards.chunks.resize(1);
  discards.chunk_size = static_cast<std::uint32_t>(radii.size() + 1);
  for (const auto& list : lists) {
    discards.begins.push_back(static_cast<std::uint32_t>(discards.chunks[0].size()));
    discards.chunks[0].insert(discards.chunks[0].end(), list.begin(), list.end());
  }
  for (const SelectionOrder order :
       {SelectionOrder::most_discards_first, SelectionOrder::largest_first, SelectionOrder::curve,
        SelectionOrder::scattered})
    EXPECT_EQ(
        select_greedily(on_device(radii, stream), uploaded(lists, stream), order, stream.get())
            .download(),
        adasplats::select_greedily(radii, discards, order, executor));
}

TEST(Selection, MatchesTheSequentialSelection) {
  ADASPLATS_NEEDS_GPU();
  for (const std::size_t count : {0, 1, 2, 100, 20000}) {
    for (const std::uint64_t most : {1, 12, 100}) {
      std::vector<float> radii;
      std::vector<std::vector<std::uint32_t>> lists(count);
      for (std::size_t i = 0; i < count; ++i) {
        Random random(6, most, i);
        // Few distinct radii, some of them 0; lists may contain duplicates and the candidate
        // itself.
        radii.push_back(static_cast<float>(random.next_bits() % 5));
        const std::uint64_t size = random.next_bits() % most;
        for (std::uint64_t k = 0; k < size; ++k) {
          const std::uint64_t near = (i + random.next_bits() % (4 * most)) % count;
          if (near != i) lists[i].push_back(static_cast<std::uint32_t>(near));
        }
      }
      expect_same_selection(radii, lists);
    }
  }
}

TEST(Selection, DecidesALongChainOneByOne) {
  ADASPLATS_NEEDS_GPU();
  constexpr std::uint32_t kCount = 401;
  std::vector<std::vector<std::uint32_t>> lists(kCount);
  for (std::uint32_t i = 0; i + 1 < kCount; ++i) lists[i] = {i + 1};
  expect_same_selection(std::vector<float>(kCount, 1.0F), lists);
}

// ---- whole models

/// The scanned room, four times with different noise: 230,400 points.
PointCloud dense_room() {
  PointCloud cloud;
  for (std::uint64_t copy = 0; copy < 4; ++copy) {
    PointCloud room = scanned_room();
    for (std::size_t i = 0; i < room.size(); ++i) {
      Random random(31, copy, i);
      const auto shift = [&] { return static_cast<float>(0.004 * random.normal()); };
      const Vec3f shifts{shift(), shift(), shift()};
      room.positions[i] = room.positions[i] + shifts;
    }
    append(cloud, std::move(room));
  }
  return cloud;
}

std::pair<SplatModel, BuildReport> build(const PointCloud& cloud, const PaperOptions& options,
                                         bool on_gpu) {
  ProgressSink quiet;
  const Executor executor(0);
  const auto engine = on_gpu ? make_cuda_model_engine(0) : nullptr;
  return build_model(cloud, &semantickitti_labels(), {options, DynamicRemoval::moving}, executor,
                     quiet, engine.get());
}

/// All bits of the splats and of their report must agree.
void expect_same(const std::pair<SplatModel, BuildReport>& got,
                 const std::pair<SplatModel, BuildReport>& expected) {
  EXPECT_EQ(got.first.size(), expected.first.size());
  EXPECT_TRUE(same_bytes(got.first.disks, expected.first.disks));
  EXPECT_TRUE(same_bytes(got.first.classes, expected.first.classes));
  EXPECT_TRUE(same_bytes(got.first.groups, expected.first.groups));
  EXPECT_TRUE(same_bytes(got.first.intensities, expected.first.intensities));
  const BuildReport &report = got.second, &wanted = expected.second;
  EXPECT_EQ(report.points_dynamic, wanted.points_dynamic);
  EXPECT_EQ(report.points_noise, wanted.points_noise);
  EXPECT_EQ(report.points_used, wanted.points_used);
  EXPECT_EQ(report.points_resampled, wanted.points_resampled);
  EXPECT_EQ(report.radius_m, wanted.radius_m);
  EXPECT_EQ(report.error_m, wanted.error_m);
  EXPECT_EQ(report.steps.size(), wanted.steps.size());
}

void publish(const std::string& name, double value) {
  std::printf("%-28s %g\n", name.c_str(), value);
  testing::Test::RecordProperty(name, std::to_string(value));
}

struct Case {
  PaperVariant variant;
  bool resample;
  bool labels;
  bool sensors;
};

class EveryMethod : public testing::TestWithParam<Case> {
 protected:
  PaperOptions options() const {
    PaperOptions result;
    result.variant = GetParam().variant;
    result.resample = GetParam().resample;
    return result;
  }
  PointCloud cloud() const {
    PointCloud result = dense_room();
    if (!GetParam().labels) result.classes.clear();
    if (!GetParam().sensors) result.sensor_positions.clear();
    return result;
  }
};

TEST_P(EveryMethod, MatchesTheCpu) {
  ADASPLATS_NEEDS_GPU();
  const auto expected = build(cloud(), options(), false);
  EXPECT_GT(expected.first.size(), 1000U);
  EXPECT_EQ(expected.second.points_resampled > 0, options().resample);
  expect_same(build(cloud(), options(), true), expected);
}

TEST_P(EveryMethod, IsReproducible) {
  ADASPLATS_NEEDS_GPU();
  const SplatModel one = build(cloud(), options(), true).first;
  PointCloud shuffled = cloud();
  std::vector<std::uint32_t> order(shuffled.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = order.size(); i-- > 1;)
    std::swap(order[i], order[Random(9, 0, i).next_bits() % (i + 1)]);
  shuffled = adasplats::gather(shuffled, order);
  const SplatModel two = build(shuffled, options(), true).first;
  EXPECT_TRUE(same_bytes(one.disks, two.disks));
  EXPECT_TRUE(same_bytes(one.classes, two.classes));
  EXPECT_TRUE(same_bytes(one.groups, two.groups));
  EXPECT_TRUE(same_bytes(one.intensities, two.intensities));
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod,
                         testing::Values(Case{PaperVariant::basic, false, true, true},
                                         Case{PaperVariant::descriptors, false, true, true},
                                         Case{PaperVariant::descriptors, true, false, false},
                                         Case{PaperVariant::semantic, false, true, true},
                                         Case{PaperVariant::semantic, true, true, true}));

TEST(PaperModel, MatchesTheCpuForDegenerateClouds) {
  ADASPLATS_NEEDS_GPU();
  for (const Shape shape : {Shape::equal, Shape::collinear, Shape::grid}) {
    for (const std::size_t count : {1, 2, 39, 41, 3000}) {
      PointCloud cloud;
      cloud.positions = make_points(shape, count);
      PaperOptions options;
      options.variant = PaperVariant::descriptors;
      SCOPED_TRACE(count);
      expect_same(build(cloud, options, true), build(cloud, options, false));
    }
  }
}

TEST(PaperModel, AMillionEqualPointsTerminate) {
  ADASPLATS_NEEDS_GPU();
  PointCloud cloud;
  cloud.positions.assign(1'000'000, {1, 2, 3});
  PaperOptions options;
  options.variant = PaperVariant::descriptors;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(build(cloud, options, true).first.size(), 0U);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  publish("seconds", seconds.count());  // searching all of them for each would take minutes
  EXPECT_LT(seconds.count(), 20);
}

TEST(PaperModel, OptionsOfTheMethodsHaveAnEffect) {
  ADASPLATS_NEEDS_GPU();
  const PointCloud cloud = scanned_room();
  for (int variant = 0; variant < 6; ++variant) {
    PaperOptions options;
    options.variant = PaperVariant::semantic;
    if (variant == 0) options.radius_m = 0.12;
    if (variant == 1) options.error_m = 0.004;
    if (variant == 2) options.group_normals = false;
    if (variant == 3) options.selection = SelectionOrder::curve;
    if (variant == 4) options.resample_base = ResampleBase::points;
    if (variant == 5) options.resample_base = ResampleBase::centers;
    SCOPED_TRACE(variant);
    expect_same(build(cloud, options, true), build(cloud, options, false));
  }
}

TEST(PaperModel, ErrorsLeakNoMemory) {
  ADASPLATS_NEEDS_GPU();
  PaperOptions options;
  options.variant = PaperVariant::basic;
  build(scanned_room(), options, true);  // CUDA's own memory is allocated from now on
  const std::size_t before = free_memory_bytes(0);
  options.neighbors = 1000;
  EXPECT_EQ(error_of([&] { build(scanned_room(), options, true); }).kind, ErrorKind::usage);
  options.neighbors = 40;
  EXPECT_GT(build(scanned_room(), options, true).first.size(), 100U);
  EXPECT_GE(free_memory_bytes(0) + (std::size_t{8} << 20), before);
}

TEST(PaperModel, TooLittleMemoryIsAnError) {
  ADASPLATS_NEEDS_GPU();
  const PointCloud cloud = dense_room();
  PaperOptions options;
  options.variant = PaperVariant::basic;
  options.neighbors = 500;  // lists of 230,400 x 500 x 4 bytes
  {
    const Stream stream;
    constexpr std::size_t kLeft = std::size_t{250} << 20;
    const DeviceBuffer<char> taken(free_memory_bytes(0) - kLeft, stream.get());
    stream.wait("take memory");
    const Thrown thrown = error_of([&] { build(cloud, options, true); });
    EXPECT_EQ(thrown.kind, ErrorKind::unavailable);
    EXPECT_NE(thrown.what.find("not enough memory"), std::string::npos) << thrown.what;
  }
  EXPECT_GT(build(cloud, options, true).first.size(), 100U);
}

TEST(PaperModel, MoreThanTheLimitIsAnError) {
  ADASPLATS_NEEDS_GPU();
  const PointCloud cloud = dense_room();
  PaperOptions options;
  options.variant = PaperVariant::basic;
  EXPECT_GT(build(cloud, options, true).first.size(), 100U);
  const std::size_t held = MemoryAccount::of(0).held();
  const std::size_t room = std::size_t{1} << 20;  // less than the points
  limit_gpu_memory(0, held + room);
  EXPECT_LE(usable_gpu_memory(0), room);
  const Thrown thrown = error_of([&] { build(cloud, options, true); });
  limit_gpu_memory(0, 0);
  EXPECT_EQ(thrown.kind, ErrorKind::unavailable);
  EXPECT_NE(thrown.what.find("the limit is"), std::string::npos) << thrown.what;
  EXPECT_EQ(MemoryAccount::of(0).held(), held);
  EXPECT_GT(peak_gpu_memory(0), held + room);
  EXPECT_GT(build(cloud, options, true).first.size(), 100U);
}

}  // namespace
}  // namespace adasplats::gpu
#else
TEST(PaperModel, OnAGpu) { GTEST_SKIP() << adasplats::find_gpus().reason; }
#endif
