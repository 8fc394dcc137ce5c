// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rr/dynamic_service.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {

/// Definitions that objects are served by, and how their values are converted. For the
/// interpreter's thread.
struct ServedTypes {
  explicit ServedTypes(dynamic::Definitions given) : definitions(std::move(given)) {}
  const dynamic::Definitions definitions;
  Plans plans;
};

/// The function of the interpreter that answers for one object, or one generator: other threads
/// know it by this. The function goes when nobody can ask it any more.
class Answerer {
 public:
  Answerer(Runtime& runtime, const mxArray* function);
  ~Answerer();
  Answerer(const Answerer&) = delete;
  Answerer& operator=(const Answerer&) = delete;

  /// Has the interpreter's thread do something, on behalf of the client whose request this thread
  /// handles. What is let go undone is destroyed.
  void post(Function<void(Runtime&)> work) const;
  /// The same, waiting for what it gives. Throws rr::Error: what it throws; operation_aborted when
  /// it is let go.
  template <class Result>
  Result ask(std::function<Result(Runtime&)> work) const;

  /// Calls the function: on the interpreter's thread. Throws rr::Error for what it throws. The
  /// arguments are destroyed.
  mxArray* call(std::vector<mxArray*> arguments) const;

 private:
  Runtime& runtime_;
  const std::shared_ptr<Queue> queue_;
  const std::uint64_t number_;
};

/// An object that the interpreter serves: its members ask the function
/// `dispatch(kind, member, arguments...)`.
class ServedHandle final : public Handled {
 public:
  ServedHandle(Runtime& runtime, std::shared_ptr<ServedTypes> served_types, const std::string& type,
               const mxArray* dispatch);

  const dynamic::ServedObject object;
  const std::shared_ptr<ServedTypes> types;
  const std::shared_ptr<Answerer> answerer;

  [[nodiscard]] mxArray* write(const dynamic::ValueType& type, const dynamic::Value& value) const;
  /// A monitor, by which clients can have the object to themselves. Before it is offered.
  void enable_monitor() const;
  /// Throws rr::Error that begins with the member.
  [[nodiscard]] dynamic::Value read(const mxArray* given, const dynamic::ValueType& type,
                                    const std::string& member) const;
};

/// The object whose number is the first argument.
std::shared_ptr<ServedHandle> served_of(Runtime& runtime, Call& call);

/// A value of the interpreter's as one of a member's type. Throws rr::Error that names it.
dynamic::Value read_served(ServedTypes& types, const mxArray* given, const dynamic::ValueType& type,
                           const std::string& subject);

/// Has all members of the object answered by its function.
void serve_members(Runtime& runtime, const ServedHandle& handle);

template <class Result>
Result Answerer::ask(std::function<Result(Runtime&)> work) const {
  auto promise = std::make_shared<std::promise<Result>>();
  auto answer = promise->get_future();
  // Whoever lets the work go lets the promise go, which ends the waiting.
  post([promise = std::move(promise), work = std::move(work)](Runtime& runtime) {
    try {
      promise->set_value(work(runtime));
    } catch (const Error&) {
      promise->set_exception(std::current_exception());
    } catch (const Misfit& misfit) {
      promise->set_exception(std::make_exception_ptr(misfit.error("")));
    }
  });
  try {
    return answer.get();
  } catch (const std::future_error&) {
    throw Error(ErrorCode::operation_aborted, "the service does not answer any more");
  }
}

}  // namespace rr::matlab
