// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/callbacks.hpp"

#include <iterator>
#include <utility>
#include <vector>

#include "rr/call.hpp"
#include "rr/skeleton.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/call_terms.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/places.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_host.hpp"
#include "runtime/cpp/src/service/turn_break.hpp"

namespace rr {
namespace service {
namespace {

channel::Milliseconds timeout_of(const CallTerms& terms, const endpoint::Core& core) {
  return terms.timeout.count() != 0 ? terms.timeout : core.options().request_timeout;
}

void read_result(Decoder& decoder, const Entry& entry, const Member& member, void* result) {
  if (member.type != nullptr) {
    endpoint::read_value(decoder, entry, "return", *member.type, result);
  }
}

}  // namespace

channel::Connection& Callbacks::connection() const { return endpoint_.connection(); }
const std::shared_ptr<endpoint::Core>& Callbacks::core() const { return endpoint_.core(); }
const std::shared_ptr<const TypeRegistry>& Callbacks::types() const { return endpoint_.types(); }

std::shared_ptr<endpoint::Caller> Callbacks::share() {
  return {endpoint_.shared_from_this(), this};
}

bool Callbacks::take(endpoint::Pending& call) {
  const MutexLock lock(mutex_);
  asked_.erase(&call);
  return pending_.take(call);
}

Writer& Callbacks::write(const CallbackRequest& request) const {
  Writer& writer = channel::thread_writer();
  writer.reset(connection().version());
  endpoint::write_values(writer, request.member.parameters, request.arguments);
  if (writer.failed()) throw endpoint::latched(writer);
  return writer;
}

void Callbacks::send(const CallbackRequest& request, Writer& writer, endpoint::Pending& call) {
  constexpr EntryType type = EntryType::callback_call_req;
  const endpoint::Asked asked(type, request.path, request.member.name);
  std::uint32_t number = 0;
  {
    const MutexLock lock(mutex_);
    if (has_ended_) throw Error(ErrorCode::connection_error, "the client has left");
    const std::size_t limit = endpoint_.callback_limit();
    if (pending_.size() >= limit) {
      throw Error(ErrorCode::out_of_system_resource,
                  "the client owes the answers to " + std::to_string(limit) + " callbacks");
    }
    const SessionAccess& access = endpoint_.access();
    const AccessRow& row = row_of_sent(type);
    access.check(row, request.path, request.member.name);  // end_if() finds it from now on
    number = pending_.add(call, asked);
    asked_.emplace(&call, Asked{std::string(request.path), &request.member});
  }
  writer.entry({.type = type,
                .service_path = request.path,
                .member = request.member.name,
                .request_id = number},
               static_cast<std::uint32_t>(request.member.parameters.size()), 0);
  endpoint_.send_request(writer, type, (request.member.access & urgent) != 0);
}

void Callbacks::call(const CallbackRequest& request, void* result) {
  const auto read = [&](Decoder& decoder, const Message&, const Entry& entry) {
    read_result(decoder, entry, request.member, result);
  };
  const CallTerms terms = CallTerms::of_blocking_call();
  const channel::Time now = channel::coarse_now();
  const channel::Time deadline = channel::after(now, timeout_of(terms, *core()));
  const TurnBreak turn_break(deadline);
  Writer& writer = write(request);
  endpoint::BlockingCallOf call(*this, read);
  call.perform(terms, deadline, now, [&](endpoint::Pending& open) { send(request, writer, open); });
}

void Callbacks::start(const CallbackRequest& request, std::shared_ptr<Completion> completion) {
  const CallTerms terms = CallTerms::of_started_call();
  auto read = [member = &request.member, result = completion->result()](
                  Decoder& decoder, const Message&, const Entry& entry) {
    read_result(decoder, entry, *member, result);
  };
  const auto call =
      std::make_shared<endpoint::AsyncCall>(share(), std::move(read), std::move(completion));
  call->start(
      timeout_of(terms, *core()), terms, [&]() -> Writer& { return write(request); },
      [&](endpoint::Pending& open, Writer& writer) { send(request, writer, open); });
}

void Callbacks::take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                            channel::DeferredCallbacks& deferred) {
  if (entry.type != EntryType::callback_call_ret) return;
  if (!endpoint_.access().may_receive(entry.type, entry.service_path, entry.member)) return;
  endpoint::PendingTable::Answered answered;
  bool is_told = false;
  {
    const MutexLock lock(mutex_);
    answered = pending_.take_answered(entry);
    if (answered.request != nullptr) asked_.erase(answered.request);
    if (answered.is_foreign) is_told = std::exchange(has_told_foreign_, true);
  }
  if (answered.request != nullptr) {
    answered.request->answer(message, entry, owner, deferred);
  } else if (answered.is_foreign && !is_told) {
    deferred.push_back(endpoint::tell_foreign_answer(core(), "a client", entry));
  }
}

std::size_t Callbacks::end_if(const Choice& is_over, const Error& why,
                              channel::DeferredCallbacks& deferred) {
  std::vector<endpoint::Pending*> over;
  {
    const MutexLock lock(mutex_);
    for (auto each = asked_.begin(); each != asked_.end();) {
      const bool ends = is_over(each->second.path, each->second.member->name);
      if (ends && pending_.take(*each->first)) over.push_back(each->first);
      each = ends ? asked_.erase(each) : std::next(each);
    }
  }
  for (endpoint::Pending* call : over) call->fail(why, deferred);
  return over.size();
}

void Callbacks::end(std::string_view why, channel::DeferredCallbacks& deferred) {
  while (true) {
    endpoint::Pending* call = nullptr;
    {
      const MutexLock lock(mutex_);
      has_ended_ = true;
      asked_.clear();
      call = pending_.take_any();
    }
    if (call == nullptr) return;
    call->fail(Error(ErrorCode::connection_error, std::string(why)), deferred);
  }
}

namespace {

struct Target {
  std::shared_ptr<ServerEndpoint> endpoint;
  std::string path;
};

// A client knows an object by one path usually. Where there are more, the one that it has just
// used.
Target target_of(Skeleton::Places& places, std::uint32_t client) {
  Target found;
  for (auto& [host, path, owner] : places.all()) {
    if (owner != 0 && owner != client) continue;
    auto endpoint = host->find_client(client);
    if (!endpoint) continue;
    const bool is_current =
        endpoint.get() == ServerEndpoint::current() && path == ServerEndpoint::current_path();
    if (is_current || !found.endpoint) found = {std::move(endpoint), std::move(path)};
    if (is_current) break;
  }
  // Not invalid_endpoint: a client that gets to see that closes its session.
  if (!found.endpoint) {
    throw Error(ErrorCode::connection_error, "there is no client of this number");
  }
  return found;
}

}  // namespace
}  // namespace service

void Skeleton::rr_ask_client(const Member& member, std::uint32_t client,
                             const void* const* arguments, void* result) const {
  const service::Target target = service::target_of(*rr_places_, client);
  target.endpoint->callbacks().call({target.path, member, arguments}, result);
}

void Skeleton::rr_start_asking(const Member& member, std::uint32_t client,
                               const void* const* arguments,
                               std::unique_ptr<Completion> completion) const {
  const service::Target target = service::target_of(*rr_places_, client);
  target.endpoint->callbacks().start({target.path, member, arguments}, std::move(completion));
}

}  // namespace rr
