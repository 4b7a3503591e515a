// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.h"
#include "cli/terminal.h"

namespace adasplats::app {
namespace {

class VersionCommand final : public Command {
 public:
  explicit VersionCommand(CLI::App& program)
      : Command(program, "version", "Print the version", "  adasplats version\n") {}

  void run(Session& /*session*/) override {
    print(std::string("adasplats ") + ADASPLATS_VERSION + "\n");
  }
};

}  // namespace

std::unique_ptr<Command> make_version_command(CLI::App& program) {
  return std::make_unique<VersionCommand>(program);
}

}  // namespace adasplats::app
