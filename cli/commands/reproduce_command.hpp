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
  int soils = 500;
};

/// Registers the subcommand `reproduce` with the function `run` that executes it. addReproduce() of
/// commands.hpp starts the program talus-reproduce, and that program passes its own function.
void addReproduce(CLI::App& app, Context& context, int (*run)(const ReproduceOptions&, Context&));

}  // namespace talus::cli
