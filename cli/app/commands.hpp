#pragma once

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

// One function per subcommand, in alphabetical order, registers the subcommand. Each function is defined in
// cli/commands/NAME_command.cpp and uses addCommand() of cli/app/command.hpp.
void addAssess(CLI::App& app, Context& context);
void addBench(CLI::App& app, Context& context);
void addCheck(CLI::App& app, Context& context);
void addCostmap(CLI::App& app, Context& context);
void addDoctor(CLI::App& app, Context& context);
void addDrive(CLI::App& app, Context& context);
void addEstimate(CLI::App& app, Context& context);
void addExplain(CLI::App& app, Context& context);
void addGenerate(CLI::App& app, Context& context);
void addHelp(CLI::App& app, Context& context);
void addInfo(CLI::App& app, Context& context);
void addInit(CLI::App& app, Context& context);
void addPlan(CLI::App& app, Context& context);
void addPlugins(CLI::App& app, Context& context);
void addPredict(CLI::App& app, Context& context);
void addReproduce(CLI::App& app, Context& context);
void addScore(CLI::App& app, Context& context);
void addTrace(CLI::App& app, Context& context);
void addUpdate(CLI::App& app, Context& context);
void addView(CLI::App& app, Context& context);
void addWheel(CLI::App& app, Context& context);

/// Registers every subcommand.
void addCommands(CLI::App& app, Context& context);

}  // namespace talus::cli
