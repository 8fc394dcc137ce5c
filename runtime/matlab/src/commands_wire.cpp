// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"
#include "runtime/matlab/src/listeners.hpp"
#include "runtime/matlab/src/members.hpp"

namespace rr::matlab {
namespace {

using dynamic::Value;
using dynamic::WireConnection;

struct WireHandle final : MemberHandle {
  WireHandle(const ObjectHandle& object, const Resolved& of, WireConnection given)
      : MemberHandle(object, of), end(std::move(given)) {
    end.on_closed(
        [heard = closed] { Listeners::tell(heard, [] { return std::vector<mxArray*>(); }); });
  }
  const std::shared_ptr<Listeners> closed = std::make_shared<Listeners>(connection->runtime());
  WireConnection end;
  std::chrono::milliseconds lifespan{0};
};

std::shared_ptr<WireHandle> wire_of(Runtime& runtime, Call& call) {
  return handle_of<WireHandle>(runtime, call);
}

// wire_connect(object, name): number
void connect_wire(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const Resolved& member = object->resolve(call.text(1));
  const dynamic::Wire wire = object->object().wire(member.member.name);
  auto end = runtime.call<WireConnection>([&] { return wire.connect(); },
                                          [&](auto done) { wire.async_connect(std::move(done)); });
  call.give(give_handle(runtime, std::make_shared<WireHandle>(*object, member, std::move(end))));
}

void give_timed(Call& call, const MemberHandle& member, const Timed<Value>& timed) {
  call.give(member.write(timed.value));
  call.give(time_to_mex(timed.time));
}

// wire_in(wire): [value, time]
void in(Runtime& runtime, Call& call) {
  const auto wire = wire_of(runtime, call);
  const auto timed = wire->end.try_in();
  if (!timed) throw Error(ErrorCode::value_not_set, wire->subject + ": there is no value");
  give_timed(call, *wire, *timed);
}

// wire_try_in(wire): [is_valid, value, time]
void try_in(Runtime& runtime, Call& call) {
  const auto wire = wire_of(runtime, call);
  const auto timed = wire->end.try_in();
  call.give(mxCreateLogicalScalar(timed.has_value()));
  if (timed) give_timed(call, *wire, *timed);
}

// wire_out(wire): [value, time], as sent last
void out(Runtime& runtime, Call& call) {
  const auto wire = wire_of(runtime, call);
  const auto timed = wire->end.out();
  if (!timed) throw Error(ErrorCode::value_not_set, wire->subject + ": there is no value");
  give_timed(call, *wire, *timed);
}

// wire_has_out(wire)
void has_out(Runtime& runtime, Call& call) {
  call.give(mxCreateLogicalScalar(wire_of(runtime, call)->end.out().has_value()));
}

// wire_set_out(wire, value)
void set_out(Runtime& runtime, Call& call) {
  const auto wire = wire_of(runtime, call);
  wire->end.set_out(wire->read(call[1]));
}

// wire_wait(wire, seconds): whether there is a value
void wait(Runtime& runtime, Call& call) {
  const auto wire = wire_of(runtime, call);
  const bool has_come = runtime.wait_until(
      [&] { return wire->end.try_in().has_value() || !wire->end.is_open(); }, call.seconds(1));
  call.give(mxCreateLogicalScalar(has_come && wire->end.try_in().has_value()));
}

// wire_lifespan(wire [, seconds]): seconds; less than zero for no limit
void lifespan(Runtime& runtime, Call& call) {
  const auto wire = wire_of(runtime, call);
  if (call.has(1)) {
    const auto limit = call.seconds(1);
    wire->lifespan = limit == std::chrono::milliseconds::max() ? std::chrono::milliseconds(0)
                                                               : std::max(limit, min_lifespan);
    wire->end.set_lifespan(wire->lifespan);
  }
  const double seconds = std::chrono::duration<double>(wire->lifespan).count();
  call.give(mxCreateDoubleScalar(wire->lifespan.count() == 0 ? -1 : seconds));
}

// wire_listen(wire, function): number of the listener
void listen_to_wire(Runtime& runtime, Call& call) {
  const auto wire = wire_of(runtime, call);
  const std::uint64_t number = add_listener(*wire, call[1]);
  // Only the newest value of a wire waits for the interpreter's thread.
  auto subscription = wire->end.on_in([&runtime, number, queue = runtime.queue()](
                                          const Value& value, const TimeSpec& time) {
    queue->push([&runtime, number, value, time] { run_listener(runtime, number, value, &time); },
                number);
  });
  keep_listener(runtime, number, std::move(subscription));
  call.give(make_number(number));
}

// wire_hear(wire, function): number of the listener, which is called when the wire is closed
void hear_wire(Runtime& runtime, Call& call) {
  const auto wire = wire_of(runtime, call);
  const std::uint64_t number = add_listener(*wire, call[1]);
  wire->closed->add(number);
  call.give(make_number(number));
}

// wire_peek(object, name, of_out): [value, time]
void peek(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const Resolved& member = object->resolve(call.text(1));
  const bool of_out = read_number<bool>(call[2]);
  const dynamic::Wire wire = object->object().wire(member.member.name);
  const auto timed = runtime.call<Timed<Value>>(
      [&] { return of_out ? wire.peek_out() : wire.peek_in(); },
      [&](auto done) {
        of_out ? wire.async_peek_out(std::move(done)) : wire.async_peek_in(std::move(done));
      });
  give_timed(call, MemberHandle(*object, member), timed);
}

// wire_poke(object, name, value)
void poke(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const Resolved& member = object->resolve(call.text(1));
  const dynamic::Wire wire = object->object().wire(member.member.name);
  const Value value = read_value(*object, call[2], member.plan, member.subject);
  runtime.call<>([&] { wire.poke_out(value); },
                 [&](auto done) { wire.async_poke_out(value, std::move(done)); });
}

// wire_close(wire)
void close_wire(Runtime& runtime, Call& call) { wire_of(runtime, call)->end.close(); }

// wire_is_open(wire)
void is_open(Runtime& runtime, Call& call) {
  call.give(mxCreateLogicalScalar(wire_of(runtime, call)->end.is_open()));
}

}  // namespace

std::vector<Command> wire_commands() {
  return {{"wire_connect", connect_wire},
          {"wire_in", in},
          {"wire_try_in", try_in},
          {"wire_out", out},
          {"wire_has_out", has_out},
          {"wire_set_out", set_out},
          {"wire_wait", wait},
          {"wire_lifespan", lifespan},
          {"wire_listen", listen_to_wire},
          {"wire_peek", peek},
          {"wire_poke", poke},
          {"wire_close", close_wire},
          {"wire_is_open", is_open},
          {"wire_hear", hear_wire}};
}

}  // namespace rr::matlab
