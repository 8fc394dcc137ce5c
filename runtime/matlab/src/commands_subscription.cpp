// SPDX-License-Identifier: Apache-2.0
// Subscriptions: connections to services that come and go.
#include "rr/error.hpp"
#include "runtime/matlab/src/credentials.hpp"
#include "runtime/matlab/src/subscriptions.hpp"

namespace rr::matlab {
namespace {

std::shared_ptr<SubscriptionHandle> sub_of(Runtime& runtime, Call& call) {
  return runtime.handles().get<SubscriptionHandle>(call.handle(0));
}

void give_subscription(Runtime& runtime, Call& call, ServiceSubscription made) {
  call.give(give_handle(runtime, std::make_shared<SubscriptionHandle>(runtime, std::move(made))));
}

// subscribe(urls [, username, credentials, object type]): number
void subscribe(Runtime& runtime, Call& call) {
  SubscriptionOptions options{.allow_clear_credentials = runtime.allow_clear_credentials};
  if (call.has(1)) options.username = call.text(1);
  if (call.has(2)) options.credentials = read_credentials(call[2]);
  if (call.has(3)) options.object_type = call.text(3);
  give_subscription(runtime, call,
                    dynamic::subscribe(runtime.node(), read_texts(call[0]), std::move(options)));
}

// subscribe_type(types, filter): number
void subscribe_type(Runtime& runtime, Call& call) {
  SubscriptionOptions options{.allow_clear_credentials = runtime.allow_clear_credentials};
  if (call.has(1)) options.filter = read_filter(call[1]);
  give_subscription(
      runtime, call,
      dynamic::subscribe_types(runtime.node(), read_texts(call[0]), std::move(options)));
}

// sub_default(subscription): object's number
void default_client(Runtime& runtime, Call& call) {
  const auto sub = sub_of(runtime, call);
  call.give(sub->give(runtime, sub->subscription.default_client<Stub>()));
}

// sub_try_default(subscription): object's number, 0 for none
void try_default_client(Runtime& runtime, Call& call) {
  const auto sub = sub_of(runtime, call);
  const auto stub = sub->subscription.try_default_client<Stub>();
  call.give(stub ? sub->give(runtime, stub) : make_number<std::uint64_t>(0));
}

// sub_wait(subscription, seconds): object's number
void wait_default_client(Runtime& runtime, Call& call) {
  const auto sub = sub_of(runtime, call);
  std::shared_ptr<Stub> stub;
  const bool has_come = runtime.wait_until(
      [&] {
        stub = sub->subscription.try_default_client<Stub>();
        return stub != nullptr || !sub->subscription.is_open();
      },
      call.seconds(1));
  if (stub) return call.give(sub->give(runtime, stub));
  if (has_come) throw Error(ErrorCode::invalid_operation, "the subscription is closed");
  const auto reason = sub->subscription.last_error();
  throw Error(ErrorCode::operation_timeout,
              "no client has come" + (reason ? ": " + reason->message() : std::string()));
}

// sub_clients(subscription): [ids, objects' numbers], cells
void clients(Runtime& runtime, Call& call) {
  const auto sub = sub_of(runtime, call);
  std::vector<mxArray*> ids;
  std::vector<mxArray*> numbers;
  for (const SubscriptionClientId& id : sub->subscription.connected_clients()) {
    const auto stub = sub->subscription.client<Stub>(id);
    if (!stub) continue;
    ids.push_back(client_to_mex(id));
    numbers.push_back(sub->give(runtime, stub));
  }
  call.give(make_cells(ids));
  call.give(make_cells(numbers));
}

// sub_failures(subscription): structs with URLs, Message, Identifier, Failures, in cells
void failures(Runtime& runtime, Call& call) {
  std::vector<mxArray*> found;
  for (const SubscribedService& service : sub_of(runtime, call)->subscription.services()) {
    if (!service.last_error) continue;
    std::vector<mxArray*> urls;
    for (const std::string& url : service.urls) urls.push_back(make_text(url));
    const Failure failure = failure_of(*service.last_error);
    found.push_back(
        make_struct({{"URLs", make_cells(urls)},
                     {"Message", make_text(failure.message)},
                     {"Identifier", make_text(failure.identifier)},
                     {"Failures", mxCreateDoubleScalar(static_cast<double>(service.failures))}}));
  }
  call.give(make_cells(found));
}

// sub_update_urls(subscription, urls)
void update_urls(Runtime& runtime, Call& call) {
  sub_of(runtime, call)->subscription.update_urls(read_texts(call[1]));
}

// sub_update_types(subscription, types, filter)
void update_types(Runtime& runtime, Call& call) {
  sub_of(runtime, call)
      ->subscription.update_types(read_texts(call[1]),
                                  call.has(2) ? read_filter(call[2]) : ServiceFilter());
}

// sub_retry_delay(subscription, seconds)
void retry_delay(Runtime& runtime, Call& call) {
  sub_of(runtime, call)->subscription.set_retry_delay(call.seconds(1));
}

// sub_claim(subscription, object): number of the same object, whose session its holder ends
void claim(Runtime& runtime, Call& call) {
  const auto sub = sub_of(runtime, call);
  const auto object = runtime.handles().get<ObjectHandle>(call.handle(1));
  auto claimed = sub->subscription.claim_client(object->object().shared_stub());
  call.give(give_handle(runtime, std::make_shared<ClaimedClient>(std::move(claimed))));
}

// sub_release(subscription, number of the claim)
void release(Runtime& runtime, Call& call) {
  const auto sub = sub_of(runtime, call);
  const auto claimed = runtime.handles().get<ClaimedClient>(call.handle(1));
  sub->subscription.release_client(std::move(claimed->client));
  runtime.handles().remove(call.handle(1));
}

// sub_listen(subscription, event, function): number of the listener
void listen_to_subscription(Runtime& runtime, Call& call) {
  const auto sub = sub_of(runtime, call);
  const std::string event = call.text(1);
  const auto queue = runtime.queue();
  const auto push = [&runtime, queue](std::uint64_t number, auto make) {
    queue->push([&runtime, number, make] {
      call_function_of(runtime, number, [&](Connection&) { return make(); });
    });
  };
  add_function(runtime, sub->home, call, call[2], [&](std::uint64_t number) {
    using Arguments = std::vector<mxArray*>;
    if (event == "ClientConnected") {
      return sub->subscription.on_connected([push, number](const SubscriptionClientId& id) {
        push(number, [id] { return Arguments{client_to_mex(id)}; });
      });
    }
    if (event == "ClientDisconnected") {
      return sub->subscription.on_disconnected([push, number](const SubscriptionClientId& id,
                                                              const Error& why) {
        push(number, [id, why] { return Arguments{client_to_mex(id), make_text(why.message())}; });
      });
    }
    if (event == "ClientConnectFailed") {
      return sub->subscription.on_failed(
          [push, number](const std::vector<std::string>& urls, const Error& why) {
            push(number, [urls, why] {
              return Arguments{make_text(urls.empty() ? "" : urls[0]), make_text(why.message())};
            });
          });
    }
    throw Error(ErrorCode::member_not_found,
                "a subscription has the events ClientConnected, "
                "ClientDisconnected and ClientConnectFailed");
  });
}

// sub_close(subscription)
void close_subscription(Runtime& runtime, Call& call) { sub_of(runtime, call)->close(); }

}  // namespace

std::vector<Command> subscription_commands() {
  return {{"subscribe", subscribe},
          {"subscribe_type", subscribe_type},
          {"sub_default", default_client},
          {"sub_try_default", try_default_client},
          {"sub_wait", wait_default_client},
          {"sub_clients", clients},
          {"sub_failures", failures},
          {"sub_update_urls", update_urls},
          {"sub_update_types", update_types},
          {"sub_retry_delay", retry_delay},
          {"sub_claim", claim},
          {"sub_release", release},
          {"sub_listen", listen_to_subscription},
          {"sub_close", close_subscription}};
}

}  // namespace rr::matlab
