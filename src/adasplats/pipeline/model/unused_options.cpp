// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/pipeline/model/unused_options.h"

#include <initializer_list>

namespace adasplats {
namespace {

constexpr auto kScales = {"ground-scale", "surface-scale", "linear-scale", "non-surface-scale",
                          "planar-scale"};

constexpr const char* kOfConsistent = "with the paper's methods; it is for --method consistent";

class Unused {
 public:
  void add(std::initializer_list<const char*> names, const std::string& why) {
    for (const char* name : names) options.push_back({name, why});
  }
  std::vector<UnusedOption> options;
};

// What is turned off and would not have been done anyway is as wished.
void add_consistent(Unused& unused, const BuildOptions& all) {
  const ConsistentOptions& options = all.consistent;
  const std::string why = "with --method consistent; it is for the paper's methods";
  unused.add({"neighbors", "alpha", "smoothness", "radius", "error-bound", "selection",
              "denoise-sigmas", "denoise-votes", "resample-density", "resample-base"},
             why);
  if (all.denoise) unused.add({"denoise"}, why);
  if (all.resample) unused.add({"resample"}, why);
  if (all.group_normals) unused.add({"group-normals"}, why);
  unused.add(kScales, why);
  if (options.balance_rounds > 0) return;
  const std::string unchecked = "with --balance-rounds 0, where no ray is looked at";
  unused.add({"strict-rounds", "settle-rounds"}, unchecked);
  if (options.fill) unused.add({"fill"}, unchecked);
}

void add_paper(Unused& unused, const BuildOptions& options) {
  unused.add(
      {"cell", "small-cell", "largest-radius", "balance-rounds", "strict-rounds", "settle-rounds"},
      kOfConsistent);
  if (options.consistent.fill) unused.add({"fill"}, kOfConsistent);
  if (!options.denoise) unused.add({"denoise-sigmas", "denoise-votes"}, "with --no-denoise");
  if (!options.resample) unused.add({"resample-density", "resample-base"}, "with --no-resample");
  if (options.method == SplatMethod::basic) {
    const std::string why = "with --method basic";
    unused.add({"smoothness", "resample-density", "resample-base"}, why);
    unused.add(kScales, why);
    if (options.resample) unused.add({"resample"}, why);
    if (options.group_normals) unused.add({"group-normals"}, why);
  } else if (options.method == SplatMethod::descriptors) {
    unused.add({"ground-scale", "surface-scale"},
               "with --method descriptors, which knows planar points alone (--planar-scale)");
  } else {
    unused.add({"planar-scale"}, "with --method semantic; it is for --method descriptors");
  }
}

}  // namespace

std::vector<UnusedOption> unused_options(const BuildOptions& options) {
  Unused unused;
  if (options.method == SplatMethod::consistent) {
    add_consistent(unused, options);
  } else {
    add_paper(unused, options);
  }
  return unused.options;
}

}  // namespace adasplats
