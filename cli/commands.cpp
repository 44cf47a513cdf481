#include <cli/commands.hpp>

namespace talus::cli {

void addCommands(CLI::App& app, Context& context) {
  addBench(app, context);
  addInfo(app, context);
  addPlan(app, context);
  addPlugins(app, context);
  addScore(app, context);
  addWheel(app, context);
}

}  // namespace talus::cli
