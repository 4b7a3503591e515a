// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/labels/benchmark_classes.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace adasplats {
namespace {

constexpr std::string_view kNothing = "unlabeled";

/// learning_map and learning_map_inv of semantic-kitti.yaml by names: a class and what it counts
/// as. Those that count as themselves are the benchmark's, in its order.
constexpr std::pair<std::string_view, std::string_view> kSemanticKittiBenchmark[] = {
    {"car", "car"},
    {"bicycle", "bicycle"},
    {"motorcycle", "motorcycle"},
    {"truck", "truck"},
    {"other-vehicle", "other-vehicle"},
    {"person", "person"},
    {"bicyclist", "bicyclist"},
    {"motorcyclist", "motorcyclist"},
    {"road", "road"},
    {"parking", "parking"},
    {"sidewalk", "sidewalk"},
    {"other-ground", "other-ground"},
    {"building", "building"},
    {"fence", "fence"},
    {"vegetation", "vegetation"},
    {"trunk", "trunk"},
    {"terrain", "terrain"},
    {"pole", "pole"},
    {"traffic-sign", "traffic-sign"},
    {"bus", "other-vehicle"},
    {"on-rails", "other-vehicle"},
    {"lane-marking", "road"},
    {"moving-car", "car"},
    {"moving-bicyclist", "bicyclist"},
    {"moving-person", "person"},
    {"moving-motorcyclist", "motorcyclist"},
    {"moving-on-rails", "other-vehicle"},
    {"moving-bus", "other-vehicle"},
    {"moving-truck", "truck"},
    {"moving-other-vehicle", "other-vehicle"},
    {"unlabeled", kNothing},
    {"outlier", kNothing},
    {"other-structure", kNothing},
    {"other-object", kNothing},
};

/// What a class of SemanticKITTI counts as; empty: it has no such class.
std::string_view benchmark_name(std::string_view name) {
  for (const auto& [from, to] : kSemanticKittiBenchmark)
    if (from == name) return to;
  return {};
}

/// A file may take the name "semantickitti" for classes of its own.
bool is_semantickitti(const LabelScheme& labels) {
  return labels.name() == semantickitti_labels().name() &&
         std::ranges::none_of(labels.classes(), [](const SemanticClass& c) {
           return benchmark_name(c.name).empty();
         });
}

BenchmarkClass as_benchmark_class(const SemanticClass& c) {
  return {c.name, c.group, c.mobility != Mobility::fixed};
}

std::vector<BenchmarkClass> classes_of_benchmark(const LabelScheme& labels) {
  std::vector<BenchmarkClass> classes;
  for (const auto& [from, to] : kSemanticKittiBenchmark) {
    if (from != to || from == kNothing) continue;
    const SemanticClass* const own = labels.find(from);
    classes.push_back(
        as_benchmark_class(own != nullptr ? *own : *semantickitti_labels().find(from)));
  }
  return classes;
}

}  // namespace

BenchmarkClasses::BenchmarkClasses(const LabelScheme& labels) : scheme_(labels.name()) {
  const bool is_mapped = is_semantickitti(labels);
  if (is_mapped) classes_ = classes_of_benchmark(labels);
  for (const SemanticClass& c : labels.classes()) {
    const bool is_new = c.name != kNothing && number_of(c.name) == classes_.size();
    if (!is_mapped && is_new) classes_.push_back(as_benchmark_class(c));
  }
  number_of_id_.resize(1 << 16);
  number_of_id_.front() = classes_.size();
  for (const SemanticClass& c : labels.classes())
    number_of_id_[c.id] = number_of(is_mapped ? benchmark_name(c.name) : c.name);
}

std::size_t BenchmarkClasses::number_of(std::string_view name) const {
  return static_cast<std::size_t>(std::ranges::find(classes_, name, &BenchmarkClass::name) -
                                  classes_.begin());
}

std::optional<std::size_t> BenchmarkClasses::find(std::uint16_t id) const {
  return number_of_id_[id];
}

}  // namespace adasplats
