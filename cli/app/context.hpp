#pragma once

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <sstream>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include <talus/common/common.hpp>

namespace talus::cli {

/// Returns the text of a phase of work with its completed fraction [-]: a bar with the time left, or the elapsed
/// time if the fraction is 0, which means unknown.
std::string progressText(std::string_view what, double fraction, double elapsed_s);

/// The last line of a terminal on stderr, which shows the present phase of work once the phase takes longer than half
/// a second. Thread-safe.
class StatusLine {
 public:
  /// Begins a phase, which hides those begun before until it ends. Returns the callback of its progress monitor;
  /// the phase ends with the fraction 1 or with the last copy of the callback, which must not outlive this object.
  std::function<void(double)> begin(std::string_view what);

  /// Draws the line. To be called several times a second.
  void tick();

  /// Erases the line until the next tick().
  void erase();

 private:
  struct Phase;

  std::mutex mutex_;
  std::vector<std::weak_ptr<Phase>> phases_;  // the last one that has not ended is shown
  bool drawn_ = false;
};

/// Converts the first SIGINT or SIGTERM to a stop request. Terminates the process if the work does not end
/// within 0.4 s of CPU time or 3 s of wall time, or uses no CPU time for 0.3 s (blocked, for example on a
/// FIFO), unless answered() is set. A second signal always terminates the process. Unfinished files are
/// removed. The object must be created before any other thread, so that all threads inherit the blocked
/// signals.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Returns the token through which work receives the stop request.
  std::stop_token token() const noexcept { return source_.get_token(); }
  bool requested() const noexcept { return source_.stop_requested(); }
  /// Returns the exit code of the received signal: 130 for SIGINT, 143 for SIGTERM.
  int code() const noexcept { return code_; }
  /// Returns the flag that work sets if it ends by itself after the stop request, such as planners, which
  /// return their best route.
  std::atomic<bool>& answered() noexcept { return answered_; }
  /// Returns the line that the listener thread draws until the first signal.
  StatusLine& status() noexcept { return status_; }

 private:
  void listen();
  void watch();

  sigset_t signals_{};
  std::stop_source source_;
  std::atomic<int> code_ = 130;
  std::atomic<bool> answered_ = false;
  std::atomic<bool> closing_ = false;
  StatusLine status_;
  std::thread listener_;
};

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

/// Returns the JSON array of of(element) for the elements of a range.
template <typename Range, typename Of>
nlohmann::ordered_json jsonList(const Range& range, Of of) {
  auto list = nlohmann::ordered_json::array();
  for (const auto& element : range) list.push_back(of(element));
  return list;
}

/// Returns the texts of(element) of the elements of a range, separated.
template <typename Range, typename Of>
std::string listText(const Range& range, Of of, const char* separator = ", ") {
  std::string text;
  for (const auto& element : range) text += (text.empty() ? "" : separator) + of(element);
  return text;
}

/// Returns the words of a text in lines for which fits(line) is true; a longer word has its own line.
template <typename Fits>
std::vector<std::string> wrappedLines(const std::string& text, Fits fits) {
  std::vector<std::string> lines{""};
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (lines.back().empty() || fits(longer))
      lines.back() = longer;
    else
      lines.push_back(word);
  }
  return lines;
}

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

/// Returns a word of a command line as a POSIX shell reads it, in quotes where necessary.
std::string shellWord(const std::string& word);

/// Returns a text on one line: line breaks become "; ", and tabulators blanks.
std::string oneLine(std::string_view text);

}  // namespace talus::cli
