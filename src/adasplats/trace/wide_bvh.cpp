// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/trace/wide_bvh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "adasplats/scene/soft_disk.h"

namespace adasplats {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kBuildGrain = 1 << 15;
constexpr unsigned kBins = 16;

/// x, y, z and one lane to spare: one vector register on x86 and Arm.
using Float4 [[gnu::vector_size(16)]] = float;

Float4 smaller(Float4 a, Float4 b) { return a < b ? a : b; }
Float4 larger(Float4 a, Float4 b) { return a > b ? a : b; }

struct Box {
  Float4 low = {kInfinity, kInfinity, kInfinity, kInfinity};
  Float4 high = {-kInfinity, -kInfinity, -kInfinity, -kInfinity};

  void add(Float4 from, Float4 to) {
    low = smaller(low, from);
    high = larger(high, to);
  }
  void add(const Box& box) { add(box.low, box.high); }
  float half_area() const {
    const Float4 size = high - low;
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
  }
};

/// Box of a primitive; the spare lane of `low` holds its index.
struct Item {
  Float4 low, high;

  std::uint32_t index() const { return std::bit_cast<std::uint32_t>(low[3]); }
  /// Twice the centre: only its order matters.
  Float4 middle() const { return low + high; }
};

struct Range {
  std::size_t begin = 0, end = 0;
  Box box;
  Box middles;  ///< bounds of the items' middle()

  std::size_t size() const { return end - begin; }
  void add(const Item& item) {
    box.add(item.low, item.high);
    const Float4 middle = item.middle();
    middles.add(middle, middle);
  }
  void add(const Range& other) {
    box.add(other.box);
    middles.add(other.middles);
  }
};

/// Assigns items to bins along the three axes.
struct Binning {
  Float4 low, scale;
  unsigned bins;

  explicit Binning(const Range& range) : low(range.middles.low), bins(range.size() < 64 ? 8 : 16) {
    const Float4 size = range.middles.high - range.middles.low;
    for (int axis = 0; axis < 4; ++axis)
      scale[axis] = size[axis] > 0 ? static_cast<float>(bins) * 0.99999F / size[axis] : 0.0F;
  }
  unsigned bin_of(Float4 middle, int axis) const {
    const int bin = static_cast<int>((middle[axis] - low[axis]) * scale[axis]);
    return std::min(static_cast<unsigned>(std::max(bin, 0)), bins - 1);
  }
};

struct Bins {
  std::array<std::array<Box, kBins>, 3> boxes;
  std::array<std::array<std::uint32_t, kBins>, 3> counts{};

  void add(const Item& item, const Binning& binning) {
    const Float4 middle = item.middle();
    for (int axis = 0; axis < 3; ++axis) {
      const unsigned bin = binning.bin_of(middle, axis);
      boxes[axis][bin].add(item.low, item.high);
      ++counts[axis][bin];
    }
  }
  Bins& operator+=(const Bins& other) {
    for (int axis = 0; axis < 3; ++axis) {
      for (unsigned bin = 0; bin < kBins; ++bin) {
        boxes[axis][bin].add(other.boxes[axis][bin]);
        counts[axis][bin] += other.counts[axis][bin];
      }
    }
    return *this;
  }
};

/// Items in bins below `bin` along `axis` go left; axis -1: the first half does.
struct Split {
  int axis = -1;
  unsigned bin = 0;
};

/// Cost of a leaf: primitives are tested in blocks of 16.
float blocks(std::size_t count) {
  const std::size_t whole = (count + kWide - 1) / kWide;
  return static_cast<float>(whole);
}

/// The split with the lowest surface area cost; the first of equal ones.
Split best_split(const Bins& bins, unsigned used) {
  Split best;
  float min_cost = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<float, kBins> right_cost{};
    Box right;
    std::size_t right_count = 0;
    for (unsigned bin = used - 1; bin > 0; --bin) {
      right.add(bins.boxes[axis][bin]);
      right_count += bins.counts[axis][bin];
      right_cost[bin] = right_count == 0 ? kInfinity : right.half_area() * blocks(right_count);
    }
    Box left;
    std::size_t left_count = 0;
    for (unsigned bin = 1; bin < used; ++bin) {
      left.add(bins.boxes[axis][bin - 1]);
      left_count += bins.counts[axis][bin - 1];
      if (left_count == 0) continue;
      const float cost = left.half_area() * blocks(left_count) + right_cost[bin];
      if (cost < min_cost) {
        min_cost = cost;
        best = {axis, bin};
      }
    }
  }
  return best;
}

Vec3f clamped(Vec3f v) {
  // Embree's limit. Rays are shorter, and products of bounds stay finite.
  constexpr float kLargest = 1.844e18F;
  return max(min(v, {kLargest, kLargest, kLargest}), {-kLargest, -kLargest, -kLargest});
}

Item item_of(Vec3f low, Vec3f high, std::uint32_t index) {
  const Vec3f from = clamped(low), to = clamped(high);
  const Float4 low4 = {from.x, from.y, from.z, std::bit_cast<float>(index)};
  const Float4 high4 = {to.x, to.y, to.z, 0.0F};
  return {low4, high4};
}

bool has_nan(Vec3f v) { return v.x != v.x || v.y != v.y || v.z != v.z; }

float largest_of(Vec3f low, Vec3f high) {
  const Vec3f far = max(-low, high);
  return std::max({far.x, far.y, far.z});
}

class Builder {
 public:
  Builder(const SceneView& scene, const Executor& executor) : scene_(scene), executor_(executor) {}

  WideBvh build() {
    Range all = gather();
    WideBvh bvh;
    if (all.size() == 0) return bvh;
    subtree_size_ = std::max<std::size_t>(all.size() / 128, 4096);
    bvh.root = add_top(all, bvh);
    build_subtrees(bvh);
    bvh.margin_m = margin_m_;
    bvh.has_unit_normals = has_unit_normals_;
    return bvh;
  }

 private:
  /// A range that one thread builds; its root becomes children[child] of `node`, or the root of the
  /// tree.
  struct Subtree {
    Range range;
    std::size_t node;
    unsigned child;
    WideBvh bvh;
  };
  static constexpr std::size_t kNoNode = static_cast<std::size_t>(-1);

  struct Gathered {
    Range range;
    float largest = 0.0F;
    bool unit = true;
    std::vector<Item> items;
  };

  Range gather() {
    const std::size_t count = scene_.primitive_count();
    std::vector<Gathered> parts((count + kBuildGrain - 1) / kBuildGrain);
    executor_.for_chunks(count, kBuildGrain, [&](std::size_t begin, std::size_t end) {
      parts[begin / kBuildGrain] = gather(begin, end);
    });
    Range all;
    for (const Gathered& part : parts) {
      all.add(part.range);
      margin_m_ = std::max(margin_m_, box_margin(part.largest));
      has_unit_normals_ = has_unit_normals_ && part.unit;
    }
    std::vector<std::size_t> starts;
    for (const Gathered& part : parts) {
      starts.push_back(all.end);
      all.end += part.items.size();
    }
    items_.resize(all.size());
    executor_.for_chunks(parts.size(), 1, [&](std::size_t i, std::size_t) {
      std::ranges::copy(parts[i].items, items_.begin() + static_cast<std::ptrdiff_t>(starts[i]));
    });
    return all;
  }

  Gathered gather(std::size_t begin, std::size_t end) const {
    Gathered part;
    part.items.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      Vec3f low, high;
      if (i < scene_.disk_count()) {
        const Disk& disk = scene_.disks[i];
        const Vec3f half = disk_half_extent(disk);
        low = disk.center - half;
        high = disk.center + half;
        const float size2 = dot(disk.normal, disk.normal);
        part.unit = part.unit && !(std::fabs(size2 - 1.0F) > 1e-5F);
      } else {
        const Triangle triangle = scene_.mesh->triangle(i - scene_.disk_count());
        low = min(min(triangle.a, triangle.b), triangle.c);
        high = max(max(triangle.a, triangle.b), triangle.c);
        const float margin = box_margin(largest_of(low, high));
        const Vec3f margins = {margin, margin, margin};
        // min and max drop some NaN, so the sum of all corners is checked.
        const Vec3f sum = triangle.a + triangle.b + triangle.c;
        low = has_nan(sum) ? sum : low - margins;
        high = high + margins;
      }
      if (has_nan(low) || has_nan(high)) continue;
      const Item item = item_of(low, high, static_cast<std::uint32_t>(i));
      part.largest = std::max(part.largest, largest_of(low, high));
      part.range.add(item);
      part.items.push_back(item);
    }
    return part;
  }

  bool is_disk(std::uint32_t primitive) const { return primitive < scene_.disk_count(); }

  bool has_both_kinds(const Range& range) const {
    if (scene_.disk_count() == 0 || scene_.triangle_count() == 0) return false;
    const bool first = is_disk(items_[range.begin].index());
    for (std::size_t i = range.begin + 1; i < range.end; ++i)
      if (is_disk(items_[i].index()) != first) return true;
    return false;
  }

  bool is_leaf(const Range& range) const { return range.size() <= kWide && !has_both_kinds(range); }

  /// Splits a range that is not a leaf.
  std::array<Range, 2> split(const Range& range) {
    if (range.size() <= kWide) {
      return partition(range, [&](const Item& item) { return is_disk(item.index()); });
    }
    const Binning binning(range);
    const Split split = range.size() > 2 * kBuildGrain
                            ? best_split(bin_in_parallel(range, binning), binning.bins)
                            : best_split(bin(range.begin, range.end, binning), binning.bins);
    if (split.axis < 0) return halves(range);
    const auto goes_left = [&](const Item& item) {
      return binning.bin_of(item.middle(), split.axis) < split.bin;
    };
    return range.size() > 2 * kBuildGrain ? partition_in_parallel(range, goes_left)
                                          : partition(range, goes_left);
  }

  Bins bin(std::size_t begin, std::size_t end, const Binning& binning) const {
    Bins bins;
    for (std::size_t i = begin; i < end; ++i) bins.add(items_[i], binning);
    return bins;
  }

  Bins bin_in_parallel(const Range& range, const Binning& binning) const {
    return executor_.sum_chunks(range.size(), kBuildGrain, Bins{},
                                [&](std::size_t begin, std::size_t end) {
                                  return bin(range.begin + begin, range.begin + end, binning);
                                });
  }

  /// For items with equal middles, where all splits are equally good.
  std::array<Range, 2> halves(const Range& range) const {
    const std::size_t middle = range.begin + range.size() / 2;
    Range left, right;
    left.begin = range.begin;
    left.end = right.begin = middle;
    right.end = range.end;
    for (std::size_t i = left.begin; i < left.end; ++i) left.add(items_[i]);
    for (std::size_t i = right.begin; i < right.end; ++i) right.add(items_[i]);
    return {left, right};
  }

  template <class Predicate>
  std::array<Range, 2> partition(const Range& range, const Predicate& goes_left) {
    Range left, right;
    std::size_t i = range.begin, j = range.end;
    while (i < j) {
      if (goes_left(items_[i])) {
        left.add(items_[i++]);
      } else {
        right.add(items_[i]);
        std::swap(items_[i], items_[--j]);
      }
    }
    left.begin = range.begin;
    left.end = right.begin = i;
    right.end = range.end;
    return {left, right};
  }

  /// Uses chunks of fixed size, so that the order of items does not depend on threads.
  template <class Predicate>
  std::array<Range, 2> partition_in_parallel(const Range& range, const Predicate& goes_left) {
    const std::size_t chunks = (range.size() + kBuildGrain - 1) / kBuildGrain;
    std::vector<std::array<Range, 2>> parts(chunks);
    executor_.for_chunks(range.size(), kBuildGrain, [&](std::size_t begin, std::size_t end) {
      Range chunk;
      chunk.begin = range.begin + begin;
      chunk.end = range.begin + end;
      parts[begin / kBuildGrain] = partition(chunk, goes_left);
    });
    std::array<Range, 2> sides;
    for (const auto& part : parts)
      for (int side = 0; side < 2; ++side) sides[side].add(part[side]);
    std::vector<std::array<std::size_t, 2>> starts;
    std::array<std::size_t, 2> next = {range.begin, range.begin};
    for (const auto& part : parts) next[1] += part[0].size();
    sides[0].begin = range.begin;
    sides[0].end = sides[1].begin = next[1];
    sides[1].end = range.end;
    for (const auto& part : parts) {
      starts.push_back(next);
      for (int side = 0; side < 2; ++side) next[side] += part[side].size();
    }
    spare_.resize(items_.size());
    executor_.for_chunks(chunks, 1, [&](std::size_t chunk, std::size_t) {
      for (int side = 0; side < 2; ++side)
        std::copy_n(items_.data() + parts[chunk][side].begin, parts[chunk][side].size(),
                    spare_.data() + starts[chunk][side]);
    });
    executor_.for_chunks(range.size(), kBuildGrain, [&](std::size_t begin, std::size_t end) {
      std::copy_n(spare_.data() + range.begin + begin, end - begin,
                  items_.data() + range.begin + begin);
    });
    return sides;
  }

  /// Up to 16 parts of a range: the part with the largest surface is split until there are 16.
  std::vector<Range> wide_split(const Range& range) {
    std::vector<Range> parts = {range};
    while (parts.size() < kWide) {
      std::size_t largest = parts.size();
      float largest_area = -1.0F;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        if (is_leaf(parts[i])) continue;
        const float area = parts[i].box.half_area();
        if (area > largest_area) {
          largest_area = area;
          largest = i;
        }
      }
      if (largest == parts.size()) break;
      const auto two = split(parts[largest]);
      parts[largest] = two[0];
      parts.push_back(two[1]);
    }
    return parts;
  }

  static std::size_t add_node(std::span<const Range> parts, WideBvh& bvh) {
    std::array<WideChild, kWide> children;
    for (std::size_t child = 0; child < parts.size(); ++child) {
      const Box& box = parts[child].box;
      children[child] = {
          {box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}, {}};
    }
    bvh.nodes.push_back(wide_node(std::span(children).first(parts.size())));
    return bvh.nodes.size() - 1;
  }

  /// Builds the top of the tree one range after another, each in parallel.
  WideRef add_top(const Range& range, WideBvh& bvh) {
    if (range.size() <= subtree_size_) {
      subtrees_.push_back({range, kNoNode, 0, {}});
      return {};
    }
    const std::vector<Range> parts = wide_split(range);
    const std::size_t node = add_node(parts, bvh);
    for (unsigned child = 0; child < parts.size(); ++child) {
      const std::size_t before = subtrees_.size();
      const WideRef ref = add_top(parts[child], bvh);
      bvh.nodes[node].children[child] = ref;
      if (subtrees_.size() > before && ref.kind() == WideRef::Kind::nothing) {
        subtrees_.back().node = node;
        subtrees_.back().child = child;
      }
    }
    return WideRef::to(WideRef::Kind::node, node);
  }

  WideRef add_subtree(const Range& range, WideBvh& bvh) {
    if (is_leaf(range)) return add_leaf(range, bvh);
    const std::vector<Range> parts = wide_split(range);
    const std::size_t node = add_node(parts, bvh);
    for (unsigned child = 0; child < parts.size(); ++child) {
      const WideRef ref = add_subtree(parts[child], bvh);
      bvh.nodes[node].children[child] = ref;
    }
    return WideRef::to(WideRef::Kind::node, node);
  }

  WideRef add_leaf(const Range& range, WideBvh& bvh) const {
    const std::span<const Item> items(items_.data() + range.begin, range.size());
    if (is_disk(items.front().index())) {
      bvh.disks.push_back(disk_block(items));
      return WideRef::to(WideRef::Kind::disks, bvh.disks.size() - 1);
    }
    bvh.triangles.push_back(triangle_block(items));
    return WideRef::to(WideRef::Kind::triangles, bvh.triangles.size() - 1);
  }

  DiskBlock disk_block(std::span<const Item> items) const {
    DiskBlock block;
    for (unsigned lane = 0; lane < kWide; ++lane) {
      const bool used = lane < items.size();
      const Disk disk = used ? scene_.disks[items[lane].index()] : Disk{};
      for (int axis = 0; axis < 3; ++axis) {
        block.center[axis][lane] = disk.center[axis];
        block.normal[axis][lane] = disk.normal[axis];
      }
      block.radius2[lane] = used ? disk.radius * disk.radius : -1.0F;
      block.primitive[lane] = used ? items[lane].index() : Hit::kNone;
    }
    return block;
  }

  TriangleBlock triangle_block(std::span<const Item> items) const {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr Vec3f kNowhere = {kNaN, kNaN, kNaN};
    TriangleBlock block;
    for (unsigned lane = 0; lane < kWide; ++lane) {
      const bool used = lane < items.size();
      const Triangle triangle =
          used ? scene_.mesh->triangle(items[lane].index() - scene_.disk_count())
               : Triangle{kNowhere, kNowhere, kNowhere};
      for (int axis = 0; axis < 3; ++axis) {
        block.corners[0][axis][lane] = triangle.a[axis];
        block.corners[1][axis][lane] = triangle.b[axis];
        block.corners[2][axis][lane] = triangle.c[axis];
      }
      block.primitive[lane] = used ? items[lane].index() : Hit::kNone;
    }
    return block;
  }

  void build_subtrees(WideBvh& bvh) {
    executor_.for_chunks(subtrees_.size(), 1, [&](std::size_t i, std::size_t) {
      Subtree& subtree = subtrees_[i];
      subtree.bvh.root = add_subtree(subtree.range, subtree.bvh);
    });
    struct Starts {
      std::size_t nodes, disks, triangles;
    };
    std::vector<Starts> starts;
    Starts next = {bvh.nodes.size(), 0, 0};
    for (const Subtree& subtree : subtrees_) {
      starts.push_back(next);
      next.nodes += subtree.bvh.nodes.size();
      next.disks += subtree.bvh.disks.size();
      next.triangles += subtree.bvh.triangles.size();
    }
    items_ = {};
    spare_ = {};
    bvh.nodes.resize(next.nodes);
    bvh.disks.resize(next.disks);
    bvh.triangles.resize(next.triangles);
    executor_.for_chunks(subtrees_.size(), 1, [&](std::size_t i, std::size_t) {
      const Starts& start = starts[i];
      WideBvh& part = subtrees_[i].bvh;
      const auto moved = [&](WideRef ref) {
        switch (ref.kind()) {
          case WideRef::Kind::node: ref.bits += static_cast<std::uint32_t>(start.nodes); break;
          case WideRef::Kind::disks: ref.bits += static_cast<std::uint32_t>(start.disks); break;
          case WideRef::Kind::triangles:
            ref.bits += static_cast<std::uint32_t>(start.triangles);
            break;
          case WideRef::Kind::nothing: break;
        }
        return ref;
      };
      for (WideNode& node : part.nodes)
        for (WideRef& child : node.children) child = moved(child);
      std::ranges::copy(part.nodes, bvh.nodes.data() + start.nodes);
      std::ranges::copy(part.disks, bvh.disks.data() + start.disks);
      std::ranges::copy(part.triangles, bvh.triangles.data() + start.triangles);
      const WideRef root = moved(part.root);
      if (subtrees_[i].node == kNoNode) {
        bvh.root = root;
      } else {
        bvh.nodes[subtrees_[i].node].children[subtrees_[i].child] = root;
      }
      part = {};
    });
  }

  const SceneView& scene_;
  const Executor& executor_;
  std::vector<Item> items_, spare_;
  std::vector<Subtree> subtrees_;
  std::size_t subtree_size_ = 0;
  float margin_m_ = 0.0F;
  bool has_unit_normals_ = true;
};

SoftBlock soft_block(const SceneView& scene, const DiskBlock& disks) {
  SoftBlock block;
  for (unsigned lane = 0; lane < kWide; ++lane) {
    const std::uint32_t disk = disks.primitive[lane];
    block.radii_per_m[lane] = disk == Hit::kNone ? 1 : radii_per_m(scene.disks[disk]);
    block.opacity[lane] = disk == Hit::kNone ? 0 : scene.opacities[disk];
  }
  return block;
}

/// Sorts children by their middles along the diagonal of each octant.
void set_order(std::span<const WideChild> children, WideNode& node) {
  for (unsigned octant = 0; octant < 8; ++octant) {
    std::array<float, kWide> keys{};
    std::array<std::uint8_t, kWide> order{};
    for (unsigned child = 0; child < kWide; ++child) {
      order[child] = static_cast<std::uint8_t>(child);
      if (child >= children.size()) continue;
      const Vec3f middle = children[child].low + children[child].high;
      for (int axis = 0; axis < 3; ++axis)
        keys[child] += (octant >> axis & 1U) != 0 ? -middle[axis] : middle[axis];
    }
    std::stable_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(children.size()),
                     [&](std::uint8_t a, std::uint8_t b) { return keys[a] > keys[b]; });
    std::ranges::copy(order, node.far_first[octant]);
  }
}

}  // namespace

WideNode wide_node(std::span<const WideChild> children) {
  WideNode node;
  for (unsigned child = 0; child < kWide; ++child) {
    const bool used = child < children.size();
    for (int axis = 0; axis < 3; ++axis) {
      node.bounds[0][axis][child] = used ? children[child].low[axis] : kInfinity;
      node.bounds[1][axis][child] = used ? children[child].high[axis] : -kInfinity;
    }
    node.children[child] = used ? children[child].ref : WideRef{};
  }
  set_order(children, node);
  return node;
}

WideBvh build_wide_bvh(const SceneView& scene, const Executor& executor) {
  WideBvh bvh = Builder(scene, executor).build();
  if (scene.opacities.empty()) return bvh;
  bvh.soft.resize(bvh.disks.size());
  executor.for_chunks(bvh.disks.size(), kFineGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) bvh.soft[i] = soft_block(scene, bvh.disks[i]);
  });
  return bvh;
}

}  // namespace adasplats
