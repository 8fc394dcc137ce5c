// SPDX-License-Identifier: Apache-2.0
// Pipes and wires of objects that a service offers.
#include <algorithm>
#include <utility>

#include "runtime/c/src/served_object.hpp"
#include "runtime/c/src/streams.hpp"

namespace rr::capi {
namespace {

rr_pipe* make_pipe(const RawSkeleton& object, PipeEnd end) {
  return new rr_pipe{object.type(), RawPipeEnd(std::move(end))};
}
rr_wire* make_wire(const RawSkeleton& object, WireEnd end) {
  return new rr_wire{object.type(), RawWireEnd(std::move(end))};
}

// Handles for as many ends as there is room for.
template <class Handle, class Ends, class Make>
void hand_out(const Ends& ends, Handle** handles, std::size_t* count, const Make& make) {
  const std::size_t room = output(count);
  const std::size_t stored = std::min(room, ends.size());
  if (stored != 0) need(handles, "there is no room for handles");
  *count = ends.size();
  for (std::size_t i = 0; i < stored; ++i) handles[i] = make(ends[i]);
}

// Functions that are kept by the object itself: it is there when they are called.
void set_handler(const rr_served_object* handle, std::uint32_t place,
                 const rr_served_wire_handler* given) {
  const auto functions = take_handler(given);
  const RawSkeleton& object = skeleton_of(handle);
  const RawWireServer wire(object, place);
  if ((*functions)->on_connect != nullptr) {
    wire.set_connected([functions, of = &object](WireEnd end) {
      (*functions)->on_connect((*functions)->context, make_wire(*of, std::move(end)));
    });
  }
  if ((*functions)->on_value != nullptr) {
    wire.set_received([functions](const void* value, const TimeSpec& time, std::uint32_t client) {
      const Data& data = static_cast<const Raw*>(value)->data;
      const rr_elements elements = data.elements();
      const rr_time when = time_of(time);
      (*functions)->on_value((*functions)->context, client, &elements, &when, data.get());
    });
  }
  if ((*functions)->handles_peek_in != 0) {
    wire.set_peek_in(
        [functions, of = &object, place] { return of->peek(RR_REQUEST_PEEK_IN, place); });
  }
  if ((*functions)->handles_peek_out != 0) {
    wire.set_peek_out(
        [functions, of = &object, place] { return of->peek(RR_REQUEST_PEEK_OUT, place); });
  }
}

}  // namespace
}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::output;
using rr::capi::RawPipeServer;
using rr::capi::RawWireServer;
using rr::capi::skeleton_of;
using rr::capi::Values;

extern "C" {

rr_status rr_served_pipe_set_handler(rr_served_object* object, uint32_t member,
                                     const rr_served_pipe_handler* handler, rr_error** error) {
  return guarded(error, [&] {
    const auto functions = rr::capi::take_handler(handler, &rr_served_pipe_handler::on_connect);
    const rr::capi::RawSkeleton& skeleton = skeleton_of(object);
    RawPipeServer(skeleton, member).set_connected([functions, of = &skeleton](rr::PipeEnd end) {
      (*functions)->on_connect((*functions)->context, rr::capi::make_pipe(*of, std::move(end)));
    });
  });
}

rr_status rr_served_pipe_send(rr_served_object* object, uint32_t member, const rr_elements* packet,
                              rr_error** error) {
  return guarded(error, [&] {
    const RawPipeServer pipe(skeleton_of(object), member);
    const Values values(packet);
    pipe.send_all(&values.single());
  });
}

rr_status rr_served_pipe_set_backlog_limit(rr_served_object* object, uint32_t member,
                                           size_t packets, rr_error** error) {
  return guarded(error,
                 [&] { RawPipeServer(skeleton_of(object), member).set_backlog_limit(packets); });
}

rr_status rr_served_pipe_endpoints(rr_served_object* object, uint32_t member, rr_pipe** pipes,
                                   size_t* count, rr_error** error) {
  return guarded(error, [&] {
    const rr::capi::RawSkeleton& skeleton = skeleton_of(object);
    rr::capi::hand_out(RawPipeServer(skeleton, member).ends(), pipes, count,
                       [&](const rr::PipeEnd& end) { return rr::capi::make_pipe(skeleton, end); });
  });
}

rr_status rr_served_wire_set_handler(rr_served_object* object, uint32_t member,
                                     const rr_served_wire_handler* handler, rr_error** error) {
  return guarded(error, [&] { rr::capi::set_handler(object, member, handler); });
}

rr_status rr_served_wire_send(rr_served_object* object, uint32_t member, const rr_elements* value,
                              rr_error** error) {
  return guarded(error, [&] {
    const RawWireServer wire(skeleton_of(object), member);
    const Values values(value);
    const rr::capi::Raw kept = rr::capi::keep(values.single());  // for those who connect later
    wire.send_all(&kept);
  });
}

rr_status rr_served_wire_received(rr_served_object* object, uint32_t member, rr_data** out_value,
                                  rr_time* out_time, rr_error** error) {
  return guarded(error, [&] {
    output(out_value) = nullptr;
    rr::TimeSpec time;
    const auto value = RawWireServer(skeleton_of(object), member).received(time);
    if (!value) throw rr::Error(rr::ErrorCode::value_not_set, "Value not set");
    *out_value = rr::capi::Data(static_cast<const rr::capi::Raw*>(value.get())->data).hand_out();
    if (out_time != nullptr) *out_time = rr::capi::time_of(time);
  });
}

rr_status rr_served_wire_set_lifespan(rr_served_object* object, uint32_t member,
                                      int32_t lifespan_ms, rr_error** error) {
  return guarded(error, [&] {
    RawWireServer(skeleton_of(object), member)
        .set_lifespan(std::chrono::milliseconds(std::max(lifespan_ms, 0)));
  });
}

rr_status rr_served_wire_connections(rr_served_object* object, uint32_t member, rr_wire** wires,
                                     size_t* count, rr_error** error) {
  return guarded(error, [&] {
    const rr::capi::RawSkeleton& skeleton = skeleton_of(object);
    rr::capi::hand_out(RawWireServer(skeleton, member).ends(), wires, count,
                       [&](const rr::WireEnd& end) { return rr::capi::make_wire(skeleton, end); });
  });
}

}  // extern "C"
