// SPDX-License-Identifier: Apache-2.0
// Ends, in any order and from anywhere: handles, sessions, services, nodes, contexts.
#include <gtest/gtest.h>

#include <thread>

#include "runtime/c/test/silent_service.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing::c {
namespace {

// Counts what the runtime holds of a test.
struct Held {
  std::atomic<int> dropped = 0;
  static void drop(void* context) { ++static_cast<Held*>(context)->dropped; }
};

TEST(Shutdown, CompletesWhatIsOpen) {
  SilentService silent;
  std::atomic<int> failed = 0;
  Done done([&](rr_status status, void* result) {
    EXPECT_EQ(status, RR_CONNECTION_ERROR);
    EXPECT_EQ(result, nullptr);
    ++failed;
  });
  const rr_completion completion = done.completion();
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(rr_object_call_async(silent.root.get(), RR_FUNCTION_CALL, view("ask"), nullptr,
                                   nullptr, &completion, nullptr),
              RR_OK);
  }
  silent.wait_for_requests(10);
  rr_node_shutdown(silent.node.get());
  EXPECT_EQ(failed, 10);
  rr_node_shutdown(silent.node.get());
}

TEST(Shutdown, HandlesMayOutliveTheirNode) {
  SilentService silent;
  rr_pipe* made = nullptr;
  ASSERT_EQ(rr_pipe_connect(silent.root.get(), view("numbers"), nullptr, nullptr, &made, nullptr),
            RR_OK);
  const PipeHandle pipe(made);
  silent.node.reset();
  EXPECT_EQ(rr_client_is_open(silent.client.get()), 0);
  EXPECT_EQ(rr_pipe_is_open(made), 0);
  Packed packet;
  packet.number("", 1);
  EXPECT_EQ(rr_pipe_send(made, &packet, nullptr, nullptr), RR_INVALID_OPERATION);
  EXPECT_NE(call(silent.root, "ask").status, RR_OK);
  std::atomic<bool> is_done = false;
  Done done([&](rr_status status, void*) {
    EXPECT_NE(status, RR_OK);
    is_done = true;
  });
  const rr_completion completion = done.completion();
  ASSERT_EQ(rr_object_call_async(silent.root.get(), RR_FUNCTION_CALL, view("ask"), nullptr, nullptr,
                                 &completion, nullptr),
            RR_OK);
  EXPECT_TRUE(eventually([&] { return is_done.load(); }));
  silent.client.reset();
}

TEST(Shutdown, OfAServiceLeavesRequestsToBeAnsweredInVain) {
  SilentService silent;
  std::atomic<bool> is_done = false;
  Done done([&](rr_status status, void*) {
    EXPECT_NE(status, RR_OK);
    is_done = true;
  });
  const rr_completion completion = done.completion();
  ASSERT_EQ(rr_object_call_async(silent.root.get(), RR_FUNCTION_CALL, view("ask"), nullptr, nullptr,
                                 &completion, nullptr),
            RR_OK);
  silent.wait_for_requests(1);
  rr_request* const request = silent.take();
  silent.server.reset();
  silent.object.reset();
  EXPECT_TRUE(eventually([&] { return is_done.load(); }));
  Packed value;
  value.number("", 1);
  EXPECT_EQ(rr_request_answer(request, &value, nullptr), RR_OK);  // nobody is there to hear it
  rr_request_release(request);
  rr_error* error = nullptr;
  EXPECT_EQ(rr_service_release_path(silent.service.get(), view("silent.x"), 0, &error),
            RR_INVALID_OPERATION);
  rr_error_release(error);
}

TEST(Releases, OfANodeMayComeFromItsOwnThread) {
  Pair pair;
  std::atomic<bool> is_done = false;
  Done done([&](rr_status, void* result) {
    rr_data_release(static_cast<rr_data*>(result));
    pair.root.reset();
    pair.client.reset();
    pair.node.reset();
    is_done = true;
  });
  const rr_completion completion = done.completion();
  ASSERT_EQ(rr_object_call_async(pair.root.get(), RR_PROPERTY_GET, view("value"), nullptr, nullptr,
                                 &completion, nullptr),
            RR_OK);
  EXPECT_TRUE(eventually([&] { return is_done.load(); }));
}

TEST(Releases, AnEventHandlerMayEndItself) {
  SilentService silent;
  struct State {
    rr_subscription* subscription = nullptr;
    std::atomic<int> calls = 0;
    std::atomic<int> dropped = 0;
  } state;
  rr_event_handler handler{};
  handler.size = sizeof handler;
  handler.context = &state;
  handler.on_event = [](void* context, const rr_elements* arguments, rr_data*) {
    auto& of = *static_cast<State*>(context);
    EXPECT_EQ(unpack_double(arguments, "value"), 0.5);
    ++of.calls;
    rr_subscription_release(of.subscription);
  };
  handler.drop = [](void* context) { ++static_cast<State*>(context)->dropped; };
  ASSERT_EQ(
      rr_event_subscribe(silent.root.get(), view("noted"), &handler, &state.subscription, nullptr),
      RR_OK);
  Packed value;
  value.number("value", 0.5);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(rr_served_event_fire(silent.object.get(), 1, &value, nullptr), RR_OK);
  }
  EXPECT_TRUE(eventually([&] { return state.dropped == 1; }));
  EXPECT_EQ(state.calls, 1);
}

TEST(Releases, APipeHandlerMayReleaseItsHandleAndCloseIt) {
  Pair pair("pipes");
  struct State {
    rr_pipe* pipe = nullptr;
    std::atomic<int> packets = 0;
    std::atomic<int> closed = 0;
    std::atomic<int> dropped = 0;
  } state;
  ASSERT_EQ(
      rr_pipe_connect(pair.root.get(), view("numbers"), nullptr, nullptr, &state.pipe, nullptr),
      RR_OK);
  rr_pipe_handler handler{};
  handler.size = sizeof handler;
  handler.context = &state;
  handler.on_packet = [](void* context, const rr_elements* packet, rr_data*) {
    auto& of = *static_cast<State*>(context);
    EXPECT_EQ(unpack_double(packet, nullptr), of.packets);
    if (++of.packets == 5) {
      rr_pipe_close(of.pipe);
      rr_pipe_release(of.pipe);
    }
  };
  handler.on_closed = [](void* context) { ++static_cast<State*>(context)->closed; };
  handler.drop = [](void* context) { ++static_cast<State*>(context)->dropped; };
  ASSERT_EQ(rr_pipe_set_handler(state.pipe, &handler, nullptr), RR_OK);
  EXPECT_EQ(call(pair.root, "sync").status, RR_OK);
  EXPECT_TRUE(eventually([&] { return state.dropped == 1; }));
  EXPECT_EQ(state.closed, 1);
}

TEST(Contexts, AreDroppedWhenTheirHandlerIsReplacedOrRefused) {
  Pair pair("pipes");
  Held first;
  Held second;
  Held refused;
  rr_pipe* made = nullptr;
  ASSERT_EQ(rr_pipe_connect(pair.root.get(), view("numbers"), nullptr, nullptr, &made, nullptr),
            RR_OK);
  const PipeHandle pipe(made);
  rr_pipe_handler handler{};
  handler.size = sizeof handler;
  handler.on_packet = [](void*, const rr_elements*, rr_data*) {};
  handler.on_closed = [](void*) {};
  handler.drop = Held::drop;
  handler.context = &first;
  ASSERT_EQ(rr_pipe_set_handler(made, &handler, nullptr), RR_OK);
  EXPECT_EQ(first.dropped, 0);
  handler.context = &second;
  ASSERT_EQ(rr_pipe_set_handler(made, &handler, nullptr), RR_OK);
  EXPECT_EQ(first.dropped, 1);
  EXPECT_EQ(second.dropped, 0);
  ASSERT_EQ(rr_pipe_set_handler(made, nullptr, nullptr), RR_OK);
  EXPECT_EQ(second.dropped, 1);

  rr_event_handler wrong{};
  wrong.size = sizeof wrong;
  wrong.context = &refused;
  wrong.drop = Held::drop;
  rr_subscription* subscription = nullptr;
  EXPECT_EQ(rr_event_subscribe(pair.root.get(), view("noted"), &wrong, &subscription, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(refused.dropped, 1);
}

TEST(Contexts, OfASessionAreDroppedBehindItsEnd) {
  struct State : Held {
    std::atomic<rr_status> why = RR_OK;
  } state;
  rr_connect_options options{};
  options.size = sizeof options;
  options.context = static_cast<Held*>(&state);
  options.on_closed = [](void* context, const rr_error_info* why) {
    static_cast<State*>(static_cast<Held*>(context))->why = why->code;
  };
  options.drop = Held::drop;
  {
    Pair pair("counter", &options);
    EXPECT_EQ(state.dropped, 0);
    pair.server.reset();
    EXPECT_TRUE(eventually([&] { return state.why != RR_OK; }));
  }
  EXPECT_EQ(state.dropped, 1);
}

TEST(Contexts, OfEventsAreDroppedWhenTheirSessionHasEndedAlthoughTheSubscriptionIsHeld) {
  Pair pair("counter");
  Held held;
  rr_event_handler handler{};
  handler.size = sizeof handler;
  handler.context = &held;
  handler.on_event = [](void*, const rr_elements*, rr_data*) {};
  handler.drop = Held::drop;
  rr_subscription* subscription = nullptr;
  ASSERT_EQ(rr_event_subscribe(pair.root.get(), view("noted"), &handler, &subscription, nullptr),
            RR_OK);
  EXPECT_EQ(held.dropped, 0);
  rr_client_close(pair.client.get());
  EXPECT_TRUE(eventually([&] { return held.dropped == 1; }));
  rr_subscription_release(subscription);
  EXPECT_EQ(held.dropped, 1);
}

// A function that holds its own end's handle would otherwise keep both for ever.
TEST(Contexts, OfEndsAreDroppedWhenTheirSessionHasEndedAlthoughTheHandleIsHeld) {
  SilentService silent;
  Held packets;
  Held values;
  rr_pipe* pipe_made = nullptr;
  ASSERT_EQ(
      rr_pipe_connect(silent.root.get(), view("numbers"), nullptr, nullptr, &pipe_made, nullptr),
      RR_OK);
  const PipeHandle pipe(pipe_made);
  rr_pipe_handler pipe_handler{};
  pipe_handler.size = sizeof pipe_handler;
  pipe_handler.context = &packets;
  pipe_handler.on_packet = [](void*, const rr_elements*, rr_data*) {};
  pipe_handler.drop = Held::drop;
  ASSERT_EQ(rr_pipe_set_handler(pipe_made, &pipe_handler, nullptr), RR_OK);
  rr_wire* wire_made = nullptr;
  ASSERT_EQ(rr_wire_connect(silent.root.get(), view("level"), 0, nullptr, &wire_made, nullptr),
            RR_OK);
  const WireHandle wire(wire_made);
  rr_wire_handler wire_handler{};
  wire_handler.size = sizeof wire_handler;
  wire_handler.context = &values;
  wire_handler.on_value = [](void*, const rr_elements*, const rr_time*, rr_data*) {};
  wire_handler.drop = Held::drop;
  ASSERT_EQ(rr_wire_set_handler(wire_made, &wire_handler, nullptr), RR_OK);
  EXPECT_EQ(packets.dropped, 0);
  EXPECT_EQ(values.dropped, 0);
  rr_client_close(silent.client.get());
  EXPECT_TRUE(eventually([&] { return packets.dropped == 1 && values.dropped == 1; }));
}

TEST(Sessions, MayBeReleasedWhileOtherThreadsCall) {
  Pair pair;
  std::vector<std::thread> threads;
  std::atomic<int> calls = 0;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] {
      while (call(pair.root, "value", nullptr, nullptr, RR_PROPERTY_GET).status == RR_OK) ++calls;
    });
  }
  EXPECT_TRUE(eventually([&] { return calls > 50; }));
  pair.client.reset();
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace rr::testing::c
