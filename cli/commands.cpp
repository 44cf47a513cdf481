#include <cli/commands.hpp>

namespace talus::cli {

void addCommands(CLI::App& app, Context& context) {
  addAssess(app, context);
  addEstimate(app, context);
  addInfo(app, context);
  addPlan(app, context);
  addReproduce(app, context);
  addScore(app, context);
  addWheel(app, context);
}

}  // namespace talus::cli
