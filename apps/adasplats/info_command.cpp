// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "commands.h"
#include "info_job.h"
#include "load_options.h"
#include "option_types.h"
#include "terminal.h"
#include "text_table.h"

namespace adasplats::app {
namespace {

constexpr const char* kExamples =
    "  adasplats info street/mapping.ply\n"
    "  adasplats info model.ply sequences/00 --labels semantickitti --report facts.json\n";

std::string table_of(const std::filesystem::path& input, const FileFacts& facts) {
  // Values are texts of any length: flush left, unlike a TextTable's numbers.
  std::string text = input.string() + ": " + facts.kind + "\n";
  std::size_t width = 0;
  for (const auto& [what, value] : facts.rows) width = std::max(width, what.size());
  for (const auto& [what, value] : facts.rows) {
    text += "  " + what + std::string(width - what.size() + 2, ' ') + value + "\n";
  }
  if (facts.classes.empty()) return text;
  TextTable classes({"  class", "count"});
  for (const auto& [name, count] : facts.classes) classes.add_row({"  " + name, grouped(count)});
  return text + classes.text();
}

class InfoCommand final : public Command {
 public:
  explicit InfoCommand(CLI::App& program)
      : Command(program, "info", "Say what point clouds, models, meshes and sequences hold",
                kExamples) {
    CLI::App& app = options();
    require(app.add_option_function<std::vector<std::string>>(
                   "FILE",
                   [this](const std::vector<std::string>& names) {
                     inputs_.assign(names.begin(), names.end());
                   },
                   "Files and sequence folders")
                ->type_name("PATH"));
    app.add_option("--labels", labels_,
                   "Names the classes: semantickitti, paris-carla-3d or a TOML file")
        ->type_name("SCHEME");
    add_load_options(app, load_);
  }

  void run(Session& session) override {
    session.report["files"] = nlohmann::ordered_json::array();
    std::string text;
    for (const std::filesystem::path& input : inputs_) {
      const FileFacts facts = run_info(input, labels_, load_, session);
      nlohmann::ordered_json json = {{"path", input.string()}, {"kind", facts.kind}};
      json.update(facts.json);
      session.report["files"].push_back(std::move(json));
      text += (text.empty() ? "" : "\n") + table_of(input, facts);
    }
    print(text);
  }

 private:
  std::vector<std::filesystem::path> inputs_;
  std::string labels_;
  LoadOptions load_;
};

}  // namespace

std::unique_ptr<Command> make_info_command(CLI::App& program) {
  return std::make_unique<InfoCommand>(program);
}

}  // namespace adasplats::app
