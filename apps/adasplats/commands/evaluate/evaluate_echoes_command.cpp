// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/evaluate/evaluate_echoes.h"
#include "cli/commands.h"
#include "cli/options/echo_options.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kEvaluateEchoesExamples =
    "  adasplats evaluate echoes place.ply sequences/01\n"
    "  adasplats evaluate echoes place.ply sequences/01_raw --motion sequences/00 \\\n"
    "    --drop drop.toml --scans 1:4:2\n";

std::string text_of(const EchoResult& result) {
  const IntensityAccuracy& intensity = result.intensity;
  std::string text = "intensity: rank correlation " + fixed(intensity.rank_correlation, 3) +
                     ", mean absolute error " + fixed(intensity.mae, 3) + " of " +
                     grouped(intensity.rays) + " beams\n";
  if (!result.misses) return text;
  TextTable table = drop_table();
  add_drop_row(table, "misses alone", *result.misses);
  if (result.drop) add_drop_row(table, "with the drop model", *result.drop);
  if (result.unblocked) add_drop_row(table, "the same, not blocked", *result.unblocked);
  return text + "\n" + table.text();
}

class EvaluateEchoesCommand final : public Command {
 public:
  explicit EvaluateEchoesCommand(CLI::App& evaluate)
      : Command(evaluate, "echoes",
                "Compare intensities, and which beams find nothing, with held-out scans",
                kEvaluateEchoesExamples) {
    OptionSet& app = options();
    const auto [model, sequence] = add_echo_inputs(app, inputs_);
    require(model);
    require(sequence);
    add_path(app, "--drop", drop_, "Drop model that fit-drop made from other scans");
    add_scan_range(app, "--scans", inputs_.scans, "Which scans of the sequence");
    add_device_options();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    inputs_.sensor_is_asked = is_given("--sensor");
    const EchoResult result = evaluate_echoes(inputs_, drop_, session);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    print(text_of(result));
  }

 private:
  EchoInputs inputs_;
  std::filesystem::path drop_;
};

}  // namespace

std::unique_ptr<Command> make_evaluate_echoes_command(CLI::App& evaluate) {
  return std::make_unique<EvaluateEchoesCommand>(evaluate);
}

}  // namespace adasplats::app
