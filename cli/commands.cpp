#include <cli/commands.hpp>

namespace talus::cli {

void addCommands([[maybe_unused]] CLI::App& app, [[maybe_unused]] Context& context) {}

}  // namespace talus::cli
