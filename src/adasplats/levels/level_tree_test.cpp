// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/levels/level_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "adasplats/core/constants.h"
#include "adasplats/core/maths/random.h"

namespace adasplats {
namespace {

constexpr LevelOptions kSmall = {.leaf_size = 200, .cells_per_side = 16};

/// An element decoded by the formulas of docs/viewer_protocol.md.
struct Decoded {
  Disk disk;
  std::uint16_t class_id;
  std::uint8_t intensity, error;
};

Vec3d decoded_normal(double x, double y) {
  const auto sign = [](double v) { return v < 0 ? -1.0 : 1.0; };
  const double z = 1 - std::fabs(x) - std::fabs(y);
  const Vec3d n = z >= 0 ? Vec3d{x, y, z}
                         : Vec3d{(1 - std::fabs(y)) * sign(x), (1 - std::fabs(x)) * sign(y), z};
  return n / length(n);
}

std::vector<Decoded> decode(const LevelTree& tree, std::size_t n) {
  const LevelNode& node = tree.nodes()[n];
  std::vector<Decoded> elements;
  for (const LevelElement& e : tree.elements(n)) {
    Decoded element{{}, e.class_id, e.intensity, e.error};
    for (int axis = 0; axis < 3; ++axis)
      element.disk.center[axis] = static_cast<float>(
          static_cast<double>(node.low[axis]) +
          (static_cast<double>(node.high[axis]) - static_cast<double>(node.low[axis])) *
              e.position[axis] / 65535);
    element.disk.radius = node.largest_radius_m * static_cast<float>(e.radius) / 65535;
    element.disk.normal =
        vec_cast<float>(decoded_normal(e.normal[0] / 32767.0, e.normal[1] / 32767.0));
    elements.push_back(element);
  }
  return elements;
}

/// Elements drawn at a level: its nodes, and leaves above it.
std::vector<Decoded> cut(const LevelTree& tree, std::uint32_t level) {
  std::vector<Decoded> elements;
  for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
    const LevelNode& node = tree.nodes()[n];
    if (node.level != level && (node.level > level || node.child_count > 0)) continue;
    const std::vector<Decoded> own = decode(tree, n);
    elements.insert(elements.end(), own.begin(), own.end());
  }
  return elements;
}

std::uint32_t depth(const LevelTree& tree) {
  std::uint32_t deepest = 0;
  for (const LevelNode& node : tree.nodes()) deepest = std::max(deepest, node.level);
  return deepest;
}

std::vector<std::uint16_t> numbers(std::size_t count) {
  std::vector<std::uint16_t> values(count);
  std::iota(values.begin(), values.end(), std::uint16_t{0});
  return values;
}

Vec3f random_direction(Random& random) {
  const double z = random.uniform(-1, 1), angle = random.uniform(0, 6.283185307179586);
  const double flat = std::sqrt(1 - z * z);
  return vec_cast<float>(Vec3d{flat * std::cos(angle), flat * std::sin(angle), z});
}

std::vector<Disk> random_disks(std::size_t count) {
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(7, 0, i);
    const Vec3d center = {random.uniform(-50, 50), random.uniform(-20, 20), random.uniform(0, 9)};
    disks.push_back({vec_cast<float>(center), static_cast<float>(random.uniform(0.01, 0.2)),
                     random_direction(random)});
  }
  return disks;
}

/// A square of `side_m` in the xy-plane; areas add up to `cover` times its own.
std::vector<Disk> plane(std::size_t count, double side_m, double cover) {
  const double radius =
      std::sqrt(cover * side_m * side_m / (static_cast<double>(count) * 3.14159265358979));
  std::vector<Disk> disks;
  for (std::size_t i = 0; i < count; ++i) {
    Random random(3, 1, i);
    const Vec3d center = {random.uniform(0, side_m), random.uniform(0, side_m), 2};
    // Normals of clouds have no reliable sign.
    const float sign = random.uniform() < 0.5 ? -1.0F : 1.0F;
    disks.push_back({vec_cast<float>(center), static_cast<float>(radius), {0, 0, sign}});
  }
  return disks;
}

std::vector<Vec3f> centers_of(const std::vector<Disk>& disks) {
  std::vector<Vec3f> centers;
  centers.reserve(disks.size());
  for (const Disk& disk : disks) centers.push_back(disk.center);
  return centers;
}

/// Checks the structure that the page requires.
void expect_well_formed(const LevelTree& tree, std::size_t leaf_size) {
  const auto nodes = tree.nodes();
  std::size_t next = 1, in_leaves = 0;
  ASSERT_FALSE(nodes.empty());
  EXPECT_EQ(nodes[0].level, 0U);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const LevelNode& node = nodes[n];
    ASSERT_EQ(node.count, tree.elements(n).size());
    if (node.child_count == 0) {
      EXPECT_EQ(node.first_child, 0U);
      EXPECT_EQ(node.spacing_m, 0.0F);
      EXPECT_LE(node.count, leaf_size);
      in_leaves += node.count;
      continue;
    }
    ASSERT_EQ(node.first_child, next) << "not breadth first";
    ASSERT_LE(node.child_count, 8U);
    EXPECT_GE(node.spacing_m, 0.0F);
    EXPECT_GE(node.count, 1U);
    next += node.child_count;
    ASSERT_LE(next, nodes.size());
    for (std::size_t child = node.first_child; child < next; ++child)
      EXPECT_EQ(nodes[child].level, node.level + 1);
  }
  EXPECT_EQ(next, nodes.size());
  EXPECT_EQ(in_leaves, tree.input_size());
}

std::string bytes_of(const LevelTree& tree) {
  std::string bytes = nodes_bytes(tree.nodes());
  for (std::size_t n = 0; n < tree.nodes().size(); ++n)
    bytes.append(reinterpret_cast<const char*>(tree.elements(n).data()),
                 tree.elements(n).size_bytes());
  return bytes;
}

// Oracle: the input; the class of an element is its index.
TEST(LevelTree, EveryElementIsInOneLeaf) {
  const std::vector<Disk> disks = random_disks(20'000);
  const std::vector<std::uint16_t> ids = numbers(disks.size());
  std::vector<float> intensities, errors_m;
  for (std::size_t i = 0; i < disks.size(); ++i) {
    intensities.push_back(static_cast<float>(i) / 10'000);
    errors_m.push_back(i % 7 == 0 ? static_cast<float>(kNaN)
                                  : -0.5F * static_cast<float>(i) / 20'000);
  }
  const LevelTree tree({disks, {}, ids, intensities, errors_m}, kSmall, Executor(2));
  expect_well_formed(tree, kSmall.leaf_size);
  EXPECT_NEAR(tree.intensity_range().low, 0.04F, 1e-3F);
  EXPECT_NEAR(tree.intensity_range().high, 1.96F, 1e-3F);
  EXPECT_NEAR(tree.error_range_m().high, 0.49F, 1e-3F);
  EXPECT_EQ(tree.error_range_m().low, -tree.error_range_m().high);
  std::vector<int> seen(disks.size(), 0);
  for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
    const LevelNode& node = tree.nodes()[n];
    if (node.child_count > 0) continue;
    for (const Decoded& element : decode(tree, n)) {
      const std::size_t i = element.class_id;
      ++seen[i];
      for (int axis = 0; axis < 3; ++axis) {
        const float half_step = (node.high[axis] - node.low[axis]) / 65535 / 2;
        ASSERT_NEAR(element.disk.center[axis], disks[i].center[axis], half_step + 4e-6F);
      }
      ASSERT_NEAR(element.disk.radius, disks[i].radius, node.largest_radius_m / 65535 / 2 + 1e-7F);
      ASSERT_LT(length(element.disk.normal - disks[i].normal), 1e-4F);
      const float share = (intensities[i] - tree.intensity_range().low) /
                          (tree.intensity_range().high - tree.intensity_range().low);
      ASSERT_NEAR(element.intensity, 255 * std::clamp(share, 0.0F, 1.0F), 0.51F);
      const float error = std::max(errors_m[i] / tree.error_range_m().high, -1.0F);
      ASSERT_NEAR(element.error, std::isnan(errors_m[i]) ? 0 : 1 + 127 * (1 + error), 0.51F);
    }
  }
  EXPECT_EQ(std::ranges::count(seen, 1), static_cast<std::ptrdiff_t>(disks.size()));
}

TEST(LevelTree, PointsOfInnerNodesAreInputPoints) {
  const std::vector<Vec3f> points = centers_of(plane(20'000, 40, 1));
  const std::vector<std::uint16_t> ids = numbers(points.size());
  const LevelTree tree({{}, points, ids, {}, {}}, kSmall, Executor(2));
  expect_well_formed(tree, kSmall.leaf_size);
  for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
    const LevelNode& node = tree.nodes()[n];
    std::vector<std::uint16_t> chosen;
    EXPECT_EQ(node.largest_radius_m, 0.0F);
    for (const Decoded& element : decode(tree, n)) {
      ASSERT_LT(length(element.disk.center - points[element.class_id]), 1e-3F);
      EXPECT_EQ(element.disk.normal, (Vec3f{0, 0, 1}));
      chosen.push_back(element.class_id);
    }
    std::ranges::sort(chosen);
    EXPECT_EQ(std::ranges::adjacent_find(chosen), chosen.end()) << "a duplicate point";
  }
  // The root has a point in every one of the cells of its plane.
  const float cells = 40.0F / tree.nodes()[0].spacing_m;
  EXPECT_NEAR(static_cast<float>(tree.nodes()[0].count), cells * cells, 0.1F * cells * cells);
}

// Oracle: the area of the disks of the leaves below a node.
TEST(LevelTree, PreservesAreasOfASparsePlane) {
  const std::vector<Disk> disks = plane(30'000, 30, 0.5);
  const LevelTree tree({disks, {}, {}, {}, {}}, kSmall, Executor(2));
  const auto area_of = [&](std::size_t n) {
    double area = 0;
    for (const Decoded& e : decode(tree, n))
      area += static_cast<double>(e.disk.radius) * static_cast<double>(e.disk.radius);
    return area;
  };
  std::vector<double> below(tree.nodes().size(), 0);
  for (std::size_t n = tree.nodes().size(); n-- > 0;) {
    const LevelNode& node = tree.nodes()[n];
    if (node.child_count == 0) below[n] = area_of(n);
    for (std::size_t child = node.first_child; child < node.first_child + node.child_count; ++child)
      below[n] += below[child];
    EXPECT_NEAR(area_of(n) / below[n], 1, 0.02) << n;
  }
}

/// Share of a grid of rays through the inner part of plane(..., side_m, ...) that hit.
double hit_share(const std::vector<Decoded>& elements, double side_m) {
  constexpr int kRays = 50;
  int hits = 0;
  for (int k = 0; k < kRays * kRays; ++k) {
    const int row = k / kRays, column = k % kRays;
    const double x = side_m * (0.02 + 0.96 * (column + 0.5) / kRays);
    const double y = side_m * (0.02 + 0.96 * (row + 0.5) / kRays);
    const Ray ray = {vec_cast<float>(Vec3d{x, y, 10}), 0, {0, 0, -1}, 100};
    hits += std::ranges::any_of(elements, [&](const Decoded& element) {
      return std::isfinite(intersect_disk(ray, element.disk));
    });
  }
  return static_cast<double>(hits) / (kRays * kRays);
}

// Oracle: rays cast at every disk of a level.
TEST(LevelTree, APlaneStaysAPlaneWithoutHolesOrOverhang) {
  constexpr double kSide_m = 30;
  const std::vector<Disk> disks = plane(20'000, kSide_m, 7);
  const LevelTree tree({disks, {}, {}, {}, {}}, kSmall, Executor(2));
  ASSERT_GE(depth(tree), 2U);
  ASSERT_GE(hit_share(cut(tree, depth(tree)), kSide_m), 0.998);
  for (std::uint32_t level = 0; level < depth(tree); ++level) {
    const std::vector<Decoded> elements = cut(tree, level);
    EXPECT_GE(hit_share(elements, kSide_m), 0.995) << "level " << level;
    EXPECT_LT(elements.size(), disks.size() / 2);
    // At most one cell farther out than the disks of the input.
    const float margin = disks[0].radius + tree.nodes()[0].spacing_m / std::ldexp(1.0F, level);
    for (const Decoded& element : elements) {
      ASSERT_NEAR(element.disk.center.z, 2, 1e-6F);
      ASSERT_GT(std::fabs(element.disk.normal.z), 0.9999F);
      for (const float at : {element.disk.center.x, element.disk.center.y}) {
        ASSERT_GT(at - element.disk.radius, -margin);
        ASSERT_LT(at + element.disk.radius, static_cast<float>(kSide_m) + margin);
      }
    }
  }
}

// Oracle: the two planes of the disks.
TEST(LevelTree, ACornerHasTwoFacingsAndAWallOne) {
  std::vector<Disk> corner = plane(10'000, 16, 3);
  for (std::size_t i = 0; i < corner.size(); ++i)
    if (i % 2 == 0)
      corner[i] = {{corner[i].center.x, 0, 2 + corner[i].center.y},
                   corner[i].radius,
                   {0, corner[i].normal.z, 0}};
  const LevelTree tree({corner, {}, {}, {}, {}}, kSmall, Executor(1));
  for (const Decoded& element : cut(tree, 0)) {
    const Vec3f n = element.disk.normal;
    EXPECT_GT(std::max(std::fabs(n.y), std::fabs(n.z)), 0.999F);
  }
  std::vector<Disk> wall = plane(10'000, 16, 3);
  for (std::size_t i = 0; i < wall.size(); ++i) wall[i].center.z = i % 2 == 0 ? 0.0F : 0.1F;
  const LevelTree both({wall, {}, {}, {}, {}}, kSmall, Executor(1));
  const std::vector<Decoded> elements = cut(both, 0);
  const float cells = 16 / both.nodes()[0].spacing_m;
  EXPECT_LE(static_cast<float>(elements.size()), (cells + 1) * (cells + 1));
  for (const Decoded& element : elements) {
    EXPECT_GT(std::fabs(element.disk.normal.z), 0.9999F);
    EXPECT_NEAR(element.disk.center.z, 0.05F, 0.05F);
  }
}

// Oracle: by hand; 300 disks at one position, so that all are in one cell.
TEST(LevelTree, AMergedDiskHasTheClassWithTheLargestAreaAndMeans) {
  std::vector<Disk> disks(300, {{1, 2, 3}, 0.1F, {0, 0, 1}});
  std::vector<std::uint16_t> classes(300, 7);
  std::vector<float> intensities(300, 0), errors_m(300, kNaN);
  for (std::size_t i = 0; i < 100; ++i) {
    disks[i].radius = 0.2F;  // 4 of 6 parts of the area
    classes[i] = 9;
    intensities[i] = 1;
    errors_m[i] = -0.2F;
  }
  std::vector<std::array<std::uint8_t, 3>> colors(300, {0, 30, 90});
  for (std::size_t i = 0; i < 100; ++i) colors[i] = {255, 30, 0};
  const LevelTree tree({disks, {}, classes, intensities, errors_m, colors}, kSmall, Executor(1));
  ASSERT_GT(tree.nodes()[0].child_count, 0U);
  const std::vector<Decoded> root = decode(tree, 0);
  ASSERT_EQ(root.size(), 1U);
  EXPECT_EQ(root[0].disk.center, (Vec3f{1, 2, 3}));
  // Coincident disks: limited to the largest one, not the sum of the areas.
  EXPECT_FLOAT_EQ(root[0].disk.radius, 0.2F);
  EXPECT_EQ(root[0].class_id, 9);
  EXPECT_NEAR(root[0].intensity, 170, 1);
  EXPECT_EQ(root[0].error, 1);  // -0.2 m is the largest known error
  ASSERT_EQ(tree.colors(0).size(), 1U);
  EXPECT_EQ(tree.colors(0)[0], (LevelColor{170, 30, 30, 255}));
  std::size_t of_leaves = 0;
  for (std::size_t n = 1; n < tree.nodes().size(); ++n) {
    ASSERT_EQ(tree.colors(n).size(), tree.elements(n).size());
    for (const LevelColor& color : tree.colors(n)) of_leaves += color[0] == 255 ? 1 : 0;
  }
  EXPECT_EQ(of_leaves, 100U);
  EXPECT_TRUE(LevelTree({disks}, kSmall, Executor(1)).colors(0).empty());
}

TEST(LevelTree, EmptyAndSingleElement) {
  const LevelTree none({}, {}, Executor(1));
  ASSERT_EQ(none.nodes().size(), 1U);
  EXPECT_EQ(none.nodes()[0].count, 0U);
  EXPECT_EQ(none.nodes()[0].child_count, 0U);
  EXPECT_TRUE(none.elements(0).empty());
  EXPECT_EQ(nodes_bytes(none.nodes()).size(), 48U);
  const std::vector<Disk> one = {{{1e6F, -2, 0.5F}, 0.25F, {1, 0, 0}}};
  const LevelTree tree({one, {}, {}, {}, {}}, {.leaf_size = 1}, Executor(1));
  expect_well_formed(tree, 1);
  const std::vector<Decoded> elements = decode(tree, 0);
  ASSERT_EQ(elements.size(), 1U);
  EXPECT_EQ(elements[0].disk.center, one[0].center);
  EXPECT_EQ(elements[0].disk.radius, one[0].radius);
  EXPECT_EQ(elements[0].disk.normal, one[0].normal);
}

TEST(LevelTree, EqualAndCollinearPoints) {
  const std::vector<Vec3f> equal(100'000, Vec3f{3, 4, 5});
  const LevelTree same({{}, equal, {}, {}, {}}, {.leaf_size = 100}, Executor(2));
  expect_well_formed(same, 100);
  EXPECT_LE(depth(same), 4U);
  EXPECT_EQ(same.nodes()[0].count, 1U);
  std::vector<Vec3f> line;
  line.reserve(50'000);
  for (int i = 0; i < 50'000; ++i) line.push_back({static_cast<float>(i) * 0.01F, 0, 1});
  const LevelTree along({{}, line, {}, {}, {}}, kSmall, Executor(2));
  expect_well_formed(along, kSmall.leaf_size);
  EXPECT_LE(depth(along), 9U);
}

TEST(LevelTree, FarOutliersCostOneLevelEach) {
  for (const float far_m : {1e5F, 1e30F, std::numeric_limits<float>::max()}) {
    std::vector<Disk> disks = plane(20'000, 30, 3);
    const LevelTree near({disks, {}, {}, {}, {}}, kSmall, Executor(1));
    disks.push_back({{far_m, 0, 0}, 0.1F, {0, 0, 1}});
    disks.push_back({{0, -far_m, 0}, 0.1F, {0, 0, 1}});
    const LevelTree tree({disks, {}, {}, {}, {}}, kSmall, Executor(2));
    expect_well_formed(tree, kSmall.leaf_size);
    EXPECT_LE(depth(tree), depth(near) + 3) << far_m;
    const float finest = near.nodes()[0].spacing_m;
    EXPECT_TRUE(std::ranges::any_of(tree.nodes(),
                                    [&](const LevelNode& node) {
                                      return node.child_count > 0 && node.count > 50 &&
                                             node.spacing_m <= 2 * finest;
                                    }))
        << "no useful node, outlier at " << far_m;
  }
}

TEST(LevelTree, LeavesKeepMillimetresDespiteOutliers) {
  for (const float far_m : {1e5F, 1e30F, std::numeric_limits<float>::max()}) {
    std::vector<Disk> disks = plane(100, 30, 3);
    disks.push_back({{far_m, 0, 0}, 0.1F, {0, 0, 1}});
    disks.push_back({{-far_m, -far_m, 0}, 0.1F, {0, 0, 1}});
    const std::vector<std::uint16_t> ids = numbers(disks.size());
    const LevelTree tree({disks, {}, ids, {}, {}}, {}, Executor(1));
    expect_well_formed(tree, disks.size());
    EXPECT_LE(tree.nodes().size(), 50U);
    for (std::size_t n = 0; n < tree.nodes().size(); ++n) {
      if (tree.nodes()[n].child_count > 0) continue;
      for (const Decoded& element : decode(tree, n))
        EXPECT_LE(length(element.disk.center - disks[element.class_id].center), 0.002F);
    }
  }
}

TEST(LevelTree, InnerNodesAreNeverLarge) {
  // Disks that fill space: few of them share a cell.
  const std::vector<Disk> disks = random_disks(30'000);
  const LevelTree tree({disks, {}, {}, {}, {}}, {.leaf_size = 1000}, Executor(2));
  std::size_t total = 0;
  for (const LevelNode& node : tree.nodes()) {
    if (node.child_count > 0) {
      EXPECT_LE(node.count, 2000U);
    }
    total += node.count;
  }
  EXPECT_LE(total, 2 * disks.size());
}

// Oracle: one thread.
TEST(LevelTree, ThreadsDoNotChangeAByte) {
  const std::vector<Disk> disks = random_disks(100'000);
  const std::vector<Vec3f> points = centers_of(disks);
  const LevelOptions options = {.leaf_size = 3000};
  const std::string splats = bytes_of(LevelTree({disks, {}, {}, {}, {}}, options, Executor(1)));
  const std::string dots = bytes_of(LevelTree({{}, points, {}, {}, {}}, options, Executor(1)));
  for (const int threads : {2, 3, 7}) {
    const Executor executor(threads);
    EXPECT_EQ(bytes_of(LevelTree({disks, {}, {}, {}, {}}, options, executor)), splats);
    EXPECT_EQ(bytes_of(LevelTree({{}, points, {}, {}, {}}, options, executor)), dots);
  }
}

TEST(LevelTree, BytesAreTheTable) {
  const LevelTree tree({random_disks(1000), {}, {}, {}, {}}, kSmall, Executor(1));
  const std::string bytes = nodes_bytes(tree.nodes());
  ASSERT_EQ(bytes.size(), 48 * tree.nodes().size());
  LevelNode last;
  std::memcpy(&last, bytes.data() + bytes.size() - 48, 48);
  EXPECT_EQ(last.count, tree.nodes().back().count);
  EXPECT_EQ(last.low, tree.nodes().back().low);
}

TEST(LevelTree, RangesOfAttributes) {
  const std::vector<Vec3f> points(101, Vec3f{});
  std::vector<float> values;
  for (int i = 0; i <= 100; ++i) values.push_back(static_cast<float>((37 * i) % 101));
  const Executor executor(1);
  const LevelTree tree({{}, points, {}, values, values}, {}, executor);
  EXPECT_EQ(tree.intensity_range().low, 2.0F);
  EXPECT_EQ(tree.intensity_range().high, 98.0F);
  EXPECT_EQ(tree.error_range_m().low, 0.0F);
  EXPECT_EQ(tree.error_range_m().high, 98.0F);
  const std::vector<float> flat(101, 5), unknown(101, kNaN), none(101, 0);
  const LevelTree same({{}, points, {}, flat, none}, {}, executor);
  EXPECT_EQ(same.intensity_range().low, 0.0F);
  EXPECT_EQ(same.intensity_range().high, 1.0F);
  EXPECT_EQ(same.error_range_m().high, 1e-3F);
  const LevelTree dark({{}, points, {}, unknown, unknown}, {}, executor);
  EXPECT_EQ(dark.intensity_range().high, 1.0F);
  EXPECT_EQ(dark.error_range_m().high, 1e-3F);
  EXPECT_EQ(dark.elements(0)[0].error, 0);
  EXPECT_EQ(dark.elements(0)[0].intensity, 0);
}

TEST(LevelTree, RejectsAttributesOfTheWrongSize) {
  const std::vector<Disk> disks = random_disks(3);
  const std::vector<Vec3f> points = centers_of(disks);
  const std::vector<std::uint16_t> ids = numbers(2);
  const std::vector<float> values(4, 0);
  const Executor executor(1);
  EXPECT_THROW(LevelTree({disks, points, {}, {}, {}}, {}, executor), std::logic_error);
  EXPECT_THROW(LevelTree({disks, {}, ids, {}, {}}, {}, executor), std::logic_error);
  EXPECT_THROW(LevelTree({{}, points, {}, values, {}}, {}, executor), std::logic_error);
  EXPECT_THROW(LevelTree({{}, points, {}, {}, values}, {}, executor), std::logic_error);
  EXPECT_THROW(LevelTree({{}, {}, {}, {}, values}, {}, executor), std::logic_error);
  EXPECT_THROW(LevelTree({disks, {}, {}, {}, {}}, {.leaf_size = 0}, executor), std::logic_error);
}

// Oracle: the formula of the protocol, decoded independently.
TEST(OctahedralNormal, RoundTrip) {
  std::vector<Vec3f> normals;
  for (const float x : {-1.0F, 0.0F, 1.0F})
    for (const float y : {-1.0F, 0.0F, 1.0F})
      for (const float z : {-1.0F, 0.0F, 1.0F})
        if (x != 0 || y != 0 || z != 0) normals.push_back(normalized(Vec3f{x, y, z}));
  for (std::size_t i = 0; i < 10'000; ++i) {
    Random random(5, 2, i);
    normals.push_back(random_direction(random));
  }
  for (const Vec3f normal : normals) {
    const OctahedralNormal code = octahedral(normal);
    ASSERT_LT(length(normal_of(code) - normal), 1e-4F);
    const Vec3d decoded = decoded_normal(code.u / 32767.0, code.v / 32767.0);
    ASSERT_LT(length(decoded - vec_cast<double>(normal)), 1e-4);
  }
  EXPECT_EQ(octahedral({0, 0, 1}).u, 0);
  EXPECT_EQ(octahedral({1, 0, 0}).u, 32767);
  EXPECT_EQ(octahedral({0, -1, 0}).v, -32767);
}

}  // namespace
}  // namespace adasplats
