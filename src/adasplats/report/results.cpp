// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/report/results.h"

#include <algorithm>
#include <cmath>

namespace adasplats::page {
namespace {

std::vector<const Json*> objects_of(const Json* list) {
  std::vector<const Json*> objects;
  if (list == nullptr || !list->is_array()) return objects;
  for (const Json& element : *list) {
    if (element.is_object()) objects.push_back(&element);
  }
  return objects;
}

}  // namespace

const Json* find(const Json& json, const KeyPath& path) {
  const Json* value = &json;
  for (const std::string& key : path) {
    if (!value->is_object()) return nullptr;
    const auto found = value->find(key);
    if (found == value->end()) return nullptr;
    value = &*found;
  }
  return value;
}

std::optional<double> number_at(const Json& json, const KeyPath& path) {
  const Json* found = find(json, path);
  if (found == nullptr || !found->is_number()) return std::nullopt;
  const double number = found->get<double>();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::string text_at(const Json& json, const KeyPath& path) {
  const Json* found = find(json, path);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

std::vector<Competitor> competitors_of(const Json& results) {
  std::vector<Competitor> competitors;
  std::vector<std::string> bases;
  for (const Json* json : objects_of(find(results, {"competitors"}))) {
    Competitor competitor;
    competitor.json = json;
    competitor.name = text_at(*json, {"name"});
    competitor.title = text_at(*json, {"title"});
    if (competitor.title.empty()) competitor.title = competitor.name;
    const std::string state = text_at(*json, {"state"});
    if (state != "done") competitor.badge = state.empty() ? "no state" : state;
    const std::string failed = text_at(*json, {"failed_step"});
    competitor.has_model = state == "done" || (failed != "generate" && failed != "info");
    std::string base = competitor.name;
    competitor.key.variant = base.ends_with(kVariantSuffix);
    if (competitor.key.variant) base.resize(base.size() - kVariantSuffix.size());
    const auto found = std::find(bases.begin(), bases.end(), base);
    competitor.key.slot = static_cast<std::size_t>(found - bases.begin());
    if (found == bases.end()) bases.push_back(base);
    competitors.push_back(std::move(competitor));
  }
  return competitors;
}

std::vector<const Json*> paper_rows_of(const Json& results) {
  return objects_of(find(results, {"paper", "rows"}));
}

}  // namespace adasplats::page
