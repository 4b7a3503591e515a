// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common_options.h"
#include "device_option.h"
#include "session.h"

namespace adasplats::app {

/// One subcommand: its options, and what it does.
class Command {
 public:
  /// A subcommand "name" of `parent`; `examples` are the lines shown at the end of its help.
  Command(CLI::App& parent, const std::string& name, const std::string& description,
          const std::string& examples);
  virtual ~Command() = default;
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  virtual void run(Session& session) = 0;

  /// Adds --threads, --seed and so on; to be called once, behind the subcommand's own options.
  void add_common_options() { app::add_common_options(*app_, common_); }

  CLI::App& options() { return *app_; }
  const CommonOptions& common() const { return common_; }
  /// Nothing where the subcommand has no --device.
  const std::optional<DeviceOptions>& device() const { return device_; }
  /// Names from the program down: "evaluate c2c".
  std::string full_name() const;
  /// Throws a usage Error naming the first required option that has no value.
  void check_required() const;
  /// For the help text: CLI11 marks what it knows to be required.
  void mark_required() const;

 protected:
  /// Makes an option required; a configuration file may give it, too.
  void require(CLI::Option* option) { required_.push_back(option); }
  /// Adds --device; to be called once, behind the subcommand's own options.
  void add_device_options(GpuCount count = GpuCount::one) {
    app::add_device_options(*app_, device_.emplace(), count);
  }

 private:
  CLI::App* app_;
  CommonOptions common_;
  std::optional<DeviceOptions> device_;
  std::vector<CLI::Option*> required_;
};

/// Options of the program that are neither help nor one-off: what a configuration may set and a
/// report shows.
std::vector<CLI::Option*> settings_of(CLI::App& app);

}  // namespace adasplats::app
