#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#include <talus.h>

#include <talus/common/common.hpp>
#include <talus/planner/c/session.hpp>

/// Boundary to the C interface: checks of sizes and pointers, and conversion of exceptions to an error code
/// and a message of one line.
namespace talus::border {

using planner::Session;

/// Returns all open sessions of the process.
inline planner::Sessions& sessions() {
  static planner::Sessions all;
  return all;
}

/// Writes a message to `error`, which may be null; long messages are cut, control characters become blanks.
inline void setError(talus_error* error, const std::string& what) noexcept {
  if (error == nullptr) return;
  const std::size_t length = std::min(what.size(), sizeof error->text - 1);
  for (std::size_t i = 0; i < length; ++i)
    error->text[i] = static_cast<unsigned char>(what[i]) < 0x20 ? ' ' : what[i];
  error->text[length] = '\0';
}

/// Error of a call to a session that another thread is using.
struct Busy : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs the body of a C function and returns its code. Invalid arguments and invalid input return
/// TALUS_BAD_INPUT, Busy returns TALUS_BUSY, other exceptions return TALUS_FAILURE; the message is written to
/// `error`.
template <typename Work>
talus_code guarded(talus_error* error, const Work& work) noexcept {
  try {
    setError(error, "");
    return work();
  } catch (const Busy& busy) {
    setError(error, busy.what());
    return TALUS_BUSY;
  } catch (const std::invalid_argument& wrong) {
    setError(error, wrong.what());
    return TALUS_BAD_INPUT;
  } catch (const InputError& wrong) {
    setError(error, wrong.what());
    return TALUS_BAD_INPUT;
  } catch (const std::exception& failure) {
    setError(error, failure.what());
    return TALUS_FAILURE;
  } catch (...) {
    setError(error, "an error that is not known");
    return TALUS_FAILURE;
  }
}

/// Throws std::invalid_argument with the text `what` unless `holds` is true.
inline void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

inline void requirePointer(const void* pointer, const char* name) {
  require(pointer != nullptr, std::string(name) + " is NULL; pass one");
}

/// Returns the structure that a caller passed. Throws std::invalid_argument if the pointer is null or the
/// size field differs from the size in this version.
template <typename T>
const T& read(const T* given, const char* name) {
  requirePointer(given, name);
  require(given->size == sizeof(T), std::string(name) + ".size = " + std::to_string(given->size) +
                                        ", must be " + std::to_string(sizeof(T)) +
                                        ": set it to sizeof, or rebuild against this talus.h");
  return *given;
}

/// Returns the session with a number. Throws std::invalid_argument if the session is not open.
inline std::shared_ptr<Session> open(talus_session number) {
  auto session = sessions().find(number);
  require(session != nullptr, "session " + std::to_string(number) + " is not open; call talus_create()");
  return session;
}

/// Exclusive access to a session during one call. After locking, the number is looked up again, because
/// talus_move() may have replaced the session. Throws Busy if another thread uses the session.
struct Held {
  explicit Held(talus_session number) {
    do {
      lock = {};
      session = open(number);
      lock = std::unique_lock(session->work, std::try_to_lock);
      if (!lock.owns_lock())
        throw Busy("another thread works on session " + std::to_string(number) +
                   "; wait for it, or cancel its plan");
    } while (sessions().find(number) != session);
  }
  Session* operator->() const noexcept { return session.get(); }

  std::shared_ptr<Session> session;
  std::unique_lock<std::mutex> lock;
};

}  // namespace talus::border
