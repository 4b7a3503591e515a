// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/option_set.h"
#include "cli/options/shared_options.h"
#include "cli/session.h"

namespace adasplats::app {

/// One subcommand: its options and its action.
class Command {
 public:
  /// A subcommand "name" of `parent`. `examples`: commands, indented by two columns, and notes
  /// without indent, for the end of its help.
  Command(CLI::App& parent, const std::string& name, const std::string& description,
          const std::string& examples);
  virtual ~Command() = default;
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  virtual void run(Session& session) = 0;

  /// Adds --threads, --seed and so on; to be called once, after the subcommand's own options.
  void add_common_options();

  OptionSet& options() { return options_; }
  const OptionSet& options() const { return options_; }
  const CommonOptions& common() const { return common_; }
  /// Empty if the subcommand has no --device.
  const std::optional<DeviceOptions>& device() const { return device_; }
  /// Names below the program: "evaluate c2c".
  std::string full_name() const;
  /// Throws a usage Error naming the first required option that has no value.
  void check_required() const;
  /// Throws usage if an output is also an input, or if the name of an output file has the ending of
  /// another format.
  void check_outputs() const;
  /// Marks required options in the parser, for help.
  void mark_required() const;

 protected:
  /// Whether the user has given an option, on the command line or in a configuration.
  bool is_given(const std::string& name) const { return options_.is_given(name); }
  /// Throws a usage Error if one of these options is given: "--x has no effect " and `why`. For
  /// options that only apply in some cases.
  void reject(std::initializer_list<const char*> names, const std::string& why) const;
  /// Makes an option required, on the command line or in a configuration file.
  void require(Option* option) { required_.push_back(option); }
  /// Marks an option as the name of an output file, which must end with one of `endings`.
  Option* writes(Option* option, std::vector<std::string> endings);
  /// Marks an option as the name of an output folder.
  Option* writes_folder(Option* option);
  /// Adds --device; to be called once, after the subcommand's own options.
  void add_device_options(GpuCount count = GpuCount::one) {
    app::add_device_options(options_, device_.emplace(), count);
  }

 private:
  /// An option that names an output; folders have no endings.
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

/// The options that a configuration may set and a report shows: all but help, version and
/// configuration.
std::vector<CLI::Option*> settings_of(CLI::App& app);

}  // namespace adasplats::app
