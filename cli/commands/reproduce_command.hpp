#pragma once

#include <string>

namespace CLI {
class App;
}

namespace talus::cli {

struct Context;

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

}  // namespace talus::cli
