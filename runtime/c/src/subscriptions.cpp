// SPDX-License-Identifier: Apache-2.0
// Services that come and go.
#include <optional>
#include <utility>

#include "runtime/c/src/filters.hpp"
#include "runtime/c/src/node.hpp"
#include "runtime/c/src/service_subscription.hpp"
#include "runtime/c/src/subscription.hpp"

namespace rr::capi {
namespace {

// All connections of a subscription know the same types, which what is on its way may still need
// when the subscription has ended: so they stay with the node.
SubscriptionOptions read_options(const rr_subscribe_options& given, Keeper& keeper) {
  SubscriptionOptions options;
  options.username = text(given.username);
  if (given.credentials.count != 0) {
    options.credentials = read_map(given.credentials);
  } else if (!options.username.empty()) {
    options.credentials.emplace("password", std::string(text(given.password)));
  }
  options.object_type = text(given.object_type);
  options.request_timeout = duration(given.request_timeout_ms);
  if (given.retry_delay_ms != 0) options.retry_delay = duration(given.retry_delay_ms);
  options.max_retry_delay = duration(given.max_retry_delay_ms);
  if (given.connect_timeout_ms != 0) options.connect_timeout = duration(given.connect_timeout_ms);
  options.allow_clear_credentials = given.allow_clear_credentials != 0;
  auto tables = std::make_shared<ClientTables>();
  keeper.keep(tables);
  options.make_definition_reader = [tables] { return tables; };
  return options;
}

std::vector<std::string> read_urls(const rr_str* urls, std::size_t count) {
  return read_texts(urls, count, "there are no URLs");
}

std::vector<std::vector<std::string>> read_services(const rr_service_urls* services,
                                                    std::size_t count) {
  std::vector<std::vector<std::string>> result;
  for (std::size_t i = 0; i < count; ++i) {
    const rr_service_urls& service = (&need(services, "there are no services"))[i];
    result.push_back(read_urls(service.urls, service.url_count));
  }
  return result;
}

using SubscribeFunctions = std::shared_ptr<const Handler<rr_subscribe_options>>;

template <class Struct>
Subscription tell_connected(ServiceSubscription& services,
                            const std::shared_ptr<const Handler<Struct>>& functions) {
  if ((*functions)->on_connected == nullptr) return {};
  return services.on_connected([functions](const SubscriptionClientId& id) {
    const rr_subscribed_client client = client_of(id);
    (*functions)->on_connected((*functions)->context, &client);
  });
}

template <class Struct>
Subscription tell_disconnected(ServiceSubscription& services,
                               const std::shared_ptr<const Handler<Struct>>& functions) {
  if ((*functions)->on_disconnected == nullptr) return {};
  return services.on_disconnected([functions](const SubscriptionClientId& id, const Error& why) {
    const rr_subscribed_client client = client_of(id);
    const ErrorInfo info(why);
    (*functions)->on_disconnected((*functions)->context, &client, &info.info());
  });
}

void listen(rr_service_subscription& to, const SubscribeFunctions& functions) {
  to.connected = tell_connected(to.services, functions);
  to.disconnected = tell_disconnected(to.services, functions);
  if ((*functions)->on_failed == nullptr) return;
  to.failed = to.services.on_failed(
      [functions](const std::vector<std::string>& /*urls*/, const Error& why) {
        const ErrorInfo info(why);
        (*functions)->on_failed((*functions)->context, &info.info());
      });
}

using Watcher = std::shared_ptr<const Handler<rr_service_subscription_handler>>;

// Ends are listened to first: one that comes in between is not missed.
std::vector<Subscription> watch(ServiceSubscription& services, const Watcher& functions) {
  std::vector<Subscription> result;
  result.push_back(tell_disconnected(services, functions));
  result.push_back(tell_connected(services, functions));
  if ((*functions)->on_failed == nullptr) return result;
  result.push_back(
      services.on_failed([functions](const std::vector<std::string>& urls, const Error& why) {
        const ErrorInfo info(why);
        const auto views = view_all(urls);
        (*functions)->on_failed((*functions)->context, views.data(), views.size(), &info.info());
      }));
  return result;
}

// Makes a subscription of any kind: `subscribe(node, options)`. What it is given to call is taken
// over first, so that it is dropped whatever fails.
template <class Subscribe>
void make_subscription(rr_node* node, const rr_subscribe_options* given,
                       rr_service_subscription** out_subscription, const Subscribe& subscribe) {
  rr_subscribe_options nothing{};
  nothing.size = sizeof nothing;
  const auto functions = take_handler(given != nullptr ? given : &nothing);
  ServiceFilter filter = read_filter((*functions)->filter);
  output(out_subscription) = nullptr;
  const rr_node& of = need(node, "there is no node");
  SubscriptionOptions options = read_options(**functions, *of.keeper);
  options.filter = std::move(filter);
  auto made = std::make_unique<rr_service_subscription>();
  made->services = subscribe(*of.node, std::move(options));
  listen(*made, functions);
  *out_subscription = made.release();
}

void tell_service(const SubscribedService& service, void* context,
                  void (*each)(void* context, const rr_subscribed_service* service)) {
  const auto urls = view_all(service.urls);
  const rr_subscribed_client client = client_of(service.client);
  std::optional<ErrorInfo> why;
  if (service.last_error) why.emplace(*service.last_error);
  const rr_subscribed_service told{.size = sizeof(rr_subscribed_service),
                                   .urls = urls.data(),
                                   .url_count = urls.size(),
                                   .client = service.is_connected ? &client : nullptr,
                                   .last_error = why ? &why->info() : nullptr,
                                   .failures = service.failures};
  each(context, &told);
}

rr_service_subscription& subscription_of(rr_service_subscription* subscription) {
  return need(subscription, "there is no subscription");
}
const rr_service_subscription& subscription_of(const rr_service_subscription* subscription) {
  return need(subscription, "there is no subscription");
}

}  // namespace
}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::need;
using rr::capi::output;
using rr::capi::subscription_of;
using rr::capi::text;

extern "C" {

rr_status rr_service_subscribe(rr_node* node, const rr_str* urls, size_t url_count,
                               const rr_subscribe_options* options,
                               rr_service_subscription** out_subscription, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::make_subscription(
        node, options, out_subscription, [&](rr::Node& of, rr::SubscriptionOptions&& terms) {
          return of.subscribe(rr::capi::read_urls(urls, url_count), std::move(terms));
        });
  });
}

rr_status rr_service_subscribe_all(rr_node* node, const rr_service_urls* services,
                                   size_t service_count, const rr_subscribe_options* options,
                                   rr_service_subscription** out_subscription, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::make_subscription(
        node, options, out_subscription, [&](rr::Node& of, rr::SubscriptionOptions&& terms) {
          return of.subscribe_all(rr::capi::read_services(services, service_count),
                                  std::move(terms));
        });
  });
}

rr_status rr_service_subscribe_types(rr_node* node, const rr_str* types, size_t type_count,
                                     const rr_subscribe_options* options,
                                     rr_service_subscription** out_subscription, rr_error** error) {
  return guarded(error, [&] {
    rr::capi::make_subscription(
        node, options, out_subscription, [&](rr::Node& of, rr::SubscriptionOptions&& terms) {
          return of.subscribe_types(rr::capi::read_texts(types, type_count, "there are no types"),
                                    std::move(terms));
        });
  });
}

void rr_service_subscription_release(rr_service_subscription* subscription) {
  rr::capi::release(subscription);
}

void rr_service_subscription_close(rr_service_subscription* subscription) {
  guarded_or(0, [&] {
    need(subscription, "there is no subscription").services.close();
    return 0;
  });
}

int32_t rr_service_subscription_is_open(const rr_service_subscription* subscription) {
  return guarded_or(
      0, [&] { return need(subscription, "there is no subscription").services.is_open() ? 1 : 0; });
}

rr_status rr_service_subscription_update_urls(rr_service_subscription* subscription,
                                              const rr_str* urls, size_t url_count,
                                              rr_error** error) {
  return guarded(error, [&] {
    need(subscription, "there is no subscription")
        .services.update_urls(rr::capi::read_urls(urls, url_count));
  });
}

rr_status rr_service_subscription_update_services(rr_service_subscription* subscription,
                                                  const rr_service_urls* services,
                                                  size_t service_count, rr_error** error) {
  return guarded(error, [&] {
    subscription_of(subscription)
        .services.update_services(rr::capi::read_services(services, service_count));
  });
}

rr_status rr_service_subscription_update_types(rr_service_subscription* subscription,
                                               const rr_str* types, size_t type_count,
                                               const rr_service_filter* filter, rr_error** error) {
  return guarded(error, [&] {
    rr::ServiceFilter wanted = rr::capi::read_filter(filter);
    subscription_of(subscription)
        .services.update_types(rr::capi::read_texts(types, type_count, "there are no types"),
                               std::move(wanted));
  });
}

rr_status rr_service_subscription_watch(rr_service_subscription* subscription,
                                        const rr_service_subscription_handler* handler,
                                        rr_subscription** out_subscription, rr_error** error) {
  return guarded(error, [&] {
    const auto functions = rr::capi::take_handler(handler);
    output(out_subscription) = nullptr;
    auto made = std::make_unique<rr_subscription>();
    made->subscriptions = rr::capi::watch(subscription_of(subscription).services, functions);
    *out_subscription = made.release();
  });
}

rr_status rr_service_subscription_clients(
    const rr_service_subscription* subscription, void* context,
    void (*each)(void* context, const rr_subscribed_client* client), rr_error** error) {
  return guarded(error, [&] {
    rr::capi::tell_each(subscription_of(subscription).services.connected_clients(), context, each);
  });
}

rr_status rr_service_subscription_client_root(rr_service_subscription* subscription,
                                              const rr_subscribed_client* client,
                                              rr_object** out_object, rr_error** error) {
  return guarded(error, [&] {
    output(out_object) = nullptr;
    const rr_subscribed_client wanted = rr::capi::known(client, true);
    auto stub = subscription_of(subscription)
                    .services.client<rr::Stub>(
                        {rr::capi::id_of(wanted.node), std::string(text(wanted.service))});
    if (!stub) throw rr::Error(rr::ErrorCode::connection_error, "this client is not connected");
    *out_object = rr::capi::make_object(std::move(stub));
  });
}

rr_status rr_service_subscription_services(
    const rr_service_subscription* subscription, void* context,
    void (*each)(void* context, const rr_subscribed_service* service), rr_error** error) {
  return guarded(error, [&] {
    need(each, "a function is NULL that is needed");
    for (const rr::SubscribedService& service : subscription_of(subscription).services.services()) {
      rr::capi::tell_service(service, context, each);
    }
  });
}

rr_status rr_service_subscription_root(rr_service_subscription* subscription, int32_t wait_ms,
                                       rr_object** out_object, rr_error** error) {
  return guarded(error, [&] {
    output(out_object) = nullptr;
    *out_object =
        rr::capi::get_object(need(subscription, "there is no subscription").services, wait_ms);
  });
}

}  // extern "C"
