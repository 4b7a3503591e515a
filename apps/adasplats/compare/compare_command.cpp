// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "adasplats/core/constants.h"
#include "adasplats/core/error.h"
#include "adasplats/pipeline/provenance/machine.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "compare/compare_job.h"
#include "compare/steps.h"

namespace adasplats::app {
namespace {

constexpr double kMostBytes = 1e18;   // fits into what the limit is kept in
constexpr double kMemoryShare = 0.9;  // of the machine's, where the user gives no limit
constexpr int kDeepestOctree = 16;

constexpr const char* kCompareExamples =
    "  adasplats compare street -o street-comparison\n"
    "  adasplats compare sequences/00 -o kitti --methods basic,descriptors,poisson\n"
    "  adasplats compare Paris --preset paper-pc3d -o pc3d\n"
    "  adasplats compare scan.ply --mesh artist=city.obj -o city\n"
    "An interrupted comparison goes on where it stopped when it is started again.";

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// The figure at a path of keys, or NaN.
double number_at(const nlohmann::ordered_json& json, const std::string& pointer) {
  const nlohmann::ordered_json value =
      json.value(nlohmann::ordered_json::json_pointer(pointer), nlohmann::ordered_json());
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string with_unit(double number, int digits, const char* unit) {
  return std::isnan(number) ? "-" : fixed(number, digits) + " " + unit;
}

/// One line for each competitor that failed.
std::string failures_of(const nlohmann::ordered_json& results) {
  std::string lines;
  for (const auto& entry : results["competitors"]) {
    if (entry["state"] == "done") continue;
    lines += entry["name"].get<std::string>() + ": " + entry["failed_step"].get<std::string>() +
             ": " + entry["message"].get<std::string>() + "\n";
  }
  return lines;
}

std::string table_of(const nlohmann::ordered_json& results) {
  TextTable table(
      {"model", "state", "primitives", "generate", "C2C", "within 10 cm", "early", "no hit"});
  for (const auto& entry : results["competitors"]) {
    table.add_row({entry["name"], entry["state"],
                   with_unit(number_at(entry, "/generate/primitives") * 1e-6, 2, "M"),
                   with_unit(number_at(entry, "/generate/seconds"), 1, "s"),
                   centimetres(number_at(entry, "/c2c/c2c_m")),
                   percent(number_at(entry, "/resimulate/within/0.10")),
                   percent(number_at(entry, "/resimulate/early_50cm")),
                   percent(number_at(entry, "/resimulate/no_hit"))});
  }
  return table.text();
}

class CompareCommand final : public Command {
 public:
  explicit CompareCommand(CLI::App& program)
      : Command(program, "compare", "Compare all methods on the same data with the same rays",
                kCompareExamples) {
    OptionSet& app = options();
    require(add_path(app, "DATA", job_.data,
                     "Output of 'synth street', SemanticKITTI folder, or point files"));
    require(writes_folder(
        add_path(app, "-o,--output", job_.output, "Folder for the reports and the work")));
    add_choice<Preset>(app, "--preset", job_.preset,
                       {{"none", Preset::none},
                        {"paper-pc3d", Preset::paper_pc3d},
                        {"paper-kitti", Preset::paper_kitti},
                        {"paper-mcity", Preset::paper_mcity}},
                       "DATA is a data set of the paper as its authors ship it");
    app.add_option("--methods", job_.methods, "Some of " + joined(compare_method_names()))
        ->delimiter(',')
        ->type_name("NAME,...");
    app.add_option_function<std::vector<std::string>>(
           "--mesh", [this](const std::vector<std::string>& given) { set_meshes(given); },
           "Also a ready-made mesh, PLY or OBJ")
        ->type_name("NAME=FILE");
    add_data_options(app);
    add_limit_options(app);
    add_device_options();
  }

  void run(Session& session) override {
    const auto& methods = job_.methods;
    if (!methods.empty() && std::find(methods.begin(), methods.end(), "poisson") == methods.end()) {
      refuse({"--poisson-depth"}, "without the method poisson");
    }
    job_.steps.limits.memory_bytes = memory_limit_bytes();
    job_.steps.common_arguments = common_arguments();
    if (device()->kind != DeviceKind::automatic) {
      job_.device_arguments = {"--device", device_word(device()->kind)};
    }
    const nlohmann::ordered_json results = run_compare(job_, session);
    session.report["results"] = results;
    print(table_of(results) + "\n" + failures_of(results) + (job_.output / "report.html").string() +
          "\n");
  }

 private:
  std::uint64_t memory_limit_bytes() const {
    if (!(memory_gib_ >= 0)) throw Error(ErrorKind::usage, "--memory-limit must not be negative");
    const double bytes = memory_gib_ > 0
                             ? std::max(1.0, memory_gib_ * kBytesPerGiB)
                             : kMemoryShare * static_cast<double>(usable_memory_bytes());
    return static_cast<std::uint64_t>(std::min(bytes, kMostBytes));
  }

  /// What the steps are told as well, where the user has said it.
  std::vector<std::string> common_arguments() const {
    std::vector<std::string> arguments;
    const CommonOptions defaults;
    if (common().threads != defaults.threads) {
      arguments.insert(arguments.end(), {"--threads", std::to_string(common().threads)});
    }
    if (common().seed != defaults.seed) {
      arguments.insert(arguments.end(), {"--seed", std::to_string(common().seed)});
    }
    return arguments;
  }

  void add_data_options(OptionSet& app) {
    OptionSet& group = app.add_group("Data", "instead of what is found in DATA");
    group.add_option("--labels", job_.labels, "semantickitti, paris-carla-3d or a TOML file")
        ->type_name("SCHEME");
    group.add_option("--scans", job_.scans, "Which scans of a sequence")
        ->type_name("FIRST:COUNT[:STRIDE]");
    add_path(group, "--trajectory", job_.trajectory, "Poses of the recording");
    add_vector(group, "--offset", job_.offset_m, "Shift of the trajectory in world axes, m");
    group.add_option("--every", job_.every, "Take every n-th pose; 0: at most 20 poses")
        ->capture_default_str()
        ->type_name("N");
    add_path(group, "--held-out", job_.held_out, "Sequence whose beams are cast again");
    group.add_option("--held-out-scans", job_.held_out_scans, "Which scans of that")
        ->type_name("FIRST:COUNT[:STRIDE]");
    add_path(group, "--truth", job_.truth, "Mesh of the true surface");
    group.add_option("--sensor", job_.sensor, "As simulate has it")
        ->capture_default_str()
        ->type_name("NAME|FILE");
    add_choice<std::optional<DynamicRemoval>>(
        group, "--remove", job_.remove,
        {{"none", DynamicRemoval::none},
         {"moving", DynamicRemoval::moving},
         {"movable", DynamicRemoval::movable}},
        "Objects to leave out of the points, the beams and the rays, by their labels; the default "
        "is what the paper removes: movable, with --preset paper-mcity none");
    add_picture_width(group, job_.picture_width);
    group.add_option("--poisson-depth", job_.poisson_depth, "Depth of the octree")
        ->range(1, kDeepestOctree)
        ->capture_default_str()
        ->type_name("N");
  }

  void add_limit_options(OptionSet& app) {
    OptionSet& group = app.add_group("Limits", "of every step");
    group.add_option("--time-limit", job_.steps.limits.seconds, "Seconds")
        ->capture_default_str()
        ->type_name("S");
    group.add_option("--memory-limit", memory_gib_, "GiB; 0: 90 % of the machine's")
        ->capture_default_str()
        ->type_name("GIB");
    group.add_flag("--retry", job_.steps.retry, "Run steps again that failed");
  }

  void set_meshes(const std::vector<std::string>& given) {
    for (const std::string& text : given) {
      const std::size_t at = text.find('=');
      const std::string name = text.substr(0, at);
      const bool plain = !name.empty() &&
                         name.find_first_not_of(
                             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_") ==
                             std::string::npos;
      if (at == std::string::npos || at + 1 == text.size() || !plain) {
        refuse_value("--mesh", "'" + text +
                                   "' is not NAME=FILE (NAME of letters, "
                                   "digits, - and _)");
      }
      job_.meshes.emplace_back(name, text.substr(at + 1));
    }
  }

  CompareJob job_;
  double memory_gib_ = 0;
};

}  // namespace

std::unique_ptr<Command> make_compare_command(CLI::App& program) {
  return std::make_unique<CompareCommand>(program);
}

}  // namespace adasplats::app
