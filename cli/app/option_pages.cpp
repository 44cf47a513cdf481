#include <string>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <talus/cli/app/help_format.hpp>
#include <talus/cli/app/option_pages.hpp>

namespace talus::cli {
namespace {

// Returns the text of a manual page. No line begins with a roff request or is wider than a terminal.
std::string roff(std::string_view text) {
  constexpr std::size_t kWidth = 72;
  std::string out;
  std::size_t line = 0;
  for (const char c : text) {
    if (out.ends_with('\n')) line = out.size();
    if (c == ' ' && out.size() - line >= kWidth - 16)
      out += '\n';
    else if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
      out += std::string("\\&") + c;
    else
      out += c;
  }
  return out;
}

std::string valueOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return option.get_type_size() == 0 ? "" : type.substr(0, endOfTypeName(type));
}

// Choices {a,b} of CLI11's membership check, separated by blanks; empty if the option accepts other words.
std::string membersOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto begin = type.find(":{");
  if (begin == std::string::npos) return "";
  std::string words = type.substr(begin + 2, type.find('}', begin) - begin - 2);
  for (char& c : words)
    if (c == ',') c = ' ';
  return words;
}

// Options shown by --help; deprecated names have no group.
std::vector<const CLI::Option*> shown(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

std::string optionsText(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : shown(app)) {
    const bool positional = !option->nonpositional();
    std::string name = option->get_name(positional);
    name.resize(std::min(name.size(), name.find('{')));
    text +=
        fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(name),
                    positional || valueOf(*option).empty() ? "" : " \\fI" + roff(valueOf(*option)) + "\\fR",
                    roff(option->get_description()));
  }
  return text;
}

std::string longNames(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : shown(app))
    for (const std::string& name : option->get_lnames()) names += " --" + name;
  return names.empty() ? names : names.substr(1);
}

std::string memberCases(const CLI::App& app, const std::string& call) {
  std::string text;
  for (const CLI::Option* option : shown(app))
    for (const std::string& name : option->get_lnames())
      if (const std::string words = membersOf(*option); !words.empty())
        text += fmt::format("    '{} --{}') COMPREPLY=($(compgen -W '{}' -- \"$cur\")); return ;;\n", call,
                            name, words);
  return text;
}

}  // namespace

std::string manualPage(const CLI::App& app) {
  std::string text = ".TH TALUS 1 2026-11-01 \"talus " TALUS_VERSION
                     "\" \"User Commands\"\n.SH NAME\ntalus \\- " +
                     roff(app.get_description()) +
                     "\n.SH SYNOPSIS\n.B talus\n.I call\n.RI [ options ]\n.SH OPTIONS\nOf every call:\n" +
                     optionsText(app) + ".SH CALLS\n";
  for (const CLI::App* call : app.get_subcommands({}))
    text += fmt::format(".SS talus {}\n{}.\n{}", roff(call->get_name()), roff(call->get_description()),
                        optionsText(*call));
  return text +
         ".SH EXIT STATUS\n0 done; 1 no (no route, no fit);\n2 the call or an input is wrong; 3 an internal "
         "failure; 130 cancelled.\n.SH FILES\nKeys and columns of all files: \\fBtalus help formats\\fR.\n";
}

std::string bashCompletion(const CLI::App& app) {
  std::string calls, cases, members = memberCases(app, "");
  for (const CLI::App* call : app.get_subcommands({})) {
    calls += (calls.empty() ? "" : " ") + call->get_name();
    cases += fmt::format("    {}) options='{}' ;;\n", call->get_name(), longNames(*call));
    members += memberCases(*call, call->get_name());
  }
  return fmt::format(R"(# bash completion of talus; made by: talus help bash-completion
_talus() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD - 1]}} call= options= word
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    if [[ " {0} " == *" $word "* ]]; then call=$word; break; fi
  done
  case "$call $prev" in
{1}  esac
  case $call in
{2}  esac
  if [[ $cur == -* ]]; then
    COMPREPLY=($(compgen -W "$options {3}" -- "$cur"))
  elif [[ -z $call || $call == help ]]; then
    COMPREPLY=($(compgen -W '{0}' -- "$cur"))
  else
    COMPREPLY=($(compgen -f -- "$cur"))
  fi
}}
complete -o filenames -F _talus talus
)",
                     calls, members, cases, longNames(app));
}

}  // namespace talus::cli
