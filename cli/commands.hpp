#pragma once

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

// One function a subcommand, in cli/NAME_command.cpp, built on addCommand() of cli/command.hpp.
// Alphabetical; a subcommand stands here only once it does its job.
void addCostmap(CLI::App& app, Context& context);
void addDrive(CLI::App& app, Context& context);
void addExplain(CLI::App& app, Context& context);
void addInfo(CLI::App& app, Context& context);
void addPlan(CLI::App& app, Context& context);
void addScore(CLI::App& app, Context& context);
void addUpdate(CLI::App& app, Context& context);
void addWheel(CLI::App& app, Context& context);

/// Registers every subcommand.
void addCommands(CLI::App& app, Context& context);

}  // namespace talus::cli
