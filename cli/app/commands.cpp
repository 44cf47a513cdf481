#include <initializer_list>

#include <talus/cli/app/commands.hpp>

namespace talus::cli {

void addCommands(CLI::App& app, Context& context) {
  for (AddCommand* add : std::initializer_list<AddCommand*>{
           addAssess,  addBench,     addCheck, addCostmap, addDoctor, addDrive, addEstimate,
           addExplain, addGenerate,  addHelp,  addInfo,    addInit,   addPlan,  addPlugins,
           addPredict, addReproduce, addScore, addTrace,   addUpdate, addView,  addWheel})
    add(app, context);
}

}  // namespace talus::cli
