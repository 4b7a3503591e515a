// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/common_options.h"

#include "cli/options/option_types.h"

namespace adasplats::app {

void add_common_options(OptionSet& app, CommonOptions& options) {
  constexpr const char* kGroup = "Common options";
  constexpr int kMaxThreads = 4096;
  app.add_version_flag("--version", std::string("adasplats ") + ADASPLATS_VERSION,
                       "Print the version and exit")
      ->group(kGroup);
  app.add_option("--threads", options.threads, "Threads; 0: all that the process may use")
      ->range(0, kMaxThreads)
      ->capture_default_str()
      ->type_name("N")
      ->group(kGroup);
  app.add_option("--seed", options.seed, "Seed of all random numbers")
      ->capture_default_str()
      ->type_name("N")
      ->group(kGroup);
  add_path(app, "--report", options.report, "Write parameters, counts and timings as JSON")
      ->group(kGroup);
  add_path(app, "--config", options.config,
           "TOML file that sets flags: keys are long flag names, at the top or in a table named "
           "after the subcommand; the command line wins")
      ->group(kGroup);
}

}  // namespace adasplats::app
