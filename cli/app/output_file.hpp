#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <talus/common/output_file.hpp>

namespace talus::cli {

/// Locks files against other Talus processes that read, change and rewrite the same files; later processes
/// wait. Paths of files that do not exist are ignored. The lock is advisory: programs that do not request the
/// lock are not blocked.
class FileLock {
 public:
  /// Waits until all files are locked; the destructor releases the locks. Throws InputError if a file cannot
  /// be opened or locked, and std::runtime_error if a stop is requested.
  FileLock(const std::vector<std::filesystem::path>& paths, const std::stop_token& stop);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  bool tryAll(const std::vector<std::filesystem::path>& paths);
  void release() noexcept;

  std::vector<int> held_;
};

/// Declares an option for an output file, as addOption() does, which checkOutputs() checks.
CLI::Option* addOutput(CLI::App& command, const std::string& name, std::string& path);

/// Checks that an output path does not require --force. Throws InputError for one of the `inputs`, a journal,
/// SQLite's files beside a journal, a path that is not a regular file, and a symbolic link to another folder.
void checkOutput(const std::filesystem::path& path, const std::vector<std::string>& inputs);

/// Throws InputError if an output path of a call is the call's own journal or one of SQLite's files beside
/// the journal (-wal, -shm, -journal), in any spelling. --force does not permit such a path, because the call
/// would destroy data that it reads or writes.
void checkBesideJournal(const std::filesystem::path& path, const std::filesystem::path& journal);

/// Throws InputError if the ending of a file name denotes another known format than the written one.
/// `written` is a file name, or several separated by | ("ROUTE.geojson|FILE.csv"). A name with no ending or
/// an unknown ending is accepted.
void checkFormat(const std::filesystem::path& path, const std::string& written);

/// Checks every output file of a parsed call before the work begins: whether the file can be written and,
/// unless `force` is set, checkOutput() against all other arguments of the call and checkFormat() against the
/// option's type name (FILE.tif).
void checkOutputs(const CLI::App& command, bool force);

}  // namespace talus::cli
