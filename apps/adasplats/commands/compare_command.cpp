// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/jobs/compare/compare.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/setting_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"

namespace adasplats::app {
namespace {

// Remains the running program even if its file is replaced meanwhile.
constexpr const char* kOwnProgram = "/proc/self/exe";

constexpr const char* kCompareExamples =
    "  adasplats compare street -o street-comparison\n"
    "  adasplats compare sequences/00 -o kitti --methods basic,descriptors,poisson\n"
    "  adasplats compare Paris --preset paper-pc3d -o pc3d\n"
    "  adasplats compare scan.ply --mesh artist=city.obj -o city\n"
    "Run an interrupted comparison again to resume it.";

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

/// The number at a JSON pointer, or NaN.
double number_at(const nlohmann::ordered_json& json, const std::string& pointer) {
  const nlohmann::ordered_json value =
      json.value(nlohmann::ordered_json::json_pointer(pointer), nlohmann::ordered_json());
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string with_unit(double number, int digits, const char* unit) {
  return std::isnan(number) ? "-" : fixed(number, digits) + " " + unit;
}

/// The competitors that failed, and the picture of the points if it did.
std::vector<nlohmann::ordered_json> failed_rows(const nlohmann::ordered_json& results) {
  std::vector<nlohmann::ordered_json> rows;
  for (const auto& entry : results["competitors"])
    if (entry["state"] != "done") rows.push_back(entry);
  if (results["original"].contains("failed_step")) {
    rows.push_back(results["original"]);
    rows.back()["name"] = "original";
  }
  return rows;
}

std::string failures_of(const nlohmann::ordered_json& results) {
  std::string lines;
  for (const auto& entry : failed_rows(results)) {
    lines += entry["name"].get<std::string>() + ": " + entry["failed_step"].get<std::string>() +
             ": " + entry["message"].get<std::string>() + "\n";
  }
  return lines;
}

/// Errors: data (a row has an error).
void require_no_error(const nlohmann::ordered_json& results) {
  std::string names;
  for (const auto& entry : failed_rows(results))
    if (entry["is_error"]) names += (names.empty() ? "" : ", ") + entry["name"].get<std::string>();
  if (!names.empty())
    throw Error(ErrorKind::data, "some rows of the comparison failed by an error: " + names +
                                     " (--retry runs them again)");
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
        add_path(app, "-o,--output", job_.output, "Folder for reports and intermediate files")));
    add_choice<Preset>(app, "--preset", job_.preset, choices_of<Preset>(kPresets),
                       "Treat DATA as a data set of the paper, in the layout of its authors");
    app.add_option("--methods", job_.methods,
                   "Methods to compare, some of " + joined(compare_method_names()))
        ->delimiter(',')
        ->type_name("NAME,...");
    app.add_option_function<std::vector<std::string>>(
           "--mesh", [this](const std::vector<std::string>& given) { set_meshes(given); },
           "Also compare an existing mesh, PLY or OBJ")
        ->type_name("NAME=FILE");
    add_data_options(app);
    add_device_options();
  }

  void run(Session& session) override {
    for (const UnusedSetting& unused : unused_settings(job_)) {
      reject({option_of(unused.setting).c_str()}, unused.why);
    }
    job_.program = kOwnProgram;
    job_.threads = common().threads;
    job_.seed = common().seed;
    job_.device = device()->kind;
    const nlohmann::ordered_json results = run_compare(job_, session);
    session.report["results"] = results;
    print(table_of(results) + "\n" + failures_of(results) + (job_.output / "report.html").string() +
          "\n");
    require_no_error(results);
  }

 private:
  void add_data_options(OptionSet& app) {
    OptionSet& group = app.add_group("Data", "overrides what is found in DATA");
    group
        .add_option(
            "--labels", job_.labels,
            "Label scheme: semantickitti, paris-carla-3d, pandaset, nuscenes, asprs or a TOML "
            "file")
        ->type_name("SCHEME");
    add_scan_range(group, "--scans", job_.scans, "Scans of a sequence to use");
    add_path(group, "--trajectory", job_.trajectory, "Poses of the recording");
    add_vector(group, "--offset", job_.offset_m, "Shift of the trajectory in world axes, m");
    add_path(group, "--held-out", job_.held_out, "Sequence whose beams are cast again");
    add_scan_range(group, "--held-out-scans", job_.held_out_scans,
                   "Scans of the held-out sequence to use");
    add_path(group, "--truth", job_.truth, "Mesh of the true surface");
    group.add_option("--sensor", job_.sensor, "Sensor; see 'adasplats sensors'")
        ->capture_default_str()
        ->type_name("NAME|FILE");
    add_choice<std::optional<DynamicRemoval>>(
        group, "--remove", job_.remove, choices_of_optional(kDynamicRemovals),
        "Objects to leave out of points, beams and rays, by their labels; the default is that of "
        "the paper: movable, with --preset paper-mcity none");
    add_settings(group, job_);
    add_settings(app.add_group("Limits", "of every step"), job_.limits);
  }

  void set_meshes(const std::vector<std::string>& given) {
    for (const std::string& text : given) {
      const std::size_t at = text.find('=');
      if (at == 0 || at == std::string::npos || at + 1 == text.size()) {
        reject_value("--mesh", "'" + text + "' is not NAME=FILE");
      }
      job_.meshes.emplace_back(text.substr(0, at), text.substr(at + 1));
    }
  }

  CompareJob job_;
};

}  // namespace

std::unique_ptr<Command> make_compare_command(CLI::App& program) {
  return std::make_unique<CompareCommand>(program);
}

}  // namespace adasplats::app
