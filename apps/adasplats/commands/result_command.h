// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "adasplats/core/stopwatch.h"
#include "cli/commands.h"
#include "cli/terminal.h"

namespace adasplats::app {

/// A subcommand with one result: prints it and adds it, with the time taken, to the report.
class ResultCommand : public Command {
 public:
  using Command::Command;

  void run(Session& session) final {
    const Stopwatch watch;
    const std::string text = make_result(session);
    session.report["seconds"]["total"] = watch.seconds();
    print(text);
  }

 private:
  /// Adds the result's keys to the report and returns its text.
  virtual std::string make_result(Session& session) = 0;
};

}  // namespace adasplats::app
