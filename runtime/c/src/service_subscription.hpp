// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "rr/subscription.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/c/src/node.hpp"

struct rr_service_subscription {
  rr::ServiceSubscription services;
  rr::Subscription connected{};
  rr::Subscription disconnected{};
  rr::Subscription failed{};
};

namespace rr::capi {

/// A view of an id, for as long as it stays.
inline rr_subscribed_client client_of(const SubscriptionClientId& id) {
  return {sizeof(rr_subscribed_client), id_of(id.node), view(id.service)};
}

/// Calls a function of the program for each of these.
inline void tell_each(const std::vector<SubscriptionClientId>& clients, void* context,
                      void (*each)(void* context, const rr_subscribed_client* client)) {
  need(each, "a function is NULL that is needed");
  for (const SubscriptionClientId& id : clients) {
    const rr_subscribed_client client = client_of(id);
    each(context, &client);
  }
}

// The object of whichever client there is; waits for one if it is to.
template <class Subscription>
rr_object* get_object(const Subscription& of, std::int32_t wait_ms) {
  return make_object(wait_ms == 0 ? of.template default_client<Stub>()
                                  : of.template wait_default_client<Stub>(patience(wait_ms)));
}

}  // namespace rr::capi
