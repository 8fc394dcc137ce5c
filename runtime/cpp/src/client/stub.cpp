// SPDX-License-Identifier: Apache-2.0
#include "rr/stub.hpp"

#include <charconv>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"
#include "runtime/cpp/src/endpoint/subscription.hpp"

namespace rr {
namespace {

Session& need(const std::shared_ptr<Session>& session) {
  if (!session) throw Error(ErrorCode::invalid_operation, "the stub is not attached to a session");
  return *session;
}

// For a member that this program and the service know alike.
Session& need(const Stub& stub, const Member& member) {
  Session& session = need(stub.rr_session());
  session.check_member(stub, member);
  return session;
}

bool is_urgent(const Member& member) { return (member.access & urgent) != 0; }

Outgoing get_request(const std::string& path, const Member& member) {
  if ((member.access & writeonly) != 0) {
    throw Error(ErrorCode::write_only_member, "Write only property");
  }
  return {.type = EntryType::property_get_req,
          .path = path,
          .member = member.name,
          .is_urgent = is_urgent(member)};
}

// The value of a property as if it were a parameter.
class SetRequest {
 public:
  SetRequest(const std::string& path, const Member& member, const void* value)
      : parameter_{"value", member.type},
        value_(value),
        request_{.type = EntryType::property_set_req,
                 .path = path,
                 .member = member.name,
                 .parameters = {&parameter_, 1},
                 .values = &value_,
                 .is_urgent = is_urgent(member)} {
    if ((member.access & readonly) != 0) {
      throw Error(ErrorCode::read_only_member, "Read only property");
    }
  }
  SetRequest(const SetRequest&) = delete;
  SetRequest& operator=(const SetRequest&) = delete;

  operator const Outgoing&() const { return request_; }  // NOLINT

 private:
  const Parameter parameter_;
  const void* const value_;
  const Outgoing request_;
};

Outgoing function_request(const std::string& path, const Member& member,
                          const void* const* arguments) {
  return {.type = EntryType::function_call_req,
          .path = path,
          .member = member.name,
          .parameters = member.parameters,
          .values = arguments,
          .is_urgent = is_urgent(member)};
}

std::string child_path(const std::string& parent, const Member& member) {
  return parent + "." + std::string(member.name);
}

std::string child_path(const std::string& parent, const Member& member, std::string_view index) {
  return child_path(parent, member) + "[" + endpoint::escape_index(index) + "]";
}

}  // namespace

Stub::~Stub() {
  if (rr_session_) rr_session_->forget(*this);
}

[[gnu::hot]] void Stub::rr_get(const Member& member, const CallOptions& options, void* value) {
  const CallOptionsScope scope(options);
  need(*this, member)
      .call(get_request(rr_path_, member), {"value", member.type, value}, rr_timeout_);
}

void Stub::rr_set(const Member& member, const CallOptions& options, const void* value) {
  const CallOptionsScope scope(options);
  need(*this, member).call(SetRequest(rr_path_, member, value), Incoming{}, rr_timeout_);
}

[[gnu::hot]] void Stub::rr_invoke(const Member& member, const CallOptions& options,
                                  const void* const* arguments, void* result) {
  const CallOptionsScope scope(options);
  need(*this, member)
      .call(function_request(rr_path_, member, arguments), {"return", member.type, result},
            rr_timeout_);
}

std::shared_ptr<Stub> Stub::rr_find(const Member& member, const CallOptions& options) {
  const CallOptionsScope scope(options);
  return need(*this, member).find(child_path(rr_path_, member), member.object_type, rr_timeout_);
}

std::shared_ptr<Stub> Stub::rr_find(const Member& member, const CallOptions& options,
                                    std::int32_t index) {
  return rr_find(member, options, std::string_view(std::to_string(index)));
}

std::shared_ptr<Stub> Stub::rr_find(const Member& member, const CallOptions& options,
                                    std::string_view index) {
  const CallOptionsScope scope(options);
  return need(*this, member)
      .find(child_path(rr_path_, member, index), member.object_type, rr_timeout_);
}

void Stub::rr_refuse(const Member& member) {
  throw Error(ErrorCode::service_error,
              "Invalid object type: `" + std::string(member.name) + "` has another class");
}

void Stub::rr_start(const Member& member, bool set, const void* const* arguments,
                    std::unique_ptr<Completion> completion) {
  Session& session = need(rr_session_);
  if (session.refuse_start(*this, member, completion)) return;
  std::shared_ptr<Completion> shared = std::move(completion);
  void* const result = shared->result();
  if (member.kind == MemberKind::function) {
    session.start(function_request(rr_path_, member, arguments), {"return", member.type, result},
                  rr_timeout_, std::move(shared));
  } else if (set) {
    session.start(SetRequest(rr_path_, member, arguments[0]), Incoming{}, rr_timeout_,
                  std::move(shared));
  } else {
    session.start(get_request(rr_path_, member), {"value", member.type, result}, rr_timeout_,
                  std::move(shared));
  }
}

void Stub::rr_start_find(const Member& member, std::unique_ptr<Completion> completion) {
  Session& session = need(rr_session_);
  if (session.refuse_start(*this, member, completion)) return;
  session.start_find(child_path(rr_path_, member), std::string(member.object_type), rr_timeout_,
                     std::move(completion));
}

void Stub::rr_start_find(const Member& member, std::int32_t index,
                         std::unique_ptr<Completion> completion) {
  rr_start_find(member, std::string_view(std::to_string(index)), std::move(completion));
}

void Stub::rr_start_find(const Member& member, std::string_view index,
                         std::unique_ptr<Completion> completion) {
  Session& session = need(rr_session_);
  if (session.refuse_start(*this, member, completion)) return;
  session.start_find(child_path(rr_path_, member, index), std::string(member.object_type),
                     rr_timeout_, std::move(completion));
}

Subscription Stub::rr_connect(const Member& member, std::unique_ptr<EventHandler> handler) {
  Session& session = need(*this, member);
  auto shared = std::make_shared<client::EventSubscription>(*this, member, std::move(handler));
  session.add_handler(shared);
  return Subscription(std::move(shared));
}

}  // namespace rr
