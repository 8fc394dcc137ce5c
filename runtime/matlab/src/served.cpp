// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/served.hpp"

#include <semaphore>

#include "rr/error.hpp"

namespace rr::matlab {

using dynamic::Value;

Answerer::Answerer(Runtime& runtime, const mxArray* function)
    : runtime_(runtime),
      queue_(runtime.queue()),
      number_(runtime.functions().add({.function = Kept(function),
                                       .parameter = {},
                                       .is_waited_for = true,
                                       .member = {},
                                       .connection = {},
                                       .subscription = nullptr})) {}

// On any thread.
Answerer::~Answerer() {
  queue_->push([&runtime = runtime_, number = number_] { runtime.functions().remove(number); });
}

void Answerer::post(Function<void(Runtime&)> work) const {
  queue_->push_request(
      [&runtime = runtime_, work = std::move(work), client = ServiceContext::current_client()] {
        struct Serving {
          Serving(Runtime& given, std::uint32_t number)
              : runtime(given), before(std::exchange(given.current_client, number)) {}
          ~Serving() { runtime.current_client = before; }
          Runtime& runtime;
          const std::uint32_t before;
        } serving(runtime, client);
        work(runtime);
      });
}

mxArray* Answerer::call(std::vector<mxArray*> arguments) const {
  const UserFunction* const function = runtime_.functions().find(number_);
  if (function == nullptr) {
    throw Error(ErrorCode::operation_aborted, "the service does not answer any more");
  }
  const auto outcome = UserFunctions::run(function->function, std::move(arguments), true);
  if (outcome.failure) throw runtime_.error_of_failure(*outcome.failure);
  return outcome.result != nullptr ? outcome.result : make_null();
}

ServedHandle::ServedHandle(Runtime& runtime, std::shared_ptr<ServedTypes> served_types,
                           const std::string& type, const mxArray* dispatch)
    : object(served_types->definitions, type),
      types(std::move(served_types)),
      answerer(std::make_shared<Answerer>(runtime, dispatch)) {
  serve_members(runtime, *this);
}

void ServedHandle::enable_monitor() const {
  const auto is_free = std::make_shared<std::binary_semaphore>(1);
  object.set_monitor([is_free](auto limit) { return is_free->try_acquire_for(limit); },
                     [is_free] { is_free->release(); });
}

mxArray* ServedHandle::write(const dynamic::ValueType& type, const Value& value) const {
  return to_mex(value, *types->plans.plan(type), types->plans);
}

Value ServedHandle::read(const mxArray* given, const dynamic::ValueType& type,
                         const std::string& member) const {
  return read_served(*types, given, type, "member " + member);
}

std::shared_ptr<ServedHandle> served_of(Runtime& runtime, Call& call) {
  return runtime.handles().get<ServedHandle>(call.handle(0));
}

Value read_served(ServedTypes& types, const mxArray* given, const dynamic::ValueType& type,
                  const std::string& subject) {
  const TypePlan* const plan = types.plans.plan(type);
  if (plan == nullptr) return {};
  return as_subject(subject, [&] {
    return from_mex(given, *plan, {types.plans, types.definitions});
  });
}

}  // namespace rr::matlab
