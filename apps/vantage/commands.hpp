#pragma once

#include <CLI/CLI.hpp>

namespace vantage::app {

// Each adds one subcommand to the program; see the file of that name.
void add_reconstruct(CLI::App& program);
void add_plan(CLI::App& program);
void add_doctor(CLI::App& program);
void add_config(CLI::App& program);
void add_experiment(CLI::App& program);
void add_evaluate(CLI::App& program);
void add_export(CLI::App& program);
void add_objects(CLI::App& program);
void add_recording(CLI::App& program);
void add_serve(CLI::App& program);
void add_session(CLI::App& program);
void add_view(CLI::App& program);

}  // namespace vantage::app
