#include <cli/commands.hpp>

namespace talus::cli {

void addCommands(CLI::App& app, Context& context) {
  addCostmap(app, context);
  addDrive(app, context);
  addExplain(app, context);
  addInfo(app, context);
  addPlan(app, context);
  addScore(app, context);
  addUpdate(app, context);
  addWheel(app, context);
}

}  // namespace talus::cli
