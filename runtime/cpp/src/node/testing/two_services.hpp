// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>

#include "rr/subscription.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/server.hpp"

namespace rr::testing {

/// Two services of different names, and a subscription to both.
template <class Object, class RootStub>
struct Two {
  Two() { subscription.use_types<RootStub>(); }

  std::shared_ptr<Object> first = std::make_shared<Object>();
  std::shared_ptr<Object> second = std::make_shared<Object>();
  Server one{"one", first};
  Server two{"two", second};
  Node node;
  ServiceSubscription subscription = node.subscribe_all(
      {{one.url()}, {two.url()}}, {.retry_delay = std::chrono::milliseconds(20)});

  [[nodiscard]] static bool is_at(const MemberSubscription& member, std::size_t count) {
    return eventually([&] { return member.clients().size() == count; });
  }
};

}  // namespace rr::testing
