// SPDX-License-Identifier: Apache-2.0
#include "gateway/exported_session.hpp"

#include <optional>
#include <utility>

#include "gateway/elements.hpp"
#include "rr/error.hpp"
#include "rr/locks.hpp"

namespace rr::gateway {
namespace {

/// Threads that wait for the robot, each for one operation on a lock.
constexpr std::size_t most_operations = 16;
/// Whose callbacks one client may set.
constexpr std::size_t most_objects = 1'024;
/// Then a client that waits for a monitor is answered that it is to wait on. The requests of
/// serving gateways, and of their clients, wait for longer.
constexpr std::chrono::seconds longest_silence{3};

/// For the release of a lock when its session ends.
constexpr std::chrono::milliseconds release_time{2'000};

using LockOperation = LockRequest::Operation;

void carry_out(LockOperation operation, const Stub& object, std::chrono::milliseconds timeout) {
  switch (operation) {
    case LockOperation::lock_for_user:
      lock(object, LockOwner::user);
      break;
    case LockOperation::lock_for_session:
      lock(object, LockOwner::session);
      break;
    case LockOperation::unlock:
      unlock(object);
      break;
    case LockOperation::enter_monitor:
      enter_monitor(object, timeout.count() < 0 ? wait_forever : timeout);
      break;
    case LockOperation::exit_monitor:
      exit_monitor(object);
      break;
    case LockOperation::go_on_entering:
      break;
  }
}

/// As far as the robot is there.
void release(const dynamic::Client& client, const Stub& object) {
  if (!client.is_open()) return;
  try {
    unlock(object, CallOptions{.timeout = release_time});
  } catch (const Error&) {
    // It is released, or ends with the connections.
  }
}

}  // namespace

ExportedSession::~ExportedSession() { close(); }

void ExportedSession::open(Node& node, const std::string& url, const MappedUser& user) {
  ConnectOptions options;
  if (!user.name.empty()) {
    options.username = user.name;
    options.credentials["password"] = VarValue(user.password);
  }
  options.on_closed = [weak = weak_from_this()](const Error&) {
    if (const auto self = weak.lock()) self->listener_.closed();
  };
  dynamic::async_connect(
      node, url, std::move(options),
      [weak = weak_from_this()](const std::exception_ptr& error, dynamic::Client client) {
        const auto self = weak.lock();
        if (!self) return;
        if (!error) {
          const MutexLock lock(self->mutex_);
          // One that was ended meanwhile closes with this handle.
          if (!self->is_closed_) self->client_ = std::move(client);
        }
        self->listener_.opened(error);
      });
}

bool ExportedSession::is_open() const {
  const MutexLock lock(mutex_);
  return client_.is_open();
}

void ExportedSession::find(const std::string& path, const RobotSession::Found& done) const {
  std::optional<dynamic::Object> root;
  {
    const MutexLock lock(mutex_);
    if (client_.is_open()) root = client_.root();
  }
  if (!root) {
    done(error_pointer(ErrorCode::connection_error, "the session at the robot has ended"), {});
    return;
  }
  find_object(*root, path, done);
}

bool ExportedSession::is_new(const std::string& path, const dynamic::Object& object) {
  const MutexLock lock(mutex_);
  if (is_closed_ || objects_.size() >= most_objects) return false;
  return objects_.try_emplace(path, object).second;
}

void ExportedSession::keep(const LockRequest& request, const dynamic::Object& object, Locked done) {
  if (request.operation == LockOperation::enter_monitor) {
    enter(request, object, std::move(done));
  } else if (request.operation == LockOperation::go_on_entering) {
    go_on(request.path, std::move(done));
  } else {
    run([operation = request.operation,
         stub = object.shared_stub()] { carry_out(operation, *stub, {}); },
        [weak = weak_from_this(), operation = request.operation, path = request.path,
         stub = object.shared_stub(), done = std::move(done)](const std::exception_ptr& error) {
          const auto self = weak.lock();
          if (self && !error) self->note(operation, path, stub);
          done(error, false);
        });
  }
}

void ExportedSession::note(LockOperation operation, const std::string& path,
                           const std::shared_ptr<Stub>& object) {
  const MutexLock lock(mutex_);
  if (operation == LockOperation::lock_for_user) user_locks_[path] = object;
}

void ExportedSession::forget_lock(const std::string& path) {
  const MutexLock lock(mutex_);
  user_locks_.erase(path);
}

void ExportedSession::enter(const LockRequest& request, const dynamic::Object& object,
                            Locked done) {
  // One that is over was given up by the client: whether it is in the robot knows.
  const auto earlier = attempts_.find(request.path);
  if (earlier != attempts_.end() && !earlier->second.is_over) {
    throw Error(ErrorCode::invalid_operation, "Already acquiring or holding the monitor lock");
  }
  run([timeout = request.timeout,
       stub = object.shared_stub()] { carry_out(LockOperation::enter_monitor, *stub, timeout); },
      [weak = weak_from_this(), path = request.path](const std::exception_ptr& error) {
        if (const auto self = weak.lock()) self->entered(path, error);
      });
  attempts_[request.path] = {std::move(done), Clock::now() + longest_silence, false, nullptr};
}

void ExportedSession::entered(const std::string& path, const std::exception_ptr& error) {
  const auto found = attempts_.find(path);
  if (found == attempts_.end()) return;
  found->second.is_over = true;
  found->second.error = error;
  const Locked done = std::move(found->second.done);
  if (!done) return;  // the client asks again
  attempts_.erase(found);
  done(error, false);
}

void ExportedSession::go_on(const std::string& path, Locked done) {
  const auto found = attempts_.find(path);
  if (found == attempts_.end() || found->second.done) {
    throw Error(ErrorCode::invalid_operation, "Not acquiring monitor lock");
  }
  if (found->second.is_over) {
    const std::exception_ptr error = found->second.error;
    attempts_.erase(found);
    done(error, false);
  } else {
    found->second.done = std::move(done);
    found->second.answer_due = Clock::now() + longest_silence;
  }
}

void ExportedSession::tick(Clock::time_point now) {
  for (auto& [path, attempt] : attempts_) {
    if (attempt.is_over || !attempt.done || now < attempt.answer_due) continue;
    std::exchange(attempt.done, {})(nullptr, true);
  }
}

// Stubs wait for the robot. The thread keeps the stub and not this, which waits for the thread.
void ExportedSession::run(Function<void()> operation, Function<void(std::exception_ptr)> done) {
  const MutexLock lock(mutex_);
  if (is_closed_) throw Error(ErrorCode::connection_error, "the session at the robot has ended");
  join_finished();
  if (operations_.size() >= most_operations) {
    throw Error(ErrorCode::out_of_system_resource,
                "too many operations on locks of one session have no answer");
  }
  const auto is_over = std::make_shared<std::atomic<bool>>(false);
  std::thread thread(
      [operation = std::move(operation), done = std::move(done), post = post_, is_over] {
        std::exception_ptr error;
        try {
          operation();
        } catch (...) {
          error = std::current_exception();
        }
        post([done, error] { done(error); });
        *is_over = true;
      });
  operations_.push_back({std::move(thread), is_over});
}

void ExportedSession::join_finished() {
  std::erase_if(operations_, [](Operation& operation) {
    if (!*operation.is_over) return false;
    operation.thread.join();
    return true;
  });
}

// Operations that wait for the robot end with the session.
void ExportedSession::close() {
  dynamic::Client client;
  std::vector<Operation> operations;
  std::map<std::string, dynamic::Object> objects;
  std::map<std::string, std::shared_ptr<Stub>> locks;
  {
    const MutexLock lock(mutex_);
    is_closed_ = true;
    client = std::move(client_);
    operations.swap(operations_);
    objects.swap(objects_);
    locks.swap(user_locks_);
  }
  for (const auto& [path, object] : locks) release(client, *object);
  if (client.is_open()) client.close();
  for (Operation& operation : operations) operation.thread.join();
}

}  // namespace rr::gateway
