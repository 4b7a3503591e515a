// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/common_options.h"
#include "cli/options/device_option.h"
#include "cli/options/option_set.h"
#include "cli/session.h"

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
  void add_common_options();

  OptionSet& options() { return options_; }
  const CommonOptions& common() const { return common_; }
  /// Nothing where the subcommand has no --device.
  const std::optional<DeviceOptions>& device() const { return device_; }
  /// Names from the program down: "evaluate c2c".
  std::string full_name() const;
  /// Throws a usage Error naming the first required option that has no value.
  void check_required() const;
  /// Throws usage where an output is an input, too, and where the name of a file says another
  /// format than is written.
  void check_outputs() const;
  /// For the help text: CLI11 marks what it knows to be required.
  void mark_required() const;

 protected:
  /// Whether the user has given an option, on the command line or in a configuration.
  bool is_given(const std::string& name) const { return options_.is_given(name); }
  /// Throws a usage Error that names the first of these options that is given: "--x has no effect "
  /// and `why`. For options that only fit some cases.
  void refuse(std::initializer_list<const char*> names, const std::string& why) const;
  /// Makes an option required; a configuration file may give it, too.
  void require(Option* option) { required_.push_back(option); }
  /// Says that an option names a file that is written, whose name ends with one of `endings`.
  Option* writes(Option* option, std::vector<std::string> endings);
  /// Says that an option names a folder that is made.
  Option* writes_folder(Option* option);
  /// Adds --device; to be called once, behind the subcommand's own options.
  void add_device_options(GpuCount count = GpuCount::one) {
    app::add_device_options(options_, device_.emplace(), count);
  }

 private:
  /// An option that names what is written; a folder has no endings.
  struct Output {
    const CLI::Option* option;
    std::vector<std::string> endings;
  };

  std::vector<std::filesystem::path> inputs() const;

  OptionSet options_;
  CommonOptions common_;
  std::optional<DeviceOptions> device_;
  std::vector<Option*> required_;
  std::vector<Output> outputs_;
};

/// Options of the program that are neither help nor one-off: what a configuration may set and a
/// report shows.
std::vector<CLI::Option*> settings_of(CLI::App& app);

}  // namespace adasplats::app
