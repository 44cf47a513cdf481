// talus help [TOPIC]: formats of files, or the help of a call.
#include <nlohmann/json.hpp>

#include <talus/cli/app/command.hpp>
#include <talus/cli/app/commands.hpp>
#include <talus/cli/ground/file_formats.hpp>
#include <talus/common/input_error.hpp>
#include <talus/common/nearest_name.hpp>

namespace talus::cli {
namespace {

struct HelpOptions {
  std::string topic;
  const CLI::App* command = nullptr;
};

void bind(CLI::App& command, HelpOptions& options) {
  command.add_option("TOPIC", options.topic, "formats: keys and columns of files; or the name of a call");
  options.command = &command;
}

std::string helpOf(const std::string& topic, const CLI::App& app) {
  // app.help() is that of the call in hand.
  if (topic.empty()) return app.get_formatter()->make_help(&app, "talus", CLI::AppFormatMode::Normal);
  std::vector<std::string> known{"formats"};
  for (const CLI::App* call : app.get_subcommands({})) {
    if (call->get_name() == topic) return call->help("talus");
    known.push_back(call->get_name());
  }
  const std::string near = nearestName(topic, known);
  throw InputError({topic, "is no topic of help",
                    near.empty() ? "write talus help formats, or talus help and the name of a call"
                                 : "did you mean " + near + "?"});
}

nlohmann::ordered_json formatsJson() {
  nlohmann::ordered_json all;
  for (const FileFormat& format : fileFormats())
    for (const terramech::FileKey& key : format.keys) all[format.title][key.name] = key.meaning;
  return {{"formats", all}};
}

int run(const HelpOptions& options, Context& context) {
  if (options.topic != "formats")
    print(helpOf(options.topic, *options.command->get_parent()));
  else if (context.json)
    printJson(formatsJson());
  else
    print(formatsText());
  return Exit::kDone;
}

}  // namespace

void addHelp(CLI::App& app, Context& context) {
  addCommand<HelpOptions>(app, context,
                          {.name = "help",
                           .group = Group::kHelp,
                           .description = "print the keys and columns of files, or the help of a call",
                           .examples = "  talus help formats\n  talus help plan\n"},
                          bind, run);
}

}  // namespace talus::cli
