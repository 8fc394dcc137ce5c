// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"
#include "runtime/matlab/src/listeners.hpp"
#include "runtime/matlab/src/members.hpp"

namespace rr::matlab {
namespace {

using dynamic::PipeEndpoint;
using dynamic::Value;

struct PipeHandle final : MemberHandle {
  PipeHandle(const ObjectHandle& object, const Resolved& of, PipeEndpoint given)
      : MemberHandle(object, of), end(std::move(given)) {
    end.on_closed(
        [heard = closed] { Listeners::tell(heard, [] { return std::vector<mxArray*>(); }); });
    end.on_acknowledged([heard = acknowledged](std::uint32_t number) {
      Listeners::tell(heard, [number] { return std::vector<mxArray*>{make_number(number)}; });
    });
  }
  const std::shared_ptr<Listeners> closed = std::make_shared<Listeners>(connection->runtime());
  const std::shared_ptr<Listeners> acknowledged =
      std::make_shared<Listeners>(connection->runtime());
  bool wants_acks = false;
  PipeEndpoint end;
};

std::shared_ptr<PipeHandle> pipe_of(Runtime& runtime, Call& call) {
  return handle_of<PipeHandle>(runtime, call);
}

// pipe_connect(object, name [, index]): number
void connect_pipe(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const Resolved& member = object->resolve(call.text(1));
  const PipeOptions options{.index = call.has(2) ? read_number<std::int32_t>(call[2]) : -1,
                            .unreliable = (member.member.access & unreliable) != 0};
  const dynamic::Pipe pipe = object->object().pipe(member.member.name);
  auto end =
      runtime.call<PipeEndpoint>([&] { return pipe.connect(options); },
                                 [&](auto done) { pipe.async_connect(std::move(done), options); });
  call.give(give_handle(runtime, std::make_shared<PipeHandle>(*object, member, std::move(end))));
}

// pipe_send(endpoint, packet): number of the packet
void send(Runtime& runtime, Call& call) {
  const auto pipe = pipe_of(runtime, call);
  call.give(make_number(pipe->end.send(pipe->read(call[1]))));
}

// pipe_receive(endpoint): packet
void receive(Runtime& runtime, Call& call) {
  const auto pipe = pipe_of(runtime, call);
  call.give(pipe->write(pipe->end.receive()));
}

// pipe_receive_wait(endpoint, seconds, only_peek): [has_come, packet]
void receive_wait(Runtime& runtime, Call& call) {
  const auto pipe = pipe_of(runtime, call);
  const bool only_peeks = call.has(2) && read_number<bool>(call[2]);
  (void)runtime.wait_until([&] { return pipe->end.available() != 0 || !pipe->end.is_open(); },
                           call.seconds(1));
  const auto packet = only_peeks ? pipe->end.peek() : pipe->end.try_receive();
  call.give(mxCreateLogicalScalar(packet.has_value()));
  call.give(packet ? pipe->write(*packet) : make_null());
}

// pipe_available(endpoint)
void available(Runtime& runtime, Call& call) {
  call.give(mxCreateDoubleScalar(static_cast<double>(pipe_of(runtime, call)->end.available())));
}

// pipe_about(endpoint): struct with index, is_open, is_unreliable, lost_count
void about_pipe(Runtime& runtime, Call& call) {
  const auto pipe = pipe_of(runtime, call);
  call.give(make_struct(
      {{"index", make_number(pipe->end.index())},
       {"is_open", mxCreateLogicalScalar(pipe->end.is_open())},
       {"is_unreliable", mxCreateLogicalScalar(pipe->end.is_unreliable())},
       {"wants_acks", mxCreateLogicalScalar(pipe->wants_acks)},
       {"lost_count", mxCreateDoubleScalar(static_cast<double>(pipe->end.lost_count()))}}));
}

// pipe_listen(endpoint, function): number of the listener; the function gets each packet
void listen_to_pipe(Runtime& runtime, Call& call) {
  const auto pipe = pipe_of(runtime, call);
  const std::uint64_t number = add_listener(*pipe, call[1]);
  auto subscription =
      pipe->end.on_packet([&runtime, number, queue = runtime.queue()](const Value& packet) {
        queue->push([&runtime, number, packet] { run_listener(runtime, number, packet, nullptr); });
      });
  keep_listener(runtime, number, std::move(subscription));
  call.give(make_number(number));
}

// pipe_hear(endpoint, 'closed' | 'acknowledged', function): number of the listener; the second gets
// the number of each packet
void hear_pipe(Runtime& runtime, Call& call) {
  const auto pipe = pipe_of(runtime, call);
  const std::uint64_t number = add_listener(*pipe, call[2]);
  (call.text(1) == "closed" ? pipe->closed : pipe->acknowledged)->add(number);
  call.give(make_number(number));
}

// pipe_ask_acks(endpoint, on): whether packets are acknowledged from now on
void ask_acks(Runtime& runtime, Call& call) {
  const auto pipe = pipe_of(runtime, call);
  pipe->wants_acks = read_number<bool>(call[1]);
  pipe->end.ask_for_acknowledgements(pipe->wants_acks);
}

// pipe_queue_limit(endpoint, packets, 'oldest' | 'newest' | 'close'): what is lost when it is full
void queue_limit(Runtime& runtime, Call& call) {
  const auto pipe = pipe_of(runtime, call);
  const auto packets = read_number<std::uint32_t>(call[1]);
  const std::string lost = call.has(2) ? call.text(2) : "close";
  if (lost != "oldest" && lost != "newest" && lost != "close") {
    throw Error(ErrorCode::invalid_argument,
                pipe->subject + ": expected 'oldest', 'newest' or 'close'");
  }
  pipe->end.set_queue_limit(packets, lost == "oldest"   ? WhenFull::drop_oldest
                                     : lost == "newest" ? WhenFull::drop_newest
                                                        : WhenFull::close);
}

// pipe_close(endpoint)
void close_pipe(Runtime& runtime, Call& call) { pipe_of(runtime, call)->end.close(); }

}  // namespace

std::vector<Command> pipe_commands() {
  return {{"pipe_connect", connect_pipe},  {"pipe_send", send},
          {"pipe_receive", receive},       {"pipe_receive_wait", receive_wait},
          {"pipe_available", available},   {"pipe_about", about_pipe},
          {"pipe_listen", listen_to_pipe}, {"pipe_queue_limit", queue_limit},
          {"pipe_hear", hear_pipe},        {"pipe_ask_acks", ask_acks},
          {"pipe_close", close_pipe}};
}

}  // namespace rr::matlab
