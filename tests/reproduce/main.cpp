// talus-reproduce: takes the words of `talus` with its one call `reproduce`. `talus reproduce` starts it.
#include <talus/cli/app/commands.hpp>

#include "validation_page.hpp"

int main(int argc, char** argv) {
  return talus::cli::run(argc, argv, [](CLI::App& app, talus::cli::Context& context) {
    talus::cli::addReproduce(app, context, talus::reproduce::run);
  });
}
