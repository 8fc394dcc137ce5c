// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/completions.hpp"

#include "rr/error.hpp"

namespace rr::matlab {
namespace {

// The rest of what it has is there for who asks in the handler.
mxArray* error_to_mex(const std::exception_ptr& error, Runtime& runtime,
                      const std::shared_ptr<Connection>& connection) {
  const auto failure = run([&] { std::rethrow_exception(error); },
                           [&](const Error& one) { runtime.note_error(one, connection); });
  return make_struct({{"identifier", make_text(failure->identifier)},
                      {"message", make_text(failure->message)},
                      {"name", make_text(runtime.name_of_failure(*failure))}});
}

}  // namespace

void Completions::end(std::exception_ptr error, Function<mxArray*()> make) const {
  queue_->push(
      [runtime = runtime_, number = function_, error = std::move(error), make = std::move(make)] {
        UserFunction* const found = runtime->functions().find(number);
        const auto connection = found != nullptr ? found->connection.lock() : nullptr;
        if (!connection) return;
        const Kept function = std::move(found->function);
        mxArray* const parameter = mxDuplicateArray(found->parameter.get());
        connection->remove(number);
        if (!function) return;
        std::vector<mxArray*> arguments{parameter, make_null(), make_null()};
        if (error) {
          arguments[2] = error_to_mex(error, *runtime, connection);
        } else {
          arguments[1] = make();
        }
        UserFunctions::run_alone(function, std::move(arguments));
      });
}

void start_call(Runtime& runtime, const std::shared_ptr<Connection>& connection,
                const Handler& handler, std::chrono::milliseconds limit,
                const std::function<void(const Completions&)>& start) {
  const bool has_function = !is_null(handler.function);
  const std::uint64_t number =
      connection->add({.function = has_function ? Kept(handler.function) : Kept(),
                       .parameter = Kept(handler.parameter),
                       .member = {},
                       .connection = connection,
                       .subscription = nullptr});
  if (limit == std::chrono::milliseconds::max()) limit = runtime.request_timeout;
  try {
    const CallOptions options = within(limit);
    const CallOptionsScope scope(options);
    start(Completions(runtime, number));
  } catch (...) {
    connection->remove(number);
    throw;
  }
}

}  // namespace rr::matlab
