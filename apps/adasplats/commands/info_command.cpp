// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>
#include <set>

#include "adasplats/city/city_levels.h"
#include "adasplats/city/city_manifest.h"
#include "adasplats/cloud/load/rig.h"
#include "adasplats/core/constants.h"
#include "adasplats/core/setting.h"
#include "adasplats/gpu/base/device.h"
#include "adasplats/jobs/city/city_addition.h"
#include "adasplats/jobs/session/inputs.h"
#include "cli/commands.h"
#include "cli/options/option_types.h"
#include "cli/options/shared_options.h"
#include "cli/terminal.h"
#include "cli/text_table.h"
#include "commands/info_job.h"

namespace adasplats::app {
namespace {

constexpr const char* kInfoExamples =
    "  adasplats info street/mapping.ply\n"
    "  adasplats info model.ply sequences/00 --labels semantickitti --report facts.json\n"
    "  adasplats info --devices\n";

std::string compute_capability(const GpuDevice& gpu) {
  return std::to_string(gpu.compute_major) + "." + std::to_string(gpu.compute_minor);
}

/// "driver" is the CUDA version that it supports.
nlohmann::ordered_json to_json(const GpuSearch& search) {
  nlohmann::ordered_json json = {{"devices", nlohmann::ordered_json::array()},
                                 {"driver", search.driver},
                                 {"reason", search.reason},
                                 {"built_with_cuda", built_with_cuda()}};
  for (const GpuDevice& gpu : search.devices) {
    json["devices"].push_back({{"number", gpu.index},
                               {"name", gpu.name},
                               {"memory_bytes", gpu.memory_bytes},
                               {"free_bytes", free_memory_bytes(gpu.index)},
                               {"compute_capability", compute_capability(gpu)}});
  }
  return json;
}

std::string table_of(const GpuSearch& search) {
  if (search.devices.empty()) return "no GPU: " + search.reason + "\n";
  TextTable table({"GPU", "name", "memory", "free", "compute capability", "CUDA of the driver"});
  for (const GpuDevice& gpu : search.devices) {
    const auto gibibytes = [](std::size_t bytes) {
      return fixed(static_cast<double>(bytes) / kBytesPerGiB, 1) + " GiB";
    };
    table.add_row({std::to_string(gpu.index), gpu.name, gibibytes(gpu.memory_bytes),
                   gibibytes(free_memory_bytes(gpu.index)), compute_capability(gpu),
                   search.driver});
  }
  return table.text();
}

std::string table_of(const std::filesystem::path& input, const FileFacts& facts) {
  // Values are texts of any length: flush left, unlike a TextTable's numbers.
  std::string text = input.string() + ": " + facts.kind + "\n";
  std::size_t width = 0;
  for (const auto& [what, value] : facts.rows) width = std::max(width, what.size());
  for (const auto& [what, value] : facts.rows) {
    text += "  " + what + std::string(width - what.size() + 2, ' ') +
            with_settings_as_options(value) + "\n";
  }
  if (facts.classes.empty()) return text;
  TextTable classes({"  class", "count"});
  for (const auto& [name, count] : facts.classes) classes.add_row({"  " + name, grouped(count)});
  return text + classes.text();
}

class InfoCommand final : public Command {
 public:
  explicit InfoCommand(CLI::App& program)
      : Command(program, "info", "Describe a file or a recording, or list the GPUs",
                kInfoExamples) {
    OptionSet& app = options();
    add_paths(app, "FILE", inputs_,
              "Files, sequence folders and recordings (default: as --devices)");
    app.add_flag("--devices", devices_,
                 "List the GPUs of this machine, or the reason why none is usable");
    app.add_flag("--verify", verify_, "Check the SHA-256 of every tile and all points of a city");
    add_labels_option(app, labels_, "numbers only");
    add_load_options(app, load_);
  }

  void run(Session& session) override {
    if (inputs_.empty()) {
      reject({"--labels", "--verify"}, "without a file");
      const std::string option = given_load_option(options());
      if (!option.empty()) reject({option.c_str()}, "without a file");
    }
    session.report["files"] = nlohmann::ordered_json::array();
    std::string text;
    if (devices_ || inputs_.empty()) {
      const GpuSearch search = find_gpus();
      session.report["gpus"] = to_json(search);
      text = table_of(search);
    }
    std::set<std::string> kinds;
    for (const std::filesystem::path& input : all_inputs()) {
      if (verify_ && is_city(input)) {
        const CityManifest city = load_city_manifest(input);
        verify_city(input, city);
        verify_layers(input);
        if (has_levels(input)) CityLevels(input, city).verify();
      }
      for (const FileFacts& facts : is_rig(input)
                                        ? run_rig_info(input, labels_, load_, session)
                                        : std::vector{run_info(input, labels_, load_, session)}) {
        kinds.insert(facts.kind);
        nlohmann::ordered_json json = {{"path", input.string()}, {"kind", facts.kind}};
        json.update(facts.json);
        session.report["files"].push_back(std::move(json));
        text += (text.empty() ? "" : "\n") + table_of(input, facts);
      }
    }
    refuse_what_does_not_fit(kinds);
    print(text);
  }

 private:
  /// Rejects options that have no effect on inputs of these kinds.
  void refuse_what_does_not_fit(const std::set<std::string>& kinds) {
    if (kinds.empty() || kinds.contains("capture")) return;
    const std::string why = "on a " + *kinds.begin();
    if (!kinds.contains("city of splats")) reject({"--verify"}, why);
    if (!kinds.contains("recording")) reject({"--packet-sensor"}, why);
    if (kinds.contains("point cloud") || kinds.contains("folder of scans") ||
        kinds.contains("recording") || kinds.contains("PandaSet sequence") ||
        kinds.contains("nuScenes scene") || kinds.contains("Argoverse 2 log") ||
        kinds.contains("sensor of a rig"))
      return;
    reject(
        {"--label-field", "--sensor-fields", "--viewpoint", "--trajectory", "--mount",
         "--mount-rotation", "--time-offset", "--max-distance", "--beams-from-poses", "--salvage",
         "--scene", "--topic", "--poses-topic", "--extent", "--level", "--resolution"},
        why);
    if (!kinds.contains("sequence")) reject({"--scans", "--strict"}, why);
  }

  /// The inputs, with trees replaced by their sequences.
  std::vector<std::filesystem::path> all_inputs() const {
    std::vector<std::filesystem::path> all;
    for (const std::filesystem::path& input : inputs_) {
      if (is_city(input) || is_rig(input)) {
        all.push_back(input);
        continue;
      }
      for (const std::filesystem::path& one : resolve_cloud_inputs(input)) all.push_back(one);
    }
    return all;
  }

  std::vector<std::filesystem::path> inputs_;
  bool devices_ = false;
  bool verify_ = false;
  std::string labels_;
  LoadOptions load_;
};

}  // namespace

std::unique_ptr<Command> make_info_command(CLI::App& program) {
  return std::make_unique<InfoCommand>(program);
}

}  // namespace adasplats::app
