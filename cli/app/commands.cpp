#include <talus/cli/app/commands.hpp>

namespace talus::cli {

void addCommands(CLI::App& app, Context& context) {
  addAssess(app, context);
  addBench(app, context);
  addCheck(app, context);
  addCostmap(app, context);
  addDoctor(app, context);
  addDrive(app, context);
  addEstimate(app, context);
  addExplain(app, context);
  addGenerate(app, context);
  addHelp(app, context);
  addInfo(app, context);
  addInit(app, context);
  addPlan(app, context);
  addPlugins(app, context);
  addPredict(app, context);
  addReproduce(app, context);
  addScore(app, context);
  addTrace(app, context);
  addUpdate(app, context);
  addView(app, context);
  addWheel(app, context);
}

}  // namespace talus::cli
