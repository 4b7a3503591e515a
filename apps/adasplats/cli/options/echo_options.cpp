// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "cli/options/echo_options.h"

#include "cli/options/option_types.h"

namespace adasplats::app {

std::pair<Option*, Option*> add_echo_inputs(OptionSet& app, EchoInputs& inputs) {
  Option* model = add_path(app, "MODEL", inputs.model, "Splat model");
  Option* sequence = add_path(
      app, "SEQUENCE", inputs.sequence,
      "SemanticKITTI sequence folder; beams without return are identified from scans of an "
      "HDL-64E that are not motion-compensated");
  add_path(app, "--motion", inputs.motion,
           "Pose file or sequence with the motion of the sensor during raw scans (default: "
           "SEQUENCE, whose poses may be far apart)");
  app.add_option("--sensor", inputs.sensor, "Sensor of the raw scans")
      ->capture_default_str()
      ->type_name("NAME|FILE");
  return {model, sequence};
}

TextTable drop_table() {
  return TextTable({"beams without return", "beams", "empty", "F1", "precision", "recall"});
}

void add_drop_row(TextTable& table, const std::string& name, const DropAccuracy& drop) {
  table.add_row({name, grouped(drop.beams), grouped(drop.empty), fixed(drop.f1(), 3),
                 fixed(drop.precision(), 3), fixed(drop.recall(), 3)});
}

}  // namespace adasplats::app
