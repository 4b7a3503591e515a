// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/evaluate/evaluate_realism.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kEvaluateRealismExamples =
    "  adasplats evaluate realism scans sequences/01_raw\n"
    "  adasplats evaluate realism scans sequences/00 --scans 0:40 --report realism.json\n"
    "  adasplats evaluate realism scans frames --trajectory vehicle.csv\n";

constexpr const char* kRealismDefinitions =
    "AUC: how often a simulated patch of 8 x 64 beams looks more simulated than a real one, in "
    "scans\n"
    "that were not learned from: 0.5 by chance, 1 always; in brackets, of 95 % of resampled "
    "scans.\n"
    "Real, real: one of each two neighbouring real scans in place of a simulated one. Trees "
    "judge;\n"
    "logistic regression stands beside them for who develops with the trees in view. Statistics "
    "are\n"
    "means over scans, their AUC tells scans by one number. SIMULATED should be simulated at the\n"
    "poses of REAL: scans of two places differ as the places do.\n";

std::string interval_text(const std::optional<AucInterval>& test) {
  if (!test) return "-";
  return fixed(test->mean, 3) + " (" + fixed(test->low, 3) + " .. " + fixed(test->high, 3) + ")";
}

std::string tests_table(const RealismReport& report) {
  TextTable table({"AUC", "trees", "logistic", "real, real: trees", "logistic"});
  for (std::size_t t = 0; t < std::size(kRealismFeatures); ++t)
    table.add_row(
        {std::string(kRealismFeatures[t].first), interval_text(report.simulated_real.trees[t]),
         interval_text(report.simulated_real.logistic[t]), interval_text(report.real_real.trees[t]),
         interval_text(report.real_real.logistic[t])});
  return table.text();
}

/// Four digits that tell something.
std::string value_text(double value) {
  const double size = value < 0 ? -value : value;
  return fixed(value, size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 4);
}

std::string statistics_table(const RealismReport& report) {
  TextTable table({"of a scan", "real", "simulated", "AUC"});
  const auto add = [&](const std::string& name, const StatisticPair& pair) {
    table.add_row({name, value_text(pair.real), value_text(pair.simulated), fixed(pair.auc, 2)});
  };
  for (std::size_t s = 0; s < report.statistics.size(); ++s) {
    const ScanStatistic& statistic = scan_statistics()[s];
    const std::string unit = *statistic.unit == 0 ? "" : std::string(", ") + statistic.unit;
    add(statistic.text + unit, report.statistics[s]);
  }
  add("distance from planes of the next scan, median, m", report.plane_residual_m);
  return table.text();
}

class EvaluateRealismCommand final : public Command {
 public:
  explicit EvaluateRealismCommand(CLI::App& evaluate)
      : Command(evaluate, "realism", "Whether simulated scans can be told from real ones",
                kEvaluateRealismExamples) {
    OptionSet& app = options();
    require(add_path(app, "SIMULATED", job_.simulated,
                     "Simulated scans at the poses of REAL: a sequence, or a folder that "
                     "'adasplats simulate' wrote"));
    require(add_path(app, "REAL", job_.real,
                     "Measured scans of the same sensor: a sequence, or a folder of files, one a "
                     "scan"));
    add_path(app, "--trajectory", job_.trajectory,
             "Poses of a folder of files without a poses.csv in it");
    add_scan_range(app, "--scans", job_.scans, "Which scans of either side");
  }

  void run(Session& session) override {
    const Stopwatch watch;
    const RealismReport report = evaluate_realism(job_, session);
    session.report.update(to_json(report));
    session.report["seconds"]["total"] = watch.seconds();
    print(tests_table(report) + "\n" + statistics_table(report) + "\n" +
          grouped(report.simulated_real.patches) + " patches of " +
          grouped(report.simulated_scans) + " simulated and " + grouped(report.real_scans) +
          " real scans of a " + report.sensor + "\n\n" + kRealismDefinitions);
  }

 private:
  RealismJob job_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_realism_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateRealismCommand>(evaluate);
}

}  // namespace adasplats::app
