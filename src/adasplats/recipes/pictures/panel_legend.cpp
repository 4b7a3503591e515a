// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/recipes/pictures/panel_legend.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "adasplats/core/error.h"
#include "adasplats/simulate/image/class_colors.h"
#include "adasplats/simulate/image/shading_maths.h"

namespace adasplats {
namespace {

constexpr std::size_t kMostEntries = 14;
constexpr std::size_t kLeastShare = 1000;  // one in so many

struct Entry {
  std::uint64_t count = 0;
  Rgb rgb{};
  std::string name;
};

ClassLegend commonest(std::vector<Entry> entries, std::size_t all) {
  std::erase_if(entries, [&](const Entry& entry) {
    return entry.count == 0 || entry.count * kLeastShare < all;
  });
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.count > b.count; });
  if (entries.size() > kMostEntries) entries.resize(kMostEntries);
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

std::vector<float> splat_errors(const ErrorPoints& points, std::size_t splats,
                                const std::filesystem::path& path) {
  constexpr double kMost_m = 0.5;
  if (points.primitives.empty())
    throw Error(ErrorKind::data, path.string() +
                                     ": does not say which splats its beams hit (column 'splat'); "
                                     "write it anew with 'evaluate resimulate --errors'");
  if (points.primitive_count != splats)
    throw Error(ErrorKind::data, path.string() + ": the errors are of another model, of " +
                                     std::to_string(points.primitive_count) +
                                     " splats; this one has " + std::to_string(splats));
  std::vector<double> sums(splats, 0);
  std::vector<std::uint32_t> counts(splats, 0);
  for (std::size_t i = 0; i < points.primitives.size(); ++i) {
    const std::uint32_t splat = points.primitives[i];
    if (splat == Hit::kNone || std::isnan(points.errors_m[i])) continue;
    if (splat >= splats)
      throw Error(ErrorKind::data, path.string() + ": a beam hit splat " + std::to_string(splat) +
                                       " of " + std::to_string(splats));
    sums[splat] += std::clamp(static_cast<double>(points.errors_m[i]), -kMost_m, kMost_m);
    ++counts[splat];
  }
  std::vector<float> errors(splats, std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < splats; ++i)
    if (counts[i] > 0) errors[i] = static_cast<float>(sums[i] / counts[i]);
  return errors;
}

}  // namespace adasplats
