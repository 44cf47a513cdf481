#include <cli/commands.hpp>

namespace talus::cli {

void addCommands(CLI::App& app, Context& context) {
  addInfo(app, context);
  addPredict(app, context);
  addTrace(app, context);
  addWheel(app, context);
}

}  // namespace talus::cli
