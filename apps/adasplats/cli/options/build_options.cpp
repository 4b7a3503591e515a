// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/build_options.h"

#include "cli/options/option_types.h"
#include "cli/text_table.h"

namespace adasplats::app {

std::string text_of(const std::vector<RemovedPoints::OfClass>& removed) {
  std::string text;
  for (const auto& part : removed) {
    text += (text.empty() ? " (" : ", ") + part.name + " " + grouped(part.points);
  }
  return text.empty() ? text : text + ")";
}

void add_removal_option(OptionSet& app, DynamicRemoval& removal) {
  add_choice<DynamicRemoval>(app, "--remove", removal, choices_of<DynamicRemoval>(kDynamicRemovals),
                             "Objects to leave out by their labels; movable: parked cars too");
}

}  // namespace adasplats::app
