#pragma once

#include <string>

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

/// Options of `talus reproduce`.
struct ReproduceOptions {
  std::string output = ".";
  std::string measured;
  bool goals_only = false;
  bool published = false;      ///< print the published results alone
  std::string published_name;  ///< one of them; empty: all
  int soils = 500;
};

/// Registers the subcommand `reproduce` and the function `run` that executes it. The program talus-reproduce
/// passes its own `run`; in the program talus, `run` starts talus-reproduce.
void addReproduce(CLI::App& app, Context& context, int (*run)(const ReproduceOptions&, Context&));

/// Runs the program with the subcommands that the function `add` registers, and returns the exit code. Every
/// error is printed as one line to stderr.
int run(int argc, const char* const* argv, void (*add)(CLI::App&, Context&));

}  // namespace talus::cli
