// SPDX-License-Identifier: Apache-2.0
// Pipes of a client, and the ends of both sides.
#include <utility>

#include "runtime/c/src/node.hpp"
#include "runtime/c/src/streams.hpp"

namespace rr::capi {
namespace {

class RawPipe : public PipeMember {
 public:
  RawPipe(Stub& stub, const Member& member) : PipeMember(stub, member, holding_of<Raw>) {}
  using PipeMember::connect_end;
  using PipeMember::start_connect;
};

// A pipe of an object and how it is to be connected.
class Connection {
 public:
  Connection(RawStub& stub, rr_str member, const rr_pipe_options* given)
      : Connection(stub, member, given != nullptr ? known(given) : nothing()) {}
  [[nodiscard]] RawPipe& pipe() { return pipe_; }
  [[nodiscard]] const PipeOptions& options() const { return options_; }

 private:
  Connection(RawStub& stub, rr_str member, const rr_pipe_options& given)
      : pipe_(stub, stub.tables().member(text(member), MemberKind::pipe, access_of(given.access))),
        options_{.index = given.index, .unreliable = given.reliable == 0} {}
  static rr_pipe_options nothing() {
    rr_pipe_options options{};
    options.index = -1;
    return options;
  }

  RawPipe pipe_;
  const PipeOptions options_;
};

rr_pipe* make_pipe(const std::shared_ptr<ClientTables>& tables, PipeEnd end) {
  return new rr_pipe{tables, RawPipeEnd(std::move(end))};
}

const RawPipeEnd& end_of(const rr_pipe* pipe) { return need(pipe, "there is no pipe").end; }
RawPipeEnd& end_of(rr_pipe* pipe) { return need(pipe, "there is no pipe").end; }

Data data_of(const std::shared_ptr<const void>& packet) {
  return packet ? static_cast<const Raw*>(packet.get())->data : Data();
}

// The end tells this handle's functions from now on, whichever they are.
void begin_telling(rr_pipe& pipe) {
  if (!pipe.told->begin()) return;
  pipe.end.on_acknowledged([told = pipe.told](std::uint32_t number) {
    const auto functions = told->now();
    if (functions && (*functions)->on_acknowledged != nullptr) {
      (*functions)->on_acknowledged((*functions)->context, number);
    }
  });
}

void set_handler(rr_pipe* handle, const rr_pipe_handler* given) {
  auto functions = given != nullptr ? take_handler(given) : nullptr;
  rr_pipe& pipe = need(handle, "there is no pipe");
  begin_telling(pipe);
  pipe.told->exchange(functions);
  pipe.told->received().exchange({}).disconnect();
  if (!functions) return;
  if ((*functions)->on_packet != nullptr) {
    auto packets = pipe.end.on_received([functions](const std::shared_ptr<void>& packet) {
      const Data data = data_of(packet);
      const rr_elements elements = data.elements();
      (*functions)->on_packet((*functions)->context, &elements, data.get());
    });
    pipe.told->received()
        .exchange(std::move(packets))
        .disconnect();  // of another thread, which came first
  }
  tell_closed(pipe.end, pipe.told, functions);
}

}  // namespace
}  // namespace rr::capi

using rr::capi::end_of;
using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::output;
using rr::capi::stub_of;
using rr::capi::Terms;

extern "C" {

rr_status rr_pipe_connect(rr_object* object, rr_str member, const rr_pipe_options* pipe_options,
                          const rr_call_options* options, rr_pipe** out_pipe, rr_error** error) {
  return guarded(error, [&] {
    output(out_pipe) = nullptr;
    rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    rr::capi::Connection connection(stub, member, pipe_options);
    *out_pipe = rr::capi::make_pipe(stub.shared_tables(),
                                    connection.pipe().connect_end(connection.options()));
  });
}

rr_status rr_pipe_connect_async(rr_object* object, rr_str member,
                                const rr_pipe_options* pipe_options, const rr_call_options* options,
                                const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawStub& stub = stub_of(object);
    const Terms terms(options);
    rr::capi::Connection connection(stub, member, pipe_options);
    connection.pipe().start_connect(
        connection.options(),
        rr::capi::complete<rr::PipeEnd>(completion,
                                        [tables = stub.shared_tables()](rr::PipeEnd& end) -> void* {
                                          return rr::capi::make_pipe(tables, std::move(end));
                                        }));
  });
}

// The functions stay while the end is connected.
void rr_pipe_release(rr_pipe* pipe) {
  guarded_or(0, [&] {
    if (pipe != nullptr) pipe->told->received().exchange({}).detach();
    return 0;
  });
  rr::capi::release(pipe);
}

void rr_pipe_close(rr_pipe* pipe) {
  guarded_or(0, [&] {
    end_of(pipe).close();
    return 0;
  });
}

int32_t rr_pipe_is_open(const rr_pipe* pipe) {
  return guarded_or(0, [&] { return end_of(pipe).is_open() ? 1 : 0; });
}

int32_t rr_pipe_index(const rr_pipe* pipe) {
  return guarded_or(-1, [&] { return end_of(pipe).index(); });
}

int32_t rr_pipe_is_unreliable(const rr_pipe* pipe) {
  return guarded_or(0, [&] { return end_of(pipe).is_unreliable() ? 1 : 0; });
}

uint32_t rr_pipe_client(const rr_pipe* pipe) {
  return guarded_or(0U, [&] { return end_of(pipe).client(); });
}

rr_status rr_pipe_send(rr_pipe* pipe, const rr_elements* packet, uint32_t* out_number,
                       rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawPipeEnd& end = end_of(pipe);
    const rr::capi::Values values(packet);
    const uint32_t number = end.send(&values.single());
    if (out_number != nullptr) *out_number = number;
  });
}

int32_t rr_pipe_wait_sent(const rr_pipe* pipe, int32_t timeout_ms, size_t bytes) {
  return guarded_or(
      0, [&] { return end_of(pipe).wait_sent(rr::capi::patience(timeout_ms), bytes) ? 1 : 0; });
}

rr_status rr_pipe_receive(rr_pipe* pipe, rr_data** out_packet, rr_error** error) {
  return guarded(error, [&] {
    output(out_packet) = nullptr;
    *out_packet = rr::capi::data_of(end_of(pipe).take()).hand_out();
  });
}

rr_status rr_pipe_peek(const rr_pipe* pipe, rr_data** out_packet, rr_error** error) {
  return guarded(error, [&] {
    output(out_packet) = nullptr;
    *out_packet = rr::capi::data_of(end_of(pipe).peek()).hand_out();
  });
}

int32_t rr_pipe_wait(const rr_pipe* pipe, int32_t timeout_ms) {
  return guarded_or(0, [&] { return end_of(pipe).wait(rr::capi::patience(timeout_ms)) ? 1 : 0; });
}

rr_status rr_pipe_receive_async(rr_pipe* pipe, const rr_completion* completion, rr_error** error) {
  return rr_pipe_receive_within_async(pipe, nullptr, completion, error);
}

rr_status rr_pipe_receive_within_async(rr_pipe* pipe, const rr_call_options* options,
                                       const rr_completion* completion, rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    end_of(pipe).start_receive(rr::capi::complete<std::shared_ptr<void>>(
        completion, [](std::shared_ptr<void>& packet) -> void* {
          return rr::capi::data_of(packet).hand_out();
        }));
  });
}

size_t rr_pipe_available(const rr_pipe* pipe) {
  return guarded_or(size_t{0}, [&] { return end_of(pipe).available(); });
}

rr_status rr_pipe_set_queue_limit(rr_pipe* pipe, size_t packets, size_t bytes, uint32_t when_full,
                                  rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawPipeEnd& end = end_of(pipe);
    if (when_full > RR_CLOSE) rr::capi::refuse_argument("there is no such rule for a full queue");
    constexpr size_t usual = size_t{64} * 1024 * 1024;
    end.set_queue_limit(packets, static_cast<rr::WhenFull>(when_full), bytes != 0 ? bytes : usual);
  });
}

size_t rr_pipe_lost_count(const rr_pipe* pipe) {
  return guarded_or(size_t{0}, [&] { return end_of(pipe).lost_count(); });
}

void rr_pipe_ask_for_acknowledgements(rr_pipe* pipe, int32_t on) {
  guarded_or(0, [&] {
    end_of(pipe).ask_for_acknowledgements(on != 0);
    return 0;
  });
}

size_t rr_pipe_unacknowledged(const rr_pipe* pipe) {
  return guarded_or(size_t{0}, [&] { return end_of(pipe).unacknowledged(); });
}

rr_status rr_pipe_set_handler(rr_pipe* pipe, const rr_pipe_handler* handler, rr_error** error) {
  return guarded(error, [&] { rr::capi::set_handler(pipe, handler); });
}

}  // extern "C"
