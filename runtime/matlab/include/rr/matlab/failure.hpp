// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "rr/error.hpp"
#include "rr/matlab/identifier.hpp"
#include "rr/matlab/misfit.hpp"
#include "rr/matlab/text.hpp"

#ifdef RR_OCTAVE
#include <octave/quit.h>
#endif

/// From C++ exceptions to errors of the interpreter.
namespace rr::matlab {

/// What an error of the interpreter is made of.
struct Failure {
  std::string identifier;
  std::string message;
};

inline Failure failure_of(const Error& error) {
  std::string message = error.message();
  if (message.empty()) message = error.name();
  if (!error.subname().empty()) message += " (" + error.subname() + ")";
  return {identifier_of(error.name()), std::move(message)};
}

/// The code of an error of the protocol by its qualified name; remote_error for all others.
inline ErrorCode code_of_name(std::string_view name) {
  constexpr int last_code = 152;
  for (int code = 1; code <= last_code; ++code) {
    if (error_name(static_cast<ErrorCode>(code)) == name) return static_cast<ErrorCode>(code);
  }
  return ErrorCode::remote_error;
}

/// The error of the protocol that a failure of the user's function is told to a service as: one
/// with an identifier of ours, or of a service's exception, is that; all others are
/// RobotRaconteur.RemoteError with the identifier as sub-name.
inline Error error_of(const Failure& failure) {
  const std::string name = name_of_identifier(failure.identifier);
  if (!name.empty()) return {code_of_name(name), name, failure.message};
  return {ErrorCode::remote_error, "RobotRaconteur.RemoteError", failure.message,
          failure.identifier};
}

/// Ends the MEX function with an error: the last thing it does, when no object of C++ is left that
/// has to be destroyed. The message stays as it is, without the name of the file before it.
inline void raise(Failure&& failure) {
  mxArray* error = nullptr;
  {
    const Failure gone = std::move(failure);
    const char* names[] = {"message", "identifier"};
    error = mxCreateStructMatrix(1, 1, 2, names);
    mxSetFieldByNumber(error, 0, 0, make_text(gone.message));
    mxSetFieldByNumber(error, 0, 1, make_text(gone.identifier));
  }
  mexCallMATLAB(0, nullptr, 1, &error, "error");
}

/// Runs `body()`; what it throws is told to `report(const Error&)`, if it is an rr::Error, and
/// becomes the result. Nothing escapes but what is the interpreter's own: that it is to end, that
/// it was interrupted, an error of a function that it has called.
template <class Body, class Report>
std::optional<Failure> run(Body&& body, Report&& report) {
  try {
    body();
    return std::nullopt;
#ifdef RR_OCTAVE
  } catch (const octave::interrupt_exception&) {
    throw;
  } catch (const octave::exit_exception&) {
    throw;
  } catch (const octave::execution_exception&) {
    throw;
#endif
  } catch (const Misfit& misfit) {
    return failure_of(misfit.error(""));
  } catch (const Error& error) {
    report(error);
    return failure_of(error);
  } catch (const std::bad_alloc&) {
    return Failure{"RobotRaconteur:OutOfSystemResource", "out of memory"};
  } catch (const std::exception& error) {
    return Failure{"RobotRaconteur:InternalError", error.what()};
  }
}

}  // namespace rr::matlab
