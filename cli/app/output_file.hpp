#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <talus/common/output_file.hpp>

namespace talus::cli {

/// Returns true if the ending of the file name denotes the same format as `ending` (".html" includes .htm and
/// .HTML).
bool isNamed(const std::filesystem::path& path, const std::string& ending);

/// Declares an option for an output file, which checkOutputs() checks.
CLI::Option* addOutput(CLI::App& command, const std::string& names, std::string& path,
                       const std::string& text);

/// Refuses output paths that require --force: one of the `inputs`, a journal or SQLite's files beside a
/// journal, a path that is not a regular file, a symbolic link to another folder. Throws InputError.
void checkOutput(const std::filesystem::path& path, const std::vector<std::string>& inputs);

/// Refuses a file of a call that is the call's own journal or one of SQLite's files beside the journal (-wal,
/// -shm, -journal), in any spelling. --force does not permit such a path, because the call would destroy data
/// that it reads or writes. Throws InputError.
void checkBesideJournal(const std::filesystem::path& path, const std::filesystem::path& journal);

/// Refuses a name whose ending denotes another known format than the written one. `written` is a file name,
/// or several separated by | ("ROUTE.geojson|FILE.csv"). A name with no ending or an unknown ending is
/// accepted. Throws InputError.
void checkFormat(const std::filesystem::path& path, const std::string& written);

/// Checks every output of a parsed call before the work begins: checkOutput() against all other arguments of
/// the call and checkFormat() against the option's type name (FILE.tif), both unless `force` is set, and
/// whether the file can be written.
void checkOutputs(const CLI::App& command, bool force);

/// Runs compareChecksum() on every file named by an option other than those of addOutput(), alone or as
/// NAME=FILE.
void checkInputs(const CLI::App& command);

}  // namespace talus::cli
