// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "cli/command.h"

namespace adasplats::app {

std::unique_ptr<Command> make_synth_street_command(CLI::App& synth);
std::unique_ptr<Command> make_synth_world_command(CLI::App& synth);
std::unique_ptr<Command> make_synth_city_command(CLI::App& synth);
std::unique_ptr<Command> make_info_command(CLI::App& program);
std::unique_ptr<Command> make_model_command(CLI::App& program);
std::unique_ptr<Command> make_calibrate_command(CLI::App& program);
std::unique_ptr<Command> make_segment_command(CLI::App& program);
std::unique_ptr<Command> make_mesh_command(CLI::App& program);
std::unique_ptr<Command> make_simulate_command(CLI::App& program);
std::unique_ptr<Command> make_render_command(CLI::App& program);
/// All of them, in the order of the help.
std::vector<std::unique_ptr<Command>> make_evaluate_commands(CLI::App& evaluate);
std::unique_ptr<Command> make_evaluate_echoes_command(CLI::App& evaluate);
std::unique_ptr<Command> make_evaluate_unit_command(CLI::App& evaluate);
std::unique_ptr<Command> make_simkitti32_command(CLI::App& program);
std::unique_ptr<Command> make_fit_drop_command(CLI::App& program);
std::unique_ptr<Command> make_fit_sensor_command(CLI::App& program);
std::unique_ptr<Command> make_sensors_command(CLI::App& program);
std::unique_ptr<Command> make_compare_command(CLI::App& program);
std::unique_ptr<Command> make_view_command(CLI::App& program);
std::unique_ptr<Command> make_serve_sensor_command(CLI::App& program);
std::unique_ptr<Command> make_export_command(CLI::App& program);
std::unique_ptr<Command> make_send_command(CLI::App& program);
std::unique_ptr<Command> make_demo_command(CLI::App& program);
std::unique_ptr<Command> make_help_command(CLI::App& program);
std::unique_ptr<Command> make_version_command(CLI::App& program);
std::unique_ptr<Command> make_completion_command(CLI::App& program);
std::unique_ptr<Command> make_man_command(CLI::App& program);

}  // namespace adasplats::app
