// SPDX-License-Identifier: Apache-2.0
// Wires of a client, and the ends of both sides.
#include <utility>

#include "runtime/c/src/node.hpp"
#include "runtime/c/src/streams.hpp"

namespace rr::capi {
namespace {

class RawWire : public WireMember {
 public:
  RawWire(RawStub& stub, rr_str member, std::uint32_t access)
      : WireMember(stub, stub.tables().member(text(member), MemberKind::wire, access_of(access)),
                   holding_of<Raw>) {}
  using WireMember::connect_end;
  using WireMember::peek_in;
  using WireMember::peek_out;
  using WireMember::poke_out;
  using WireMember::start_connect;
  using WireMember::start_peek;
  using WireMember::start_poke;
};

rr_wire* make_wire(const std::shared_ptr<ClientTables>& tables, WireEnd end) {
  return new rr_wire{tables, RawWireEnd(std::move(end))};
}

const RawWireEnd& end_of(const rr_wire* wire) { return need(wire, "there is no wire").end; }
RawWireEnd& end_of(rr_wire* wire) { return need(wire, "there is no wire").end; }

void set_time(rr_time* place, const TimeSpec& time) {
  if (place != nullptr) *place = time_of(time);
}

rr_data* hand_out_value(const std::shared_ptr<const void>& value) {
  if (!value) throw Error(ErrorCode::value_not_set, "Value not set");
  return Data(static_cast<const Raw*>(value.get())->data).hand_out();
}

void set_handler(rr_wire* handle, const rr_wire_handler* given) {
  auto functions = given != nullptr ? take_handler(given) : nullptr;
  rr_wire& wire = need(handle, "there is no wire");
  wire.told->exchange(functions);
  wire.told->received().exchange({}).disconnect();
  if (!functions) return;
  if ((*functions)->on_value != nullptr) {
    auto values = wire.end.on_received([functions](const void* value, const TimeSpec& time) {
      const Data& data = static_cast<const Raw*>(value)->data;
      const rr_elements elements = data.elements();
      const rr_time when = time_of(time);
      (*functions)->on_value((*functions)->context, &elements, &when, data.get());
    });
    wire.told->received()
        .exchange(std::move(values))
        .disconnect();  // of another thread, which came first
  }
  tell_closed(wire.end, wire.told, functions);
}

// A peek that nobody waits for: its value, and where its time goes.
struct Peeked {
  Raw value;
  TimeSpec time;
};

void start_peek(rr_object* object, rr_str member, bool of_out, const rr_call_options* options,
                rr_time* out_time, const rr_completion* completion) {
  const Terms terms(options);
  RawWire wire(stub_of(object), member, 0);
  auto done = complete<Peeked>(completion, [out_time](Peeked& peeked) -> void* {
    set_time(out_time, peeked.time);
    return std::move(peeked.value.data).hand_out();
  });
  Peeked& place = done->place();
  wire.start_peek(of_out, &place.value, &place.time, std::move(done));
}

}  // namespace
}  // namespace rr::capi

using rr::capi::end_of;
using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::output;
using rr::capi::RawWire;
using rr::capi::stub_of;
using rr::capi::Terms;

extern "C" {

rr_status rr_wire_connect(rr_object* object, rr_str member, uint32_t access,
                          const rr_call_options* options, rr_wire** out_wire, rr_error** error) {
  return guarded(error, [&] {
    output(out_wire) = nullptr;
    const Terms terms(options);
    RawWire wire(stub_of(object), member, access);
    *out_wire = rr::capi::make_wire(stub_of(object).shared_tables(), wire.connect_end());
  });
}

rr_status rr_wire_connect_async(rr_object* object, rr_str member, uint32_t access,
                                const rr_call_options* options, const rr_completion* completion,
                                rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    RawWire wire(stub_of(object), member, access);
    auto done = rr::capi::complete<rr::WireEnd>(
        completion, [tables = stub_of(object).shared_tables()](rr::WireEnd& end) -> void* {
          return rr::capi::make_wire(tables, std::move(end));
        });
    rr::WireEnd& place = done->place();
    wire.start_connect(&place, std::move(done));
  });
}

// The functions stay while the end is connected.
void rr_wire_release(rr_wire* wire) {
  guarded_or(0, [&] {
    if (wire != nullptr) wire->told->received().exchange({}).detach();
    return 0;
  });
  rr::capi::release(wire);
}

void rr_wire_close(rr_wire* wire) {
  guarded_or(0, [&] {
    end_of(wire).close();
    return 0;
  });
}

int32_t rr_wire_is_open(const rr_wire* wire) {
  return guarded_or(0, [&] { return end_of(wire).is_open() ? 1 : 0; });
}

uint32_t rr_wire_client(const rr_wire* wire) {
  return guarded_or(0U, [&] { return end_of(wire).client(); });
}

rr_status rr_wire_send(rr_wire* wire, const rr_elements* value, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawWireEnd& end = end_of(wire);
    const rr::capi::Values values(value);
    const rr::capi::Raw kept = rr::capi::keep(values.single());  // the end remembers it
    end.send(&kept);
  });
}

rr_status rr_wire_received(const rr_wire* wire, rr_data** out_value, rr_time* out_time,
                           rr_error** error) {
  return guarded(error, [&] {
    output(out_value) = nullptr;
    rr::TimeSpec time;
    *out_value = rr::capi::hand_out_value(end_of(wire).received(time));
    rr::capi::set_time(out_time, time);
  });
}

rr_status rr_wire_sent(const rr_wire* wire, rr_data** out_value, rr_time* out_time,
                       rr_error** error) {
  return guarded(error, [&] {
    output(out_value) = nullptr;
    rr::TimeSpec time;
    *out_value = rr::capi::hand_out_value(end_of(wire).sent(time));
    rr::capi::set_time(out_time, time);
  });
}

int32_t rr_wire_wait(const rr_wire* wire, int32_t timeout_ms) {
  return guarded_or(
      0, [&] { return end_of(wire).wait_received(rr::capi::patience(timeout_ms)) ? 1 : 0; });
}

void rr_wire_set_lifespan(rr_wire* wire, int32_t lifespan_ms) {
  guarded_or(0, [&] {
    end_of(wire).set_lifespan(std::chrono::milliseconds(std::max(lifespan_ms, 0)));
    return 0;
  });
}

rr_status rr_wire_set_handler(rr_wire* wire, const rr_wire_handler* handler, rr_error** error) {
  return guarded(error, [&] { rr::capi::set_handler(wire, handler); });
}

rr_status rr_wire_peek_in(rr_object* object, rr_str member, const rr_call_options* options,
                          rr_data** out_value, rr_time* out_time, rr_error** error) {
  return guarded(error, [&] {
    output(out_value) = nullptr;
    const Terms terms(options);
    rr::capi::Raw value;
    rr::TimeSpec time;
    RawWire(stub_of(object), member, 0).peek_in(&value, time);
    rr::capi::set_time(out_time, time);
    *out_value = std::move(value.data).hand_out();
  });
}

rr_status rr_wire_peek_out(rr_object* object, rr_str member, const rr_call_options* options,
                           rr_data** out_value, rr_time* out_time, rr_error** error) {
  return guarded(error, [&] {
    output(out_value) = nullptr;
    const Terms terms(options);
    rr::capi::Raw value;
    rr::TimeSpec time;
    RawWire(stub_of(object), member, 0).peek_out(&value, time);
    rr::capi::set_time(out_time, time);
    *out_value = std::move(value.data).hand_out();
  });
}

rr_status rr_wire_poke_out(rr_object* object, rr_str member, const rr_elements* value,
                           const rr_call_options* options, rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    const rr::capi::Values values(value);
    RawWire(stub_of(object), member, 0).poke_out(&values.single());
  });
}

rr_status rr_wire_peek_in_async(rr_object* object, rr_str member, const rr_call_options* options,
                                rr_time* out_time, const rr_completion* completion,
                                rr_error** error) {
  return guarded(
      error, [&] { rr::capi::start_peek(object, member, false, options, out_time, completion); });
}

rr_status rr_wire_peek_out_async(rr_object* object, rr_str member, const rr_call_options* options,
                                 rr_time* out_time, const rr_completion* completion,
                                 rr_error** error) {
  return guarded(
      error, [&] { rr::capi::start_peek(object, member, true, options, out_time, completion); });
}

rr_status rr_wire_poke_out_async(rr_object* object, rr_str member, const rr_elements* value,
                                 const rr_call_options* options, const rr_completion* completion,
                                 rr_error** error) {
  return guarded(error, [&] {
    const Terms terms(options);
    const rr::capi::Values values(value);
    RawWire(stub_of(object), member, 0)
        .start_poke(&values.single(), rr::capi::complete_with_nothing(completion));
  });
}

}  // extern "C"
