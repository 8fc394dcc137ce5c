// SPDX-License-Identifier: Apache-2.0
// What a stub's wires ask of the service.
#include <utility>

#include "rr/error.hpp"
#include "rr/wires.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/client/wire_end.hpp"
#include "runtime/cpp/src/client/wire_request.hpp"
#include "runtime/cpp/src/endpoint/wire_values.hpp"

namespace rr {
namespace {

using client::ClientWireEnd;

Session& need_session(const Stub& stub) {
  if (!stub.rr_session()) {
    throw Error(ErrorCode::invalid_operation, "the stub is not attached to a session");
  }
  return *stub.rr_session();
}

// For a member that this program and the service know alike.
Session& need_session(const Stub& stub, const Member& member) {
  Session& session = need_session(stub);
  session.check_member(stub, member);
  return session;
}

// An end that takes values from now on: they may come before the answer to the request.
std::shared_ptr<ClientWireEnd> begin_connecting(const Stub& stub, const Member& member) {
  Session& session = need_session(stub, member);
  auto end = std::make_shared<ClientWireEnd>(stub.rr_session(), stub.rr_path(), member);
  switch (session.wires().add(end)) {
    case endpoint::WireTable::Added::exists:
      throw Error(ErrorCode::invalid_operation,
                  "the wire `" + std::string(member.name) + "` is connected already");
    case endpoint::WireTable::Added::ended:
      session.refuse_ended();
    case endpoint::WireTable::Added::yes:
      break;
  }
  return end;
}

Session::AnswerReader connect_reader(std::shared_ptr<ClientWireEnd> end) {
  return [end = std::move(end)](Decoder& decoder, const Message&, const Entry& entry) {
    end->take_answer(decoder, entry);
  };
}

// What comes now is for nobody who waits for an answer.
void end_connecting(Session& session, ClientWireEnd& end) {
  end.open();
  session.connection().expect();
}

// Hands on a completion, and drops the end when it could not be connected.
class ConnectCompletion final : public Completion {
 public:
  ConnectCompletion(std::shared_ptr<Session> session, std::shared_ptr<ClientWireEnd> end,
                    WireEnd* place, std::unique_ptr<Completion> completion)
      : session_(std::move(session)),
        end_(std::move(end)),
        place_(place),
        completion_(std::move(completion)) {}

  void* result() override { return nullptr; }
  void succeed() override {
    end_connecting(*session_, *end_);
    *place_ = WireEnd(end_);
    completion_->succeed();
  }
  void fail(std::exception_ptr error) override {
    end_->give_up();
    completion_->fail(std::move(error));
  }

 private:
  const std::shared_ptr<Session> session_;
  const std::shared_ptr<ClientWireEnd> end_;
  WireEnd* const place_;  // in the completion
  const std::unique_ptr<Completion> completion_;
};

Session::AnswerReader value_reader(const Member& member, void* value, TimeSpec* time) {
  return [&member, value, time](Decoder& decoder, const Message&, const Entry& entry) {
    endpoint::read_wire(decoder, entry, *member.type, *time, value);
  };
}

Outgoing peek_request(const Stub& stub, const Member& member, bool of_out) {
  return {of_out ? EntryType::wire_peek_out_value_req : EntryType::wire_peek_in_value_req,
          stub.rr_path(), member.name};
}

}  // namespace

WireEnd WireMember::connect_end() {
  Session& session = need_session(*stub_);
  const std::shared_ptr<ClientWireEnd> end = begin_connecting(*stub_, *member_);
  const client::WireRequest request(endpoint::slots_element, end->wanted_mode());
  try {
    session.call(request.to(end->path(), member_->name), connect_reader(end), stub_->rr_timeout());
  } catch (...) {
    end->give_up();
    throw;
  }
  end_connecting(session, *end);
  return WireEnd(end);
}

void WireMember::start_connect(WireEnd* end, std::unique_ptr<Completion> completion) {
  Session& session = need_session(*stub_);
  std::shared_ptr<ClientWireEnd> made;
  try {
    made = begin_connecting(*stub_, *member_);
  } catch (const Error&) {
    // Not from inside the call that starts it.
    session.post(
        {[shared = std::shared_ptr<Completion>(std::move(completion)),
          error = std::current_exception()]() mutable { shared->fail(std::move(error)); }});
    return;
  }
  auto connecting =
      std::make_shared<ConnectCompletion>(stub_->rr_session(), made, end, std::move(completion));
  const client::WireRequest request(endpoint::slots_element, made->wanted_mode());
  session.start(request.to(made->path(), member_->name), connect_reader(made), stub_->rr_timeout(),
                std::move(connecting));
}

void WireMember::peek_in(void* value, TimeSpec& time) {
  need_session(*stub_, *member_)
      .call(peek_request(*stub_, *member_, false), value_reader(*member_, value, &time),
            stub_->rr_timeout());
}

void WireMember::peek_out(void* value, TimeSpec& time) {
  need_session(*stub_, *member_)
      .call(peek_request(*stub_, *member_, true), value_reader(*member_, value, &time),
            stub_->rr_timeout());
}

void WireMember::start_peek(bool of_out, void* value, TimeSpec* time,
                            std::unique_ptr<Completion> completion) {
  Session& session = need_session(*stub_);
  if (session.refuse_start(*stub_, *member_, completion)) return;
  session.start(peek_request(*stub_, *member_, of_out), value_reader(*member_, value, time),
                stub_->rr_timeout(), std::shared_ptr<Completion>(std::move(completion)));
}

void WireMember::poke_out(const void* value) {
  Session& session = need_session(*stub_, *member_);
  const TimeSpec now = endpoint::as_time_spec(session.core()->clock().now());
  const endpoint::WireParameters elements(*member_->type, now, value);
  session.call({EntryType::wire_poke_out_value_req, stub_->rr_path(), member_->name,
                elements.parameters, elements.values},
               Incoming{}, stub_->rr_timeout());
}

void WireMember::start_poke(const void* value, std::unique_ptr<Completion> completion) {
  Session& session = need_session(*stub_);
  if (session.refuse_start(*stub_, *member_, completion)) return;
  const TimeSpec now = endpoint::as_time_spec(session.core()->clock().now());
  const endpoint::WireParameters elements(*member_->type, now, value);
  session.start({EntryType::wire_poke_out_value_req, stub_->rr_path(), member_->name,
                 elements.parameters, elements.values},
                Incoming{}, stub_->rr_timeout(),
                std::shared_ptr<Completion>(std::move(completion)));
}

}  // namespace rr
