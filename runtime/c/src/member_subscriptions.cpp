// SPDX-License-Identifier: Apache-2.0
// Wires, pipes and objects of services that come and go.
#include <algorithm>
#include <utility>

#include "runtime/c/src/service_subscription.hpp"
#include "runtime/c/src/streams.hpp"

namespace rr::capi {
namespace {

// What the ServiceSubscription keeps to itself.
class RawWireSubscription : public WireSubscriptionBase {
 public:
  RawWireSubscription() = default;
  explicit RawWireSubscription(const WireSubscription<Raw>& wire) : WireSubscriptionBase(wire) {}
  using WireSubscriptionBase::all_received;
  using WireSubscriptionBase::on_received;
  using WireSubscriptionBase::received;
  using WireSubscriptionBase::send_all;
  using WireSubscriptionBase::Value;
  using WireSubscriptionBase::wait_received;
};

class RawPipeSubscription : public PipeSubscriptionBase {
 public:
  RawPipeSubscription() = default;
  explicit RawPipeSubscription(const PipeSubscription<Raw>& pipe) : PipeSubscriptionBase(pipe) {}
  using PipeSubscriptionBase::on_received;
  using PipeSubscriptionBase::Packet;
  using PipeSubscriptionBase::send_all;
  using PipeSubscriptionBase::take;
  using PipeSubscriptionBase::wait;
};

}  // namespace
}  // namespace rr::capi

struct rr_wire_subscription {
  rr::capi::RawWireSubscription wire;
  rr::capi::KeptSubscription values{};
};
struct rr_pipe_subscription {
  rr::capi::RawPipeSubscription pipe;
  rr::capi::KeptSubscription packets{};
};
struct rr_object_subscription {
  rr::SubObjectSubscription object;
};

namespace rr::capi {
namespace {

void need_value(const RawWireSubscription::Value& value) {
  if (!value.value) throw Error(ErrorCode::value_not_set, "Value not set");
}

// Calls a function of the program with what a client has sent.
void tell_value(const RawWireSubscription::Value& value, void* context, rr_each_value each) {
  const Data& data = static_cast<const Raw*>(value.value.get())->data;
  const rr_elements elements = data.elements();
  const rr_time time = time_of(value.time);
  const rr_subscribed_client client = client_of(value.client);
  each(context, &client, &elements, &time, data.get());
}

using EachPacket = void (*)(void* context, const rr_subscribed_client* client,
                            const rr_elements* packet, rr_data* data);
void tell_packet(const RawPipeSubscription::Packet& packet, void* context, EachPacket each) {
  const Data& data = static_cast<const Raw*>(packet.value.get())->data;
  const rr_elements elements = data.elements();
  const rr_subscribed_client client = client_of(packet.client);
  each(context, &client, &elements, data.get());
}

void set_handler(rr_wire_subscription* handle, const rr_wire_subscription_handler* given) {
  const auto functions =
      given != nullptr ? take_handler(given, &rr_wire_subscription_handler::on_value) : nullptr;
  rr_wire_subscription& of = need(handle, "there is no wire");
  of.values.exchange({}).disconnect();
  if (!functions) return;
  auto values = of.wire.on_received([functions](const RawWireSubscription::Value& value) {
    tell_value(value, (*functions)->context, (*functions)->on_value);
  });
  of.values.exchange(std::move(values)).disconnect();  // of another thread, which came first
}

void set_handler(rr_pipe_subscription* handle, const rr_pipe_subscription_handler* given) {
  const auto functions =
      given != nullptr ? take_handler(given, &rr_pipe_subscription_handler::on_packet) : nullptr;
  rr_pipe_subscription& of = need(handle, "there is no pipe");
  of.packets.exchange({}).disconnect();
  if (!functions) return;
  auto packets = of.pipe.on_received([functions](const RawPipeSubscription::Packet& packet) {
    tell_packet(packet, (*functions)->context, (*functions)->on_packet);
  });
  of.packets.exchange(std::move(packets)).disconnect();
}

}  // namespace
}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::need;
using rr::capi::output;
using rr::capi::text;
using rr::capi::Values;

extern "C" {

rr_status rr_wire_subscribe(rr_service_subscription* subscription, rr_str member, rr_str path,
                            rr_wire_subscription** out_wire, rr_error** error) {
  return guarded(error, [&] {
    output(out_wire) = nullptr;
    auto wire = need(subscription, "there is no subscription")
                    .services.subscribe_wire<rr::capi::Raw>(text(member), text(path));
    *out_wire = new rr_wire_subscription{rr::capi::RawWireSubscription(wire)};
  });
}

void rr_wire_subscription_release(rr_wire_subscription* wire) {
  guarded_or(0, [&] {
    if (wire != nullptr) wire->values.exchange({}).disconnect();
    return 0;
  });
  rr::capi::release(wire);
}

void rr_wire_subscription_close(rr_wire_subscription* wire) {
  guarded_or(0, [&] {
    need(wire, "there is no wire").wire.close();
    return 0;
  });
}

rr_status rr_wire_subscription_send(rr_wire_subscription* wire, const rr_elements* value,
                                    size_t* out_count, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawWireSubscription& of = need(wire, "there is no wire").wire;
    const Values values(value);
    const rr::capi::Raw kept = rr::capi::keep(values.single());
    const size_t count = of.send_all(&kept);
    if (out_count != nullptr) *out_count = count;
  });
}

rr_status rr_wire_subscription_received(const rr_wire_subscription* wire, rr_data** out_value,
                                        rr_time* out_time, rr_error** error) {
  return guarded(error, [&] {
    output(out_value) = nullptr;
    const auto newest = need(wire, "there is no wire").wire.received();
    rr::capi::need_value(newest);
    *out_value =
        rr::capi::Data(static_cast<const rr::capi::Raw*>(newest.value.get())->data).hand_out();
    if (out_time != nullptr) *out_time = rr::capi::time_of(newest.time);
  });
}

rr_status rr_wire_subscription_newest(const rr_wire_subscription* wire, void* context,
                                      rr_each_value each, rr_error** error) {
  return guarded(error, [&] {
    need(each, "a function is NULL that is needed");
    const auto newest = need(wire, "there is no wire").wire.received();
    rr::capi::need_value(newest);
    rr::capi::tell_value(newest, context, each);
  });
}

rr_status rr_wire_subscription_values(const rr_wire_subscription* wire, void* context,
                                      rr_each_value each, rr_error** error) {
  return guarded(error, [&] {
    need(each, "a function is NULL that is needed");
    for (const auto& value : need(wire, "there is no wire").wire.all_received()) {
      rr::capi::tell_value(value, context, each);
    }
  });
}

rr_status rr_wire_subscription_clients(const rr_wire_subscription* wire, void* context,
                                       void (*each)(void* context,
                                                    const rr_subscribed_client* client),
                                       rr_error** error) {
  return guarded(error, [&] {
    rr::capi::tell_each(need(wire, "there is no wire").wire.clients(), context, each);
  });
}

rr_status rr_wire_subscription_set_lifespan(rr_wire_subscription* wire, int32_t lifespan_ms,
                                            rr_error** error) {
  return guarded(error, [&] {
    need(wire, "there is no wire")
        .wire.set_lifespan(std::chrono::milliseconds(std::max(lifespan_ms, 0)));
  });
}

int32_t rr_wire_subscription_wait(const rr_wire_subscription* wire, int32_t timeout_ms) {
  return guarded_or(0, [&] {
    return need(wire, "there is no wire").wire.wait_received(rr::capi::patience(timeout_ms)) ? 1
                                                                                             : 0;
  });
}

rr_status rr_wire_subscription_set_handler(rr_wire_subscription* wire,
                                           const rr_wire_subscription_handler* handler,
                                           rr_error** error) {
  return guarded(error, [&] { rr::capi::set_handler(wire, handler); });
}

rr_status rr_object_subscribe(rr_service_subscription* subscription, rr_str path,
                              rr_object_subscription** out_object, rr_error** error) {
  return guarded(error, [&] {
    output(out_object) = nullptr;
    *out_object = new rr_object_subscription{
        need(subscription, "there is no subscription").services.subscribe_sub_object(text(path))};
  });
}

void rr_object_subscription_release(rr_object_subscription* object) { rr::capi::release(object); }

void rr_object_subscription_close(rr_object_subscription* object) {
  guarded_or(0, [&] {
    need(object, "there is no object").object.close();
    return 0;
  });
}

rr_status rr_object_subscription_get(const rr_object_subscription* object, int32_t wait_ms,
                                     rr_object** out_object, rr_error** error) {
  return guarded(error, [&] {
    output(out_object) = nullptr;
    *out_object = rr::capi::get_object(need(object, "there is no object").object, wait_ms);
  });
}

rr_status rr_pipe_subscribe(rr_service_subscription* subscription, rr_str member, rr_str path,
                            size_t max_received, rr_pipe_subscription** out_pipe,
                            rr_error** error) {
  return guarded(error, [&] {
    output(out_pipe) = nullptr;
    auto pipe = need(subscription, "there is no subscription")
                    .services.subscribe_pipe<rr::capi::Raw>(text(member), text(path), max_received);
    *out_pipe = new rr_pipe_subscription{rr::capi::RawPipeSubscription(pipe)};
  });
}

void rr_pipe_subscription_release(rr_pipe_subscription* pipe) {
  guarded_or(0, [&] {
    if (pipe != nullptr) pipe->packets.exchange({}).disconnect();
    return 0;
  });
  rr::capi::release(pipe);
}

void rr_pipe_subscription_close(rr_pipe_subscription* pipe) {
  guarded_or(0, [&] {
    need(pipe, "there is no pipe").pipe.close();
    return 0;
  });
}

rr_status rr_pipe_subscription_send(rr_pipe_subscription* pipe, const rr_elements* packet,
                                    size_t* out_count, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::RawPipeSubscription& of = need(pipe, "there is no pipe").pipe;
    const Values values(packet);
    const size_t count = of.send_all(&values.single());
    if (out_count != nullptr) *out_count = count;
  });
}

rr_status rr_pipe_subscription_receive(rr_pipe_subscription* pipe, rr_data** out_packet,
                                       rr_error** error) {
  return guarded(error, [&] {
    output(out_packet) = nullptr;
    const auto packet = need(pipe, "there is no pipe").pipe.take();
    if (!packet.value) return;
    *out_packet =
        rr::capi::Data(static_cast<const rr::capi::Raw*>(packet.value.get())->data).hand_out();
  });
}

rr_status rr_pipe_subscription_take(rr_pipe_subscription* pipe, void* context,
                                    void (*each)(void* context, const rr_subscribed_client* client,
                                                 const rr_elements* packet, rr_data* data),
                                    rr_error** error) {
  return guarded(error, [&] {
    need(each, "a function is NULL that is needed");
    const auto packet = need(pipe, "there is no pipe").pipe.take();
    if (packet.value) rr::capi::tell_packet(packet, context, each);
  });
}

rr_status rr_pipe_subscription_clients(const rr_pipe_subscription* pipe, void* context,
                                       void (*each)(void* context,
                                                    const rr_subscribed_client* client),
                                       rr_error** error) {
  return guarded(error, [&] {
    rr::capi::tell_each(need(pipe, "there is no pipe").pipe.clients(), context, each);
  });
}

int32_t rr_pipe_subscription_wait(const rr_pipe_subscription* pipe, int32_t timeout_ms) {
  return guarded_or(0, [&] {
    auto of = need(pipe, "there is no pipe").pipe;
    return of.wait(rr::capi::patience(timeout_ms)) ? 1 : 0;
  });
}

rr_status rr_pipe_subscription_set_handler(rr_pipe_subscription* pipe,
                                           const rr_pipe_subscription_handler* handler,
                                           rr_error** error) {
  return guarded(error, [&] { rr::capi::set_handler(pipe, handler); });
}

}  // extern "C"
