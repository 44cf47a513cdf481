#pragma once

#include <atomic>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include <talus/common/common.hpp>

/// Namespace of the command-line program, which has one file per subcommand.
namespace talus::cli {

class StatusLine;

/// Exit codes of the program, stable for scripts.
struct Exit {
  static constexpr int kDone = 0;         ///< the call succeeded
  static constexpr int kNo = 1;           ///< the input is valid and the result is negative: no route, no fit
  static constexpr int kInput = 2;        ///< the call or an input is invalid
  static constexpr int kInternal = 3;     ///< an internal error occurred
  static constexpr int kCancelled = 130;  ///< the call was interrupted by SIGINT (SIGTERM: 143)
  /// The reader of stdout closed the pipe; no message is printed, as for SIGPIPE.
  static constexpr int kReaderGone = 141;
};

/// Global options and terminal output, shared by all subcommands.
struct Context {
  bool json = false;                  ///< true if results are printed as JSON on stdout
  bool quiet = false;                 ///< true if neither progress nor warnings are printed
  bool force = false;                 ///< true if files that checkOutput() protects may be overwritten
  std::uint64_t seed = 1;             ///< seed of all random numbers
  int threads = 0;                    ///< greatest number of threads; 0: one per core
  const char* const* argv = nullptr;  ///< arguments of the call, terminated by a null pointer
  std::stop_token stop;               ///< token of the stop request by SIGINT or SIGTERM
  std::atomic<bool>* answers_stop = nullptr;  ///< flag that answerStop() sets; null: no flag
  StatusLine* status = nullptr;  ///< line that shows the progress on a terminal; null: no progress
  int exit_code = Exit::kDone;

  /// Returns a progress monitor for one phase of work with the name `what`: a status line if stderr is a
  /// terminal, otherwise no output. The monitor requests a stop after Ctrl-C.
  ProgressMonitor watch(std::string_view what) const;

  /// Declares that the call ends by itself after a stop request and outputs its results so far. Interrupt
  /// terminates other calls.
  void answerStop() const noexcept {
    if (answers_stop) *answers_stop = true;
  }

  /// Returns the number of threads to use, at least 1: the user's limit, or one per core.
  int workers() const noexcept;

  /// Prints one line "talus: warning: TEXT" to stderr, unless `quiet` is set.
  void warn(std::string_view text) const;

  /// Prints a result: the JSON if `json` is set, otherwise the text.
  void answer(const nlohmann::ordered_json& result, std::string_view text) const;
};

/// Returns JSON as text, indented by `indent` blanks, or on one line if `indent` is negative. NaN and
/// infinity become null; each byte that is not valid UTF-8 (possible in file names) becomes U+FFFD.
std::string jsonText(const nlohmann::ordered_json& value, int indent = -1);

/// Prints a result as indented JSON to stdout, in ASCII; NaN and infinity become null.
void printJson(const nlohmann::ordered_json& value);

/// Prints a result as plain text to stdout. Here and in printError(), through which all texts pass, what a
/// terminal would obey (escape sequences, marks of the direction of writing) becomes a blank, and an invalid
/// UTF-8 byte U+FFFD.
void print(std::string_view text);

/// Prints a text to stderr. If stderr is closed, the text is lost and no error is reported.
void printError(std::string_view text) noexcept;

/// Returns a text on one line: line breaks become "; ", and tabulators blanks.
std::string oneLine(std::string_view text);

}  // namespace talus::cli
