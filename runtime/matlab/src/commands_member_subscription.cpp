// SPDX-License-Identifier: Apache-2.0
// Wires, pipes and objects of all services of a subscription.
#include "rr/error.hpp"
#include "runtime/matlab/src/members.hpp"
#include "runtime/matlab/src/subscriptions.hpp"

namespace rr::matlab {
namespace {

using dynamic::Value;
using WireSubscriptionHandle = MemberSubscriptionHandle<WireSubscription<Value>>;
using PipeSubscriptionHandle = MemberSubscriptionHandle<PipeSubscription<Value>>;
using ObjectSubscriptionHandle = MemberSubscriptionHandle<SubObjectSubscription>;

template <class Handle>
std::shared_ptr<Handle> of(Runtime& runtime, Call& call) {
  return runtime.handles().get<Handle>(call.handle(0));
}

// The object that has the member, at any client; null while there is none.
template <class Handle>
std::optional<dynamic::Object> find_object(Handle& handle) {
  auto& subscription = handle.owner->subscription;
  const auto stub =
      handle.path.empty() || handle.path == "*"
          ? subscription.template try_default_client<Stub>()
          : subscription.subscribe_sub_object(handle.path).template try_default_client<Stub>();
  if (!stub) return std::nullopt;
  handle.owner->home->any_object = dynamic::Object::of(stub);
  return handle.owner->home->any_object;
}

// A client that has told its type is needed to tell a varvalue from what is in it only.
template <class Handle>
mxArray* write(Handle& handle, const Value& value) {
  Plans& plans = handle.owner->home->plans;
  const auto object = find_object(handle);
  const TypePlan* const plan =
      plans.plan(object ? object->member(handle.member).type : value.type());
  return plan != nullptr ? to_mex(value, *plan, plans) : make_null();
}

// Null when there is nobody to send to.
template <class Handle>
std::optional<Value> read(Handle& handle, const mxArray* given) {
  const auto object = find_object(handle);
  if (!object) return std::nullopt;
  Connection& home = *handle.owner->home;
  const dynamic::MemberDescription member = object->member(handle.member);
  const TypePlan* const plan = home.plans.plan(member.type);
  const std::string subject = "member " + handle.member;
  const Value value = as_subject(subject, [&] {
    return from_mex(given, *plan, {home.plans, home.types()});
  });
  return member.type.convert(value, subject);
}

// wire_sub(subscription, name, path): number
void wire(Runtime& runtime, Call& call) {
  const auto sub = of<SubscriptionHandle>(runtime, call);
  const std::string name = call.text(1);
  const std::string path = call.text(2);
  call.give(give_handle(runtime,
                        std::make_shared<WireSubscriptionHandle>(
                            sub, sub->subscription.subscribe_wire<Value>(name, path), name, path)));
}

// pipe_sub(subscription, name, path, most that wait): number
void pipe(Runtime& runtime, Call& call) {
  const auto sub = of<SubscriptionHandle>(runtime, call);
  const std::string name = call.text(1);
  const std::string path = call.text(2);
  const auto most = read_number<std::uint32_t>(call[3]);
  call.give(give_handle(
      runtime, std::make_shared<PipeSubscriptionHandle>(
                   sub, sub->subscription.subscribe_pipe<Value>(name, path, most), name, path)));
}

// object_sub(subscription, path): number
void objects(Runtime& runtime, Call& call) {
  const auto sub = of<SubscriptionHandle>(runtime, call);
  const std::string path = call.text(1);
  call.give(give_handle(runtime, std::make_shared<ObjectSubscriptionHandle>(
                                     sub, sub->subscription.subscribe_sub_object(path), "", path)));
}

void give_client_value(Call& call, WireSubscriptionHandle& handle,
                       const ClientValue<Value>& value) {
  call.give(write(handle, value.value));
  call.give(time_to_mex(value.time));
  call.give(client_to_mex(value.client));
}

// wire_sub_in(wire): [value, time, client]
void wire_in(Runtime& runtime, Call& call) {
  const auto handle = of<WireSubscriptionHandle>(runtime, call);
  const auto value = handle->subscribed.try_in();
  if (!value) {
    throw Error(ErrorCode::value_not_set, "member " + handle->member + ": there is no value");
  }
  give_client_value(call, *handle, *value);
}

// wire_sub_try_in(wire): [is_valid, value, time, client]
void wire_try_in(Runtime& runtime, Call& call) {
  const auto handle = of<WireSubscriptionHandle>(runtime, call);
  const auto value = handle->subscribed.try_in();
  call.give(mxCreateLogicalScalar(value.has_value()));
  if (value) give_client_value(call, *handle, *value);
}

// wire_sub_all(wire): structs with Value, Time, Client, in cells
void wire_all(Runtime& runtime, Call& call) {
  const auto handle = of<WireSubscriptionHandle>(runtime, call);
  std::vector<mxArray*> all;
  for (const ClientValue<Value>& one : handle->subscribed.all_in()) {
    all.push_back(make_struct({{"Value", write(*handle, one.value)},
                               {"Time", time_to_mex(one.time)},
                               {"Client", client_to_mex(one.client)}}));
  }
  call.give(make_cells(all));
}

// wire_sub_wait(wire, seconds): whether there is a value
void wire_wait(Runtime& runtime, Call& call) {
  const auto handle = of<WireSubscriptionHandle>(runtime, call);
  (void)runtime.wait_until(
      [&] { return handle->subscribed.try_in().has_value() || !handle->subscribed.is_open(); },
      call.seconds(1));
  call.give(mxCreateLogicalScalar(handle->subscribed.try_in().has_value()));
}

// wire_sub_lifespan(wire, seconds)
void wire_lifespan(Runtime& runtime, Call& call) {
  const auto limit = call.seconds(1);
  of<WireSubscriptionHandle>(runtime, call)
      ->subscribed.set_lifespan(limit == std::chrono::milliseconds::max()
                                    ? std::chrono::milliseconds(0)
                                    : std::max(limit, min_lifespan));
}

// wire_sub_set_out(wire, value): how many clients it was sent to
void wire_set_out(Runtime& runtime, Call& call) {
  const auto handle = of<WireSubscriptionHandle>(runtime, call);
  const auto value = read(*handle, call[1]);
  const std::size_t count = value ? handle->subscribed.set_out(*value) : 0;
  call.give(mxCreateDoubleScalar(static_cast<double>(count)));
}

// wire_sub_listen(wire, function): number; the function gets value, time, client
void wire_listen(Runtime& runtime, Call& call) {
  const auto handle = of<WireSubscriptionHandle>(runtime, call);
  add_function(runtime, handle->owner->home, call, call[1], [&](std::uint64_t number) {
    return handle->subscribed.on_in(
        [&runtime, number, queue = runtime.queue(), weak = std::weak_ptr(handle)](
            const Value& value, const TimeSpec& time, const SubscriptionClientId& client) {
          queue->push([&runtime, number, weak, value, time, client] {
            const auto wire = weak.lock();
            if (!wire) return;
            call_function_of(runtime, number, [&](Connection&) {
              return std::vector<mxArray*>{write(*wire, value), time_to_mex(time),
                                           client_to_mex(client)};
            });
          });
        });
  });
}

// pipe_sub_receive(pipe, seconds): [has_come, packet, client]
void pipe_receive(Runtime& runtime, Call& call) {
  const auto handle = of<PipeSubscriptionHandle>(runtime, call);
  (void)runtime.wait_until(
      [&] { return handle->subscribed.available() != 0 || !handle->subscribed.is_open(); },
      call.seconds(1));
  const auto packet = handle->subscribed.try_receive();
  call.give(mxCreateLogicalScalar(packet.has_value()));
  call.give(packet ? write(*handle, packet->packet) : make_null());
  call.give(packet ? client_to_mex(packet->client) : make_null());
}

// pipe_sub_available(pipe)
void pipe_available(Runtime& runtime, Call& call) {
  call.give(mxCreateDoubleScalar(
      static_cast<double>(of<PipeSubscriptionHandle>(runtime, call)->subscribed.available())));
}

// pipe_sub_send(pipe, packet): how many clients it was sent to
void pipe_send(Runtime& runtime, Call& call) {
  const auto handle = of<PipeSubscriptionHandle>(runtime, call);
  const auto value = read(*handle, call[1]);
  const std::size_t count = value ? handle->subscribed.send(*value) : 0;
  call.give(mxCreateDoubleScalar(static_cast<double>(count)));
}

// object_sub_wait(objects, seconds): object's number
void object_wait(Runtime& runtime, Call& call) {
  const auto handle = of<ObjectSubscriptionHandle>(runtime, call);
  std::shared_ptr<Stub> stub;
  (void)runtime.wait_until(
      [&] {
        stub = handle->subscribed.try_default_client<Stub>();
        return stub != nullptr || !handle->subscribed.is_open();
      },
      call.seconds(1));
  if (stub) return call.give(handle->owner->give(runtime, stub));
  const auto reason = handle->subscribed.last_error();
  throw Error(ErrorCode::operation_timeout,
              "no client has the object" + (reason ? ": " + reason->message() : std::string()));
}

template <class Handle>
mxArray* last_error_of(Runtime& runtime, Call& call) {
  const auto error = of<Handle>(runtime, call)->subscribed.last_error();
  return make_text(error ? error->what() : "");
}

// member_sub_error(wire, pipe or objects, kind): text; '' for none
void last_error_of_member(Runtime& runtime, Call& call) {
  const std::string kind = call.text(1);
  call.give(kind == "wire"   ? last_error_of<WireSubscriptionHandle>(runtime, call)
            : kind == "pipe" ? last_error_of<PipeSubscriptionHandle>(runtime, call)
                             : last_error_of<ObjectSubscriptionHandle>(runtime, call));
}

}  // namespace

std::vector<Command> member_subscription_commands() {
  return {{"wire_sub", wire},
          {"pipe_sub", pipe},
          {"object_sub", objects},
          {"wire_sub_in", wire_in},
          {"wire_sub_try_in", wire_try_in},
          {"wire_sub_all", wire_all},
          {"wire_sub_wait", wire_wait},
          {"wire_sub_lifespan", wire_lifespan},
          {"wire_sub_set_out", wire_set_out},
          {"wire_sub_listen", wire_listen},
          {"pipe_sub_receive", pipe_receive},
          {"pipe_sub_available", pipe_available},
          {"pipe_sub_send", pipe_send},
          {"object_sub_wait", object_wait},
          {"member_sub_error", last_error_of_member}};
}

}  // namespace rr::matlab
