#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

#include <talus.h>

#include <talus/common/input_error.hpp>
#include <talus/planner/c/session.hpp>

/// Boundary to C: checks sizes and pointers, and converts exceptions to a code and a one-line message.
namespace talus::border {

using planner::Session;

inline planner::Sessions& sessions() {
  static planner::Sessions all;
  return all;
}

inline void setError(talus_error* error, const std::string& what) noexcept {
  if (error == nullptr) return;
  const std::size_t length = std::min(what.size(), sizeof error->text - 1);
  for (std::size_t i = 0; i < length; ++i)
    error->text[i] = static_cast<unsigned char>(what[i]) < 0x20 ? ' ' : what[i];
  error->text[length] = '\0';
}

struct Busy : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs a call. Invalid arguments and input return TALUS_BAD_INPUT, other exceptions TALUS_FAILURE.
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

inline void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

inline void requirePointer(const void* pointer, const char* name) {
  require(pointer != nullptr, std::string(name) + " is NULL; pass one");
}

/// Returns the structure. Throws std::invalid_argument if its size is not that of this version.
template <typename T>
const T& read(const T* given, const char* name) {
  requirePointer(given, name);
  require(given->size == sizeof(T), std::string(name) + ".size = " + std::to_string(given->size) +
                                        ", must be " + std::to_string(sizeof(T)) +
                                        ": set it to sizeof, or rebuild against this talus.h");
  return *given;
}

inline std::shared_ptr<Session> open(talus_session number) {
  auto session = sessions().find(number);
  require(session != nullptr, "session " + std::to_string(number) + " is not open; call talus_create()");
  return session;
}

/// Exclusive access to a session for one call. Looks up the session again after locking, because talus_move()
/// may have replaced the session.
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
