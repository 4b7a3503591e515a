// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/jobs/pictures/panel_legend.h"

#include <algorithm>

#include "adasplats/simulate/image/class_colors.h"
#include "adasplats/simulate/image/shading_maths.h"

namespace adasplats {
namespace {

constexpr std::size_t kMaxEntries = 14;
constexpr std::size_t kMinShare = 1000;  // one in so many

struct Entry {
  std::uint64_t count = 0;
  Rgb rgb{};
  std::string name;
};

ClassLegend commonest(std::vector<Entry> entries, std::size_t all) {
  std::erase_if(entries, [&](const Entry& entry) {
    return entry.count == 0 || entry.count * kMinShare < all;
  });
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.count > b.count; });
  if (entries.size() > kMaxEntries) entries.resize(kMaxEntries);
  ClassLegend legend;
  for (Entry& entry : entries) legend.emplace_back(entry.rgb, std::move(entry.name));
  return legend;
}

}  // namespace

ClassLegend legend_of(std::span<const std::uint16_t> classes, const LabelScheme* labels) {
  if (labels == nullptr) return {};
  std::vector<std::uint64_t> counts(0x10000, 0);
  for (const std::uint16_t id : classes) ++counts[id];
  std::vector<Entry> entries;
  for (const SemanticClass& known : labels->classes())
    if (known.rgb != kNoClassColor)
      entries.push_back({counts[known.id], muted(known.rgb), known.name});
  return commonest(std::move(entries), classes.size());
}

ClassLegend legend_of(const ImageScene& scene) {
  if (!scene.attributes.classes.empty()) return legend_of(scene.attributes.classes, scene.labels);
  std::vector<Entry> entries(kSemanticGroups);
  for (int group = 0; group < kSemanticGroups; ++group) {
    Entry& entry = entries[static_cast<std::size_t>(group)];
    entry.rgb = rgb_of(shading::color_of(static_cast<SemanticGroup>(group)));
    entry.name = name_of(static_cast<SemanticGroup>(group));
  }
  for (const SemanticGroup group : scene.groups) ++entries[static_cast<std::size_t>(group)].count;
  return commonest(std::move(entries), scene.groups.size());
}

}  // namespace adasplats
