// SPDX-License-Identifier: Apache-2.0
// Wires, pipes and memories of objects that the interpreter serves.
#include <algorithm>

#include "rr/error.hpp"
#include "runtime/matlab/src/credentials.hpp"
#include "runtime/matlab/src/served.hpp"

namespace rr::matlab {
namespace {

using dynamic::MemberDescription;
using dynamic::PipeEndpoint;
using dynamic::ServedWire;
using dynamic::Value;

// served_in(object, wire, value)
void served_in(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const MemberDescription member = served->object.member(call.text(1));
  served->object.wire(member.name).set_in(served->read(call[2], member.type, member.name));
}

// served_out(object, wire): the newest value of any client and its time; [] and [] for none
void served_out(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const MemberDescription member = served->object.member(call.text(1));
  const auto value = served->object.wire(member.name).out();
  call.give(value ? served->write(member.type, value->value) : make_null());
  call.give(value ? time_to_mex(value->time) : make_null());
}

void send_to(PipeEndpoint& end, const Value& packet, bool wants_ack) {
  end.ask_for_acknowledgements(wants_ack);
  end.send(packet);
  end.ask_for_acknowledgements(false);
}

// served_send(object, pipe, packet [, wants_ack]): to all endpoints
void served_send(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const MemberDescription member = served->object.member(call.text(1));
  const Value packet = served->read(call[2], member.type, member.name);
  if (!call.has(3) || !read_number<bool>(call[3])) {
    served->object.pipe(member.name).send(packet);
    return;
  }
  for (PipeEndpoint& end : served->object.pipe(member.name).endpoints()) {
    send_to(end, packet, true);
  }
}

// served_endpoints(object, pipe): a column of structs with client and index
void served_endpoints(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const auto ends = served->object.pipe(call.text(1)).endpoints();
  const char* names[] = {"client", "index"};
  mxArray* const found = mxCreateStructMatrix(static_cast<mwSize>(ends.size()), 1, 2, names);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto place = static_cast<mwIndex>(i);
    mxSetFieldByNumber(found, place, 0, make_number<std::uint32_t>(ends[i].client()));
    mxSetFieldByNumber(found, place, 1, make_number<std::int32_t>(ends[i].index()));
  }
  call.give(found);
}

// served_send_to(object, pipe, endpoint, packet, wants_ack): as served_endpoints gives it
void served_send_to(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const MemberDescription member = served->object.member(call.text(1));
  const auto client = read_number<std::uint32_t>(read_field(call[2], "client"));
  const auto index = read_number<std::int32_t>(read_field(call[2], "index"));
  const Value packet = served->read(call[3], member.type, member.name);
  for (PipeEndpoint& end : served->object.pipe(member.name).endpoints()) {
    if (end.client() != client || end.index() != index) continue;
    send_to(end, packet, read_number<bool>(call[4]));
    return;
  }
  throw Error(ErrorCode::invalid_operation, "member " + member.name + ": the endpoint is closed");
}

// served_disconnect(object, wire or pipe): ends all connections of clients
void served_disconnect(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const MemberDescription member = served->object.member(call.text(1));
  if (member.kind == MemberKind::wire) {
    for (ServedWire& end : served->object.wire(member.name).connections()) end.close();
  } else {
    for (PipeEndpoint& end : served->object.pipe(member.name).endpoints()) end.close();
  }
}

// What becomes of one wire or pipe, for the object's function.
struct Listening {
  std::shared_ptr<Answerer> answerer;
  std::shared_ptr<ServedTypes> types;
  MemberDescription member;
  std::shared_ptr<Queue> queue;

  // `dispatch(kind, member, ...)`: among the requests, in the order in which all has come.
  void push(const char* kind, std::function<std::vector<mxArray*>()> make) const {
    queue->push_request([self = *this, kind, make = std::move(make)] {
      try {
        std::vector<mxArray*> given{make_text(kind), make_text(self.member.name)};
        as_subject("member " + self.member.name, [&] {
          for (mxArray* const one : make()) given.push_back(one);
        });
        self.answerer->call(std::move(given));
      } catch (const Error& error) {
        mexWarnMsgIdAndTxt("RobotRaconteur:HandlerFailed", "a handler has failed: %s",
                           error.what());
      }
    });
  }
  void push_value(const Value& value, std::uint32_t client) const {
    push("on", [self = *this, value, client]() -> std::vector<mxArray*> {
      return {to_mex(value, *self.types->plans.plan(self.member.type), self.types->plans),
              make_number<std::uint32_t>(client)};
    });
  }
  void push_connected(std::uint32_t client) const {
    push("connected",
         [client]() -> std::vector<mxArray*> { return {make_number<std::uint32_t>(client)}; });
  }
  // What is peeked: a thread of the node waits for it.
  [[nodiscard]] Value peek(const char* kind) const {
    return answerer->ask<Value>([&](Runtime&) {
      const mxArray* const given = answerer->call({make_text(kind), make_text(member.name)});
      return read_served(*types, given, member.type, "member " + member.name);
    });
  }
};

void listen_wire(const dynamic::WireServer& wire, const Listening& listening,
                 const std::string& kind) {
  if (kind == "on") {
    wire.on_out([listening](const Value& value, const TimeSpec&, std::uint32_t client) {
      listening.push_value(value, client);
    });
  } else if (kind == "connected") {
    wire.on_connect([listening](const ServedWire& end) { listening.push_connected(end.client()); });
  } else if (kind == "peek_in") {
    wire.on_peek_in([listening] { return listening.peek("peek_in"); });
  } else {
    wire.on_peek_out([listening] { return listening.peek("peek_out"); });
  }
}

// served_listen(object, wire or pipe, kinds): 'on' (of a wire the newest value only), 'connected';
// of a wire also 'peek_in', 'peek_out', which give what is peeked
void served_listen(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const MemberDescription member = served->object.member(call.text(1));
  const Listening listening{served->answerer, served->types, member, runtime.queue()};
  const std::vector<std::string> kinds = read_texts(call[2]);
  if (member.kind == MemberKind::wire) {
    for (const std::string& kind : kinds) {
      listen_wire(served->object.wire(member.name), listening, kind);
    }
    return;
  }
  const bool hears_packets = std::find(kinds.begin(), kinds.end(), "on") != kinds.end();
  const bool hears_clients = std::find(kinds.begin(), kinds.end(), "connected") != kinds.end();
  served->object.pipe(member.name).on_connect([=](PipeEndpoint end) {
    const std::uint32_t client = end.client();
    if (hears_clients) listening.push_connected(client);
    if (!hears_packets) return;
    end.on_packet(
           [listening, client](const Value& packet) { listening.push_value(packet, client); })
        .detach();
  });
}

// served_memory(object, memory [, content]): its content
void served_memory(Runtime& runtime, Call& call) {
  const auto served = served_of(runtime, call);
  const MemberDescription member = served->object.member(call.text(1));
  if (call.has(2)) {
    served->object.store_memory(member.name, served->read(call[2], member.type, member.name));
    return;
  }
  call.give(served->write(member.type, served->object.stored_memory(member.name)));
}

// served_monitor(object): clients may have it to themselves
void served_monitor(Runtime& runtime, Call& call) { served_of(runtime, call)->enable_monitor(); }

}  // namespace

std::vector<Command> served_commands() {
  return {{"served_in", served_in},
          {"served_out", served_out},
          {"served_send", served_send},
          {"served_disconnect", served_disconnect},
          {"served_endpoints", served_endpoints},
          {"served_send_to", served_send_to},
          {"served_listen", served_listen},
          {"served_memory", served_memory},
          {"served_monitor", served_monitor}};
}

}  // namespace rr::matlab
