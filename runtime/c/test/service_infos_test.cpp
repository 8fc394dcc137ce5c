// SPDX-License-Identifier: Apache-2.0
// What is told of services, without connecting to them, through the C interface.
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "runtime/c/test/announced.hpp"

namespace rr::testing::c {
namespace {

using InfoOwner =
    std::unique_ptr<rr_service_info_subscription, Release<rr_service_info_subscription_release>>;

// What a program was told of services.
struct Infos {
  std::mutex mutex;
  std::vector<std::string> told;
  std::atomic<int> dropped = 0;

  [[nodiscard]] rr_service_info_handler handler() {
    rr_service_info_handler result{};
    result.size = sizeof result;
    result.context = this;
    result.on_detected = [](void* context, const rr_found_service* service) {
      static_cast<Infos*>(context)->add("+" + text(service->node_name));
    };
    result.on_changed = [](void* context, const rr_found_service* service) {
      static_cast<Infos*>(context)->add("*" + text(service->node_name));
    };
    result.on_lost = [](void* context, const rr_found_service* service) {
      static_cast<Infos*>(context)->add("-" + text(service->node_name));
    };
    result.drop = [](void* context) { ++static_cast<Infos*>(context)->dropped; };
    return result;
  }
  void add(std::string what) {
    const std::lock_guard lock(mutex);
    told.push_back(std::move(what));
  }
  bool has_been_told(const std::vector<std::string>& expected) {
    return eventually([&] {
      const std::lock_guard lock(mutex);
      return told == expected;
    });
  }
};

using ServiceInfos = Announced;

TEST_F(ServiceInfos, AreToldWithoutConnecting) {
  const rr_str types[] = {view("test.counter.Named")};
  Infos infos;
  const rr_service_info_handler handler = infos.handler();
  rr_service_info_subscription* made = nullptr;
  ASSERT_EQ(rr_service_info_subscribe(node_.get(), types, 1, nullptr, &handler, &made, nullptr),
            RR_OK);
  InfoOwner subscription(made);
  auto one = serve("one", "red");
  ASSERT_TRUE(infos.has_been_told({"+one"}));
  service_->set_attributes({{"color", "blue"}});
  ASSERT_TRUE(infos.has_been_told({"+one", "*one"}));
  rr_found_services* found_made = nullptr;
  ASSERT_EQ(rr_service_info_subscription_services(made, &found_made, nullptr), RR_OK);
  const ServicesHandle found(found_made);
  ASSERT_EQ(rr_found_services_count(found_made), 1U);
  EXPECT_EQ(text(read(found, 0).node_name), "one");
  EXPECT_TRUE(service_->clients().empty());

  Infos later;
  const rr_service_info_handler second = later.handler();
  rr_subscription* watching_made = nullptr;
  ASSERT_EQ(rr_service_info_subscription_watch(made, &second, &watching_made, nullptr), RR_OK);
  SubscriptionHandle watching(watching_made);
  ASSERT_TRUE(later.has_been_told({"+one"}));
  watching.reset();
  EXPECT_EQ(later.dropped, 1);

  rr_discovery_stop_listening(node_.get());
  ASSERT_TRUE(infos.has_been_told({"+one", "*one", "-one"}));
  EXPECT_EQ(rr_service_info_subscription_is_open(made), 1);
  rr_service_info_subscription_close(made);
  EXPECT_EQ(rr_service_info_subscription_is_open(made), 0);
  subscription.reset();
  EXPECT_TRUE(eventually([&] { return infos.dropped == 1; }));
}

TEST_F(ServiceInfos, RefuseWrongArguments) {
  Infos infos;
  const rr_service_info_handler handler = infos.handler();
  rr_service_info_subscription* made = nullptr;
  EXPECT_EQ(rr_service_info_subscribe(nullptr, nullptr, 0, nullptr, &handler, &made, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(infos.dropped, 1);
  EXPECT_EQ(rr_service_info_subscribe(node_.get(), nullptr, 1, nullptr, &handler, &made, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(infos.dropped, 2);
  rr_found_services* found = nullptr;
  EXPECT_EQ(rr_service_info_subscription_services(nullptr, &found, nullptr), RR_INVALID_ARGUMENT);
  rr_subscription* watching = nullptr;
  EXPECT_EQ(rr_service_info_subscription_watch(nullptr, &handler, &watching, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(infos.dropped, 3);
  EXPECT_EQ(rr_service_info_subscription_is_open(nullptr), 0);
  rr_service_info_subscription_close(nullptr);
  node_.reset();
}

}  // namespace
}  // namespace rr::testing::c
