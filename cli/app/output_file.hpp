#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <talus/common/output_file.hpp>

namespace talus::cli {

/// Whether the ending of a file's name stands for the same format as `ending` (".html": .htm and .HTML too).
bool isNamed(const std::filesystem::path& path, const std::string& ending);

/// Declares an option that names a file to write; checkOutputs() finds it.
CLI::Option* addOutput(CLI::App& command, const std::string& names, std::string& path,
                       const std::string& text);

/// Refuses a place that only --force may overwrite: one of the `inputs`, a journal or what SQLite keeps beside one, what is
/// no regular file, a link out of its folder. Throws InputError.
void checkOutput(const std::filesystem::path& path, const std::vector<std::string>& inputs);

/// Refuses a file of a call that is its journal or one of SQLite's files beside that (-wal, -shm, -journal), by whatever
/// spelling; --force does not allow it, since the call would destroy what it reads or writes. Throws InputError.
void checkBesideJournal(const std::filesystem::path& path, const std::filesystem::path& journal);

/// Refuses a name whose ending is that of another known format than is written; `written` is a file name, or several with |
/// ("ROUTE.geojson|FILE.csv"). A name without an ending, or with one that denotes no known format, is accepted. Throws InputError.
void checkFormat(const std::filesystem::path& path, const std::string& written);

/// checkOutput() of every output of a parsed call, against all of its other words, and whether its name claims another
/// format than the option's type name (FILE.tif) does; each is also tried, so that a bad place is told before the work.
void checkOutputs(const CLI::App& command, bool force);

/// compareChecksum() of every file that an option of the call other than those of addOutput() names, alone or as NAME=FILE.
void checkInputs(const CLI::App& command);

}  // namespace talus::cli
