// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "rr/call.hpp"
#include "rr/dynamic.hpp"
#include "rr/matlab/failure.hpp"
#include "rr/mutex.hpp"
#include "rr/node.hpp"
#include "runtime/matlab/src/call.hpp"
#include "runtime/matlab/src/handles.hpp"
#include "runtime/matlab/src/interrupts.hpp"
#include "runtime/matlab/src/log.hpp"
#include "runtime/matlab/src/node_options.hpp"
#include "runtime/matlab/src/plans.hpp"
#include "runtime/matlab/src/queue.hpp"
#include "runtime/matlab/src/user_functions.hpp"

namespace rr::matlab {

class Connection;
struct Module;
struct ServedTypes;

/// Definitions that came with generated classes.
struct RecordTypes {
  explicit RecordTypes(dynamic::Definitions given) : definitions(std::move(given)) {}
  dynamic::Definitions definitions;
  Plans plans;
};

/// The one node of an interpreter, and what the interpreter holds of it. Made by the first command,
/// on the interpreter's thread, which alone uses it; what threads of the node have for that one
/// goes through the queue.
class Runtime {
 public:
  /// `generation`: see Handles.
  Runtime(std::uint32_t generation, RuntimeOptions given);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  Node& node() { return *node_; }
  Handles& handles() { return handles_; }
  UserFunctions& functions() { return functions_; }
  Log& log() { return *log_; }
  [[nodiscard]] const std::shared_ptr<Queue>& queue() const { return queue_; }

  /// The generated classes that are compiled in.
  std::span<const Module* const> modules;
  /// The definitions of generated records, by their services.
  std::map<std::string, std::unique_ptr<RecordTypes>> records;
  /// Whether a call may block this thread: nobody waits for it meanwhile, and it is told of
  /// interrupts.
  [[nodiscard]] bool may_block() const;

  /// How long calls wait for their answers; 0: as the node does.
  std::chrono::milliseconds request_timeout{0};

  /// A call to a service that blocks: `direct()` if nothing else can happen meanwhile; else
  /// `start(done)`, and callbacks run while it is waited for. An interrupt ends it with
  /// operation_cancelled.
  template <class... Result, class Direct, class Start>
  auto call(Direct&& direct, Start&& start, std::optional<std::chrono::milliseconds> limit = {});

  /// A call that has no other form.
  template <class Direct>
  auto call_directly(Direct&& direct, std::optional<std::chrono::milliseconds> limit = {});

  /// Waits, running callbacks, until `is_true()`; false when the time is over before. Something
  /// must wake the queue when it may have become true, or it is noticed after up to 20 ms. Throws
  /// rr::Error (operation_cancelled) after an interrupt.
  bool wait_until(const std::function<bool()>& is_true, std::chrono::milliseconds limit);

  /// Runs what waits in the queue, at most what is there now; returns how many.
  std::size_t run_queue();
  /// Runs callbacks and requests that wait.
  void run_calls();

  /// The definitions that services may be offered by, and what they were read to; null while there
  /// is another one.
  std::vector<std::string> service_types;
  std::shared_ptr<ServedTypes> served_types;
  /// Requests to services of ours that were answered.
  std::uint64_t served_count = 0;
  /// Whose request is answered; 0 for nobody's.
  std::uint32_t current_client = 0;

  /// What the last error that was raised had besides its message, for who asks.
  struct LastError {
    Error error{ErrorCode::none, ""};
    std::shared_ptr<Connection> connection;
  };
  std::optional<LastError> last_error;
  /// Notes an error that is about to be raised, and of which connection it is, if of one.
  void note_error(const Error& error, std::shared_ptr<Connection> connection);
  /// The full name of the error with this identifier and message; empty if it is none of ours.
  [[nodiscard]] std::string name_of_failure(const Failure& failure) const;
  /// What a failure of a function of the user's is told to a service as: an error that came from
  /// elsewhere, or that RobotRaconteur.ThrowError has made, as it is.
  [[nodiscard]] Error error_of_failure(const Failure& failure) const;
  /// Whose command runs, so that a parameter of its error can be read.
  std::shared_ptr<Connection> current;
  /// What all values of a generator may take in memory, unless the call says otherwise: bytes.
  const std::size_t generator_limit;
  /// Of all connections, see ConnectOptions.
  const bool allow_clear_credentials;

 private:
  /// A blocking call, for who is told of interrupts on another thread.
  class Waiting {
   public:
    explicit Waiting(Runtime& runtime);
    ~Waiting();
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;
    /// Does it; that it was interrupted is said.
    template <class Direct>
    auto run(Direct&& direct) {
      try {
        return direct();
      } catch (const Error& error) {
        if (error.code() != ErrorCode::operation_cancelled || !cancellation.stop_requested()) throw;
        throw Error(error.code(), "interrupted; the service may still be busy with the call");
      }
    }
    std::stop_source cancellation;

   private:
    Runtime& runtime_;
  };
  CallOptions options_of(const Waiting& waiting,
                         std::optional<std::chrono::milliseconds> limit) const;
  void interrupted();

  std::shared_ptr<Queue> queue_;
  std::shared_ptr<Log> log_;
  // Of errors whose identifiers do not tell their names: names that other languages have given.
  std::map<std::string, std::string> foreign_names_;
  UserFunctions functions_;
  Handles handles_;
  Mutex waiting_mutex_;
  std::vector<std::stop_source> waiting_ RR_GUARDED_BY(waiting_mutex_);
  std::unique_ptr<Interrupts> interrupts_;
  std::unique_ptr<Node> node_;
};

template <class Direct>
auto Runtime::call_directly(Direct&& direct, std::optional<std::chrono::milliseconds> limit) {
  Waiting waiting(*this);
  const CallOptions options = options_of(waiting, limit);
  const CallOptionsScope scope(options);
  return waiting.run(direct);
}

template <class... Result, class Direct, class Start>
auto Runtime::call(Direct&& direct, Start&& start, std::optional<std::chrono::milliseconds> limit) {
  Waiting waiting(*this);
  const CallOptions options = options_of(waiting, limit);
  const CallOptionsScope scope(options);
  if (may_block()) return waiting.run(direct);
  struct Answer {
    std::atomic<bool> has_come{false};
    std::exception_ptr error;
    std::tuple<Result...> result;
  };
  auto answer = std::make_shared<Answer>();
  start([answer, queue = queue_](std::exception_ptr error, Result... result) {
    answer->error = std::move(error);
    answer->result = std::tuple<Result...>(std::move(result)...);
    answer->has_come = true;
    queue->wake();
  });
  wait_until([&] { return answer->has_come.load(); }, std::chrono::milliseconds::max());
  // The call may have seen the interrupt first.
  waiting.run([&] {
    if (answer->error) std::rethrow_exception(answer->error);
  });
  if constexpr (sizeof...(Result) == 1) return std::move(std::get<0>(answer->result));
}

}  // namespace rr::matlab
