// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/callbacks.hpp"

#include <utility>

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

namespace rr {
namespace service {
namespace {

// While a member waits for a callback, its client's next requests are handled: the client may be
// making one in order to answer.
class TurnBreak {
 public:
  TurnBreak() {
    ServerEndpoint* const endpoint = ServerEndpoint::current();
    if (endpoint != nullptr && endpoint->connection().give_up_turn()) {
      connection_ = &endpoint->connection();
    }
  }
  ~TurnBreak() {
    if (connection_ != nullptr) connection_->take_turn_again();
  }
  TurnBreak(const TurnBreak&) = delete;
  TurnBreak& operator=(const TurnBreak&) = delete;

 private:
  channel::Connection* connection_ = nullptr;
};

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
  const std::lock_guard lock(mutex_);
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
  std::uint32_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    if (has_ended_) throw Error(ErrorCode::connection_error, "the client has left");
    number = pending_.add(call);
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
  const CallTerms terms = CallTerms::current();
  const TurnBreak turn_break;
  const channel::Time now = channel::coarse_now();
  Writer& writer = write(request);
  endpoint::BlockingCallOf call(*this, read);
  call.perform(terms, channel::after(now, timeout_of(terms, *core())), now,
               [&](endpoint::Pending& open) { send(request, writer, open); });
}

void Callbacks::start(const CallbackRequest& request, std::shared_ptr<Completion> completion) {
  const CallTerms terms = CallTerms::current();
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
                            channel::Laters& laters) {
  if (entry.type != EntryType::callback_call_ret) return;
  endpoint::Pending* call = nullptr;
  {
    const std::lock_guard lock(mutex_);
    call = pending_.take(entry.request_id);
  }
  if (call != nullptr) call->answer(message, entry, owner, laters);
}

void Callbacks::end(std::string_view why, channel::Laters& laters) {
  while (true) {
    endpoint::Pending* call = nullptr;
    {
      const std::lock_guard lock(mutex_);
      has_ended_ = true;
      call = pending_.take_any();
    }
    if (call == nullptr) return;
    call->fail(Error(ErrorCode::connection_error, std::string(why)), laters);
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
