#pragma once

#include <atomic>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include <talus/common/progress_monitor.hpp>

/// The program: thin, one file a subcommand.
namespace talus::cli {

/// Exit codes that other programs rely on.
struct Exit {
  static constexpr int kDone = 0;          ///< done
  static constexpr int kNo = 1;            ///< a well-posed question with the answer no: no route, no fit
  static constexpr int kInput = 2;         ///< the call or an input is wrong
  static constexpr int kInternal = 3;      ///< our failure
  static constexpr int kCancelled = 130;   ///< stopped by the user; 143 by SIGTERM
  static constexpr int kReaderGone = 141;  ///< nobody reads the output any more; without a word, as SIGPIPE
};

/// What every subcommand shares: the global options, and the way to the terminal.
struct Context {
  bool json = false;                          ///< results as JSON on stdout
  bool quiet = false;                         ///< no progress, no warnings
  bool force = false;                         ///< overwrites what checkOutput() would keep
  std::uint64_t seed = 1;                     ///< of every random number
  int threads = 0;                            ///< at most so many; 0: one a core
  const char* const* argv = nullptr;          ///< the words of the call, ended by a null pointer
  std::stop_token stop;                       ///< set by Ctrl-C
  std::atomic<bool>* answers_stop = nullptr;  ///< see answerStop()
  int exit_code = Exit::kDone;

  /// Follows one stretch of work: a bar on stderr where that is a terminal (silent in a pipe), stopped by
  /// Ctrl-C.
  ProgressMonitor watch(std::string_view what) const;

  /// Says that from here on the call ends by itself when stopped, and hands out what it has; else it is ended.
  void answerStop() const noexcept {
    if (answers_stop) *answers_stop = true;
  }

  /// Threads to work with: what the user allows, else one a core; at least 1.
  int workers() const noexcept;

  /// One line "talus: warning: TEXT" on stderr, unless quiet.
  void warn(std::string_view text) const;
};

/// JSON as text, indented by so many blanks or on one line; a NaN or an infinity becomes null, and each byte that is no
/// UTF-8, as file names may hold, U+FFFD.
std::string jsonText(const nlohmann::ordered_json& value, int indent = -1);

/// Prints a result as indented JSON on stdout; a NaN or an infinity becomes null.
void printJson(const nlohmann::ordered_json& value);

/// Prints a result that a person reads on stdout.
void print(std::string_view text);

/// Writes to stderr. Where nobody listens, the text is lost and nothing else happens.
void printError(std::string_view text) noexcept;

/// The text on one line: line breaks become "; ", other control characters blanks, and bytes that are no UTF-8 U+FFFD.
std::string oneLine(std::string_view text);

}  // namespace talus::cli
