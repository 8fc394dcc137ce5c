// SPDX-License-Identifier: Apache-2.0
// Services that come and go, without connections to them.
#include <utility>

#include "rr/discovery.hpp"
#include "runtime/c/src/filters.hpp"
#include "runtime/c/src/found.hpp"
#include "runtime/c/src/node.hpp"
#include "runtime/c/src/subscription.hpp"

struct rr_service_info_subscription {
  rr::ServiceInfoSubscription services;
  std::vector<rr::Subscription> functions{};
};

namespace rr::capi {
namespace {

using ServiceFunctions = std::shared_ptr<const Handler<rr_service_info_handler>>;
using ServiceCall = void (*)(void* context, const rr_found_service* service);

Function<void(const FoundService&)> telling(const ServiceFunctions& functions, ServiceCall call) {
  return [functions, call](const FoundService& service) {
    const FoundServiceView view(service);
    call((*functions)->context, &view.info());
  };
}

std::vector<Subscription> watch(const ServiceInfoSubscription& services,
                                const ServiceFunctions& functions) {
  std::vector<Subscription> result;
  if (const auto call = (*functions)->on_lost; call != nullptr) {
    result.push_back(services.on_lost(telling(functions, call)));
  }
  if (const auto call = (*functions)->on_changed; call != nullptr) {
    result.push_back(services.on_changed(telling(functions, call)));
  }
  if (const auto call = (*functions)->on_detected; call != nullptr) {
    result.push_back(services.on_detected(telling(functions, call)));
  }
  return result;
}

}  // namespace
}  // namespace rr::capi

using rr::capi::guarded;
using rr::capi::guarded_or;
using rr::capi::need;
using rr::capi::output;

extern "C" {

rr_status rr_service_info_subscribe(rr_node* node, const rr_str* types, size_t type_count,
                                    const rr_service_filter* filter,
                                    const rr_service_info_handler* handler,
                                    rr_service_info_subscription** out_subscription,
                                    rr_error** error) {
  return guarded(error, [&] {
    rr_service_info_handler nothing{};
    nothing.size = sizeof nothing;
    const auto functions = rr::capi::take_handler(handler != nullptr ? handler : &nothing);
    rr::ServiceFilter wanted = rr::capi::read_filter(filter);
    output(out_subscription) = nullptr;
    auto made = std::make_unique<rr_service_info_subscription>();
    made->services =
        need(node, "there is no node")
            .node->subscribe_services(rr::capi::read_texts(types, type_count, "there are no types"),
                                      std::move(wanted));
    made->functions = rr::capi::watch(made->services, functions);
    *out_subscription = made.release();
  });
}

void rr_service_info_subscription_release(rr_service_info_subscription* subscription) {
  rr::capi::release(subscription);
}

void rr_service_info_subscription_close(rr_service_info_subscription* subscription) {
  guarded_or(0, [&] {
    need(subscription, "there is no subscription").services.close();
    return 0;
  });
}

int32_t rr_service_info_subscription_is_open(const rr_service_info_subscription* subscription) {
  return guarded_or(
      0, [&] { return need(subscription, "there is no subscription").services.is_open() ? 1 : 0; });
}

rr_status rr_service_info_subscription_services(const rr_service_info_subscription* subscription,
                                                rr_found_services** out_services,
                                                rr_error** error) {
  return guarded(error, [&] {
    output(out_services) = nullptr;
    *out_services =
        rr::capi::hand_out(need(subscription, "there is no subscription").services.services());
  });
}

rr_status rr_service_info_subscription_watch(rr_service_info_subscription* subscription,
                                             const rr_service_info_handler* handler,
                                             rr_subscription** out_subscription, rr_error** error) {
  return guarded(error, [&] {
    const auto functions = rr::capi::take_handler(handler);
    output(out_subscription) = nullptr;
    auto made = std::make_unique<rr_subscription>();
    made->subscriptions =
        rr::capi::watch(need(subscription, "there is no subscription").services, functions);
    *out_subscription = made.release();
  });
}

}  // extern "C"
