// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/client/callbacks.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/arguments.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"

namespace rr {
namespace client {

void CallbackSlot::set(std::unique_ptr<CallbackFunction> function) {
  std::shared_ptr<CallbackFunction> shared = std::move(function);
  const MutexLock lock(mutex_);
  shared.swap(function_);
}

void CallbackSlot::clear() {
  std::shared_ptr<CallbackFunction> old;
  MutexLock lock(mutex_);
  old.swap(function_);
  const auto self = std::this_thread::get_id();
  if (std::find(running_.begin(), running_.end(), self) == running_.end()) {
    while (!running_.empty()) ended_.wait(mutex_);
  }
  lock.unlock();
}

std::shared_ptr<const void> CallbackSlot::call(const Arguments& arguments) {
  // The function is let go before the call counts as ended.
  struct Run {
    CallbackSlot& slot;
    std::shared_ptr<CallbackFunction> function;
    ~Run() {
      function.reset();
      {
        const MutexLock lock(slot.mutex_);
        auto& running = slot.running_;
        running.erase(std::find(running.begin(), running.end(), std::this_thread::get_id()));
      }
      slot.ended_.notify_all();
    }
  };
  MutexLock lock(mutex_);
  if (!function_) throw Error(ErrorCode::invalid_operation, "Callback function not set");
  running_.push_back(std::this_thread::get_id());
  const Run run{*this, function_};
  lock.unlock();
  return run.function->call(arguments);
}

std::shared_ptr<CallbackSlot> Callbacks::find(std::string_view path, std::string_view member) {
  const MutexLock lock(mutex_);
  for (const auto& slot : slots_) {
    if (slot->member->name == member && slot->path == path) return slot;
  }
  return nullptr;
}

std::shared_ptr<CallbackSlot> Callbacks::find_locked(const Stub& stub, const Member& member) {
  for (const auto& slot : slots_) {
    if (slot->stub == &stub && slot->member->name == member.name) return slot;
  }
  return nullptr;
}

void Callbacks::set(const Stub& stub, const Member& member,
                    std::unique_ptr<CallbackFunction> function) {
  std::shared_ptr<CallbackSlot> slot;
  {
    const MutexLock lock(mutex_);
    if (has_ended_) return;
    slot = find_locked(stub, member);
    if (!slot) slot = slots_.emplace_back(std::make_shared<CallbackSlot>(stub, member));
  }
  slot->set(std::move(function));
}

void Callbacks::clear(const Stub& stub, const Member& member) {
  std::shared_ptr<CallbackSlot> slot;
  {
    const MutexLock lock(mutex_);
    slot = find_locked(stub, member);
  }
  if (slot) slot->clear();
}

void Callbacks::forget(const Stub& stub) {
  std::vector<std::shared_ptr<CallbackSlot>> removed;
  {
    const MutexLock lock(mutex_);
    std::erase_if(slots_, [&](const auto& slot) {
      if (slot->stub != &stub) return false;
      removed.push_back(slot);
      return true;
    });
  }
  for (const auto& slot : removed) slot->clear();
}

void Callbacks::end() {
  std::vector<std::shared_ptr<CallbackSlot>> removed;
  const MutexLock lock(mutex_);
  has_ended_ = true;
  removed.swap(slots_);
}

}  // namespace client

void CallbackMember::set_function(std::unique_ptr<CallbackFunction> function) {
  const auto& session = stub_->rr_session();
  if (!session) {
    throw Error(ErrorCode::invalid_operation, "the stub is not attached to a session");
  }
  session->check_member(*stub_, *member_);
  session->callbacks().set(*stub_, *member_, std::move(function));
}

void CallbackMember::clear() {
  if (const auto& session = stub_->rr_session()) session->callbacks().clear(*stub_, *member_);
}

// Who is asked (07, section 12). A stub that is found is let go at once: with the last reference it
// goes away here, where that does no harm.
std::shared_ptr<client::CallbackSlot> Session::find_callback(const Entry& entry) {
  if (auto slot = callbacks_.find(entry.service_path, entry.member)) return slot;
  const auto stub = stubs_.find(std::string(entry.service_path));
  if (!stub) throw Error(ErrorCode::service_error, "the client does not use this object");
  for (const Member& member : stub->rr_object_type().members) {
    if (member.kind == MemberKind::callback && member.name == entry.member) {
      throw Error(ErrorCode::invalid_operation, "Callback function not set");
    }
  }
  throw Error(ErrorCode::member_not_found, "Member not found");
}

// Out of turn, or with the dispatch turn when there are too many: as an answer of its own in either
// case.
void Session::answer_callback(const Message& message, const Entry& entry, const MemoryRef& owner) {
  std::shared_ptr<const void> result;
  const Member* member = nullptr;
  bool is_urgent = false;
  std::exception_ptr failure;
  try {
    const auto slot = find_callback(entry);
    member = slot->member;
    is_urgent = (member->access & urgent) != 0;
    const Arguments::Source source{message, entry, owner, *types()};
    result = slot->call(Arguments(source));
    if (member->type != nullptr && !result) {
      throw Error(ErrorCode::internal_error, "the function has given no value");
    }
  } catch (...) {
    failure = std::current_exception();
  }
  if (failure) {
    send_callback_error(message, entry, endpoint::describe(failure), is_urgent);
    return;
  }
  try {
    Writer& writer = channel::thread_writer();
    writer.reset(connection_->version());
    const std::int32_t nothing = 0;  // what void looks like
    const Type& type = member->type != nullptr ? *member->type : type_of<std::int32_t>;
    type.write(writer, "return", member->type != nullptr ? result.get() : &nothing);
    if (writer.failed()) throw endpoint::latched(writer);
    writer.entry(endpoint::answer_header(entry), 1, 0);
    send_answer(writer, message, entry, false, is_urgent);
  } catch (const Error& error) {
    if (!connection_->is_closed()) send_callback_error(message, entry, error, is_urgent);
  }
}

void Session::send_callback_error(const Message& message, const Entry& entry, const Error& error,
                                  bool is_urgent) {
  Writer& writer = channel::thread_writer();
  writer.reset(connection_->version());
  endpoint::write_error_answer(writer, entry, error);
  try {
    send_answer(writer, message, entry, false, is_urgent);
  } catch (const Error& why) {
    if (why.code() != ErrorCode::connection_error) throw;  // else nobody is left to be told
  }
}

}  // namespace rr
