#pragma once

#include <string>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

// One function per subcommand, in alphabetical order, registers the subcommand. Each function is defined in
// cli/commands/NAME_command.cpp and uses addCommand() of cli/app/command.hpp.
using AddCommand = void(CLI::App& app, Context& context);
AddCommand addAssess, addBench, addCheck, addCostmap, addDoctor, addDrive, addEstimate, addExplain,
    addGenerate, addHelp, addInfo, addInit, addPlan, addPlugins, addPredict, addReproduce, addScore, addTrace,
    addUpdate, addView, addWheel;

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
int run(int argc, const char* const* argv, AddCommand* add);

}  // namespace talus::cli
