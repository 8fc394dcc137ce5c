// SPDX-License-Identifier: Apache-2.0
// Services that come and go.
#include <utility>

#include "runtime/c/src/node.hpp"
#include "runtime/c/src/service_subscription.hpp"

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
  const auto tables = std::make_shared<ClientTables>();
  keeper.keep(tables);
  options.make_definition_reader = [tables] { return tables; };
  return options;
}

std::vector<std::string> read_urls(const rr_str* urls, std::size_t count) {
  std::vector<std::string> result;
  for (std::size_t i = 0; i < count; ++i) {
    result.emplace_back(text((&need(urls, "there are no URLs"))[i]));
  }
  return result;
}

using Functions = std::shared_ptr<const Handler<rr_subscribe_options>>;

void listen(rr_service_subscription& to, const Functions& functions) {
  if ((*functions)->on_connected != nullptr) {
    to.connected = to.services.on_connected([functions](const SubscriptionClientId& id) {
      const rr_subscribed_client client = client_of(id);
      (*functions)->on_connected((*functions)->context, &client);
    });
  }
  if ((*functions)->on_disconnected != nullptr) {
    to.disconnected =
        to.services.on_disconnected([functions](const SubscriptionClientId& id, const Error& why) {
          const rr_subscribed_client client = client_of(id);
          const ErrorInfo info(why);
          (*functions)->on_disconnected((*functions)->context, &client, &info.info());
        });
  }
  if ((*functions)->on_failed != nullptr) {
    to.failed = to.services.on_failed(
        [functions](const std::vector<std::string>& /*urls*/, const Error& why) {
          const ErrorInfo info(why);
          (*functions)->on_failed((*functions)->context, &info.info());
        });
  }
}

}  // namespace
}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::need;
using rr::capi::output;
using rr::capi::text;

extern "C" {

rr_status rr_service_subscribe(rr_node* node, const rr_str* urls, size_t url_count,
                               const rr_subscribe_options* options,
                               rr_service_subscription** out_subscription, rr_error** error) {
  return guarded(error, [&] {
    output(out_subscription) = nullptr;
    rr_subscribe_options nothing{};
    nothing.size = sizeof nothing;
    const auto functions = rr::capi::take_handler(options != nullptr ? options : &nothing);
    auto made = std::make_unique<rr_service_subscription>();
    const rr_node& of = need(node, "there is no node");
    made->services = of.node->subscribe(rr::capi::read_urls(urls, url_count),
                                        rr::capi::read_options(**functions, *of.keeper));
    rr::capi::listen(*made, functions);
    *out_subscription = made.release();
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

rr_status rr_service_subscription_root(rr_service_subscription* subscription, int32_t wait_ms,
                                       rr_object** out_object, rr_error** error) {
  return guarded(error, [&] {
    output(out_object) = nullptr;
    *out_object =
        rr::capi::get_object(need(subscription, "there is no subscription").services, wait_ms);
  });
}

}  // extern "C"
