// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "adasplats/core/error.h"
#include "adasplats/core/stopwatch.h"
#include "adasplats/jobs/evaluate/evaluate_echoes.h"
#include "adasplats/jobs/output/output_folder.h"
#include "cli/commands.h"
#include "cli/options/echo_options.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kFitDropExamples =
    "  adasplats fit-drop place.ply sequences/01_raw --motion sequences/00 -o drop.toml --every 2\n"
    "  adasplats evaluate echoes place.ply sequences/01_raw --motion sequences/00 \\\n"
    "    --drop drop.toml --scans 1:4:2\n";

class FitDropCommand final : public Command {
 public:
  explicit FitDropCommand(CLI::App& program)
      : Command(program, "fit-drop", "Learn from raw scans which beams tell nothing",
                kFitDropExamples) {
    OptionSet& app = options();
    const auto [model, sequence] = add_echo_inputs(app, inputs_);
    require(model);
    require(sequence);
    require(writes(add_path(app, "-o,--output", output_, "Drop model to write, TOML"), {".toml"}));
    app.add_option("--every", every_, "Takes every n-th scan, to keep others for a test")
        ->capture_default_str();
    add_device_options();
  }

  void run(Session& session) override {
    const Stopwatch watch;
    if (every_ == 0) throw Error(ErrorKind::usage, "--every is 0, expected 1 or more");
    inputs_.scans.stride = every_;
    check_output_file(output_);
    const FitDropResult result = fit_drop(inputs_, session);
    save_ray_drop(output_, result.model);
    session.report.update(to_json(result));
    session.report["seconds"]["total"] = watch.seconds();
    TextTable table = drop_table();
    add_drop_row(table, "misses alone", result.misses);
    add_drop_row(table, "with the drop model", result.drop);
    print(table.text() + "\n" + output_.string() + ": from " + grouped(result.scans) + " scans, " +
          grouped(result.model.blocked.size()) +
          " blocked sectors; judge it by scans that it was not fitted to\n");
  }

 private:
  EchoInputs inputs_;
  std::filesystem::path output_;
  std::size_t every_ = 1;
};

}  // namespace

std::unique_ptr<Command> make_fit_drop_command(CLI::App& program) {
  return std::make_unique<FitDropCommand>(program);
}

}  // namespace adasplats::app
