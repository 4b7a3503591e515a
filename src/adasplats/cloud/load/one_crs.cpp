// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/cloud/load/one_crs.h"

namespace adasplats {

void require_one_crs(std::initializer_list<std::pair<std::filesystem::path, Crs>> inputs,
                     ProgressSink& progress) {
  SharedCrs shared;
  for (const auto& [file, crs] : inputs) shared.add(file, crs);
  if (const std::string warning = shared.warning(); !warning.empty()) progress.warn(warning);
}

}  // namespace adasplats
