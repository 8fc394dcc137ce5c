// SPDX-License-Identifier: Apache-2.0
// Errors, time-outs, cancelling, and requests that are answered otherwise than at once.
#include <gtest/gtest.h>

#include <thread>

#include "runtime/c/test/handles.hpp"
#include "runtime/c/test/silent_service.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing::c {
namespace {

TEST(Arguments, ThatAreNullAreRefused) {
  rr_error* error = nullptr;
  EXPECT_EQ(rr_node_listen(nullptr, view("rr+tcp://127.0.0.1:0"), nullptr, &error),
            RR_INVALID_ARGUMENT);
  ASSERT_NE(error, nullptr);
  rr_error_info info{};
  info.size = sizeof info;
  rr_error_read(error, &info);
  EXPECT_EQ(info.code, RR_INVALID_ARGUMENT);
  EXPECT_EQ(text(info.message), "there is no node");
  EXPECT_EQ(text(info.name), "RobotRaconteur.InvalidArgument");
  rr_error_release(error);

  EXPECT_EQ(rr_object_call(nullptr, RR_PROPERTY_GET, view("x"), nullptr, nullptr, nullptr, nullptr),
            RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_pipe_send(nullptr, nullptr, nullptr, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(rr_wire_wait(nullptr, 0), 0);
  rr_node_release(nullptr);
  rr_client_release(nullptr);
  rr_object_release(nullptr);
  rr_data_release(nullptr);
  rr_error_release(nullptr);
  rr_pipe_release(nullptr);
  rr_wire_release(nullptr);
  rr_generator_release(nullptr);
  rr_subscription_release(nullptr);
  rr_request_release(nullptr);
  rr_service_release(nullptr);
  rr_users_release(nullptr);
}

TEST(Arguments, StructsHaveASize) {
  rr_node* node = nullptr;
  rr_node_options options{};
  EXPECT_EQ(rr_node_new(&options, &node, nullptr), RR_INVALID_ARGUMENT);
  EXPECT_EQ(node, nullptr);
  options.size = sizeof options.size + sizeof options.name;  // of an older, shorter one
  options.name = view("short");
  options.max_threads = 1;  // not read
  ASSERT_EQ(rr_node_new(&options, &node, nullptr), RR_OK);
  const NodeHandle owner(node);
  EXPECT_EQ(text(rr_node_get_name(node)), "short");
}

TEST(Calls, FailWithWhatTheServiceSays) {
  Pair pair;
  Packed arguments;
  arguments.integer("code", RR_OUT_OF_RANGE).words("text", "too far");
  const Outcome outcome = call(pair.root, "raise", &arguments);
  EXPECT_EQ(outcome.status, RR_OUT_OF_RANGE);
  EXPECT_EQ(outcome.message, "too far");
  EXPECT_EQ(outcome.data, nullptr);
  EXPECT_EQ(call(pair.root, "no_such").status, RR_MEMBER_NOT_FOUND);
  EXPECT_EQ(call(pair.root, "value", nullptr, nullptr, 107).status, RR_INVALID_ARGUMENT);
}

TEST(Calls, MayBeAnsweredFromAnotherThread) {
  Pair pair;
  Packed arguments;
  arguments.integer("milliseconds", 0);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(call(pair.root, "slow", &arguments).status, RR_OK);
}

TEST(Calls, EndInTime) {
  SilentService silent;
  rr_call_options options{};
  options.size = sizeof options;
  options.timeout_ms = 20;
  EXPECT_EQ(call(silent.root, "ask", nullptr, &options).status, RR_REQUEST_TIMEOUT);
}

TEST(Calls, AreCancelled) {
  SilentService silent;
  rr_cancellation* made = nullptr;
  ASSERT_EQ(rr_cancellation_new(&made, nullptr), RR_OK);
  const CancellationHandle cancellation(made);
  rr_call_options options{};
  options.size = sizeof options;
  options.cancellation = made;
  std::thread canceller([&] {
    silent.wait_for_requests(1);
    rr_cancellation_cancel(made);
  });
  EXPECT_EQ(call(silent.root, "ask", nullptr, &options).status, RR_OPERATION_CANCELLED);
  canceller.join();
  EXPECT_EQ(call(silent.root, "ask", nullptr, &options).status, RR_OPERATION_CANCELLED);
}

TEST(Calls, OfASessionAreCancelledTogether) {
  SilentService silent;
  std::atomic<int> cancelled = 0;
  Done done([&](rr_status status, void* result) {
    EXPECT_EQ(status, RR_OPERATION_CANCELLED);
    EXPECT_EQ(result, nullptr);
    ++cancelled;
  });
  const rr_completion completion = done.completion();
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(rr_object_call_async(silent.root.get(), RR_FUNCTION_CALL, view("ask"), nullptr,
                                   nullptr, &completion, nullptr),
              RR_OK);
  }
  silent.wait_for_requests(5);
  rr_client_cancel_calls(silent.client.get());
  EXPECT_TRUE(eventually([&] { return cancelled == 5; }));
}

TEST(Requests, ThatAreReleasedUnansweredFail) {
  SilentService silent;
  std::atomic<rr_status> status = RR_OK;
  Done done([&](rr_status code, void*) { status = code; });
  const rr_completion completion = done.completion();
  ASSERT_EQ(rr_object_call_async(silent.root.get(), RR_FUNCTION_CALL, view("ask"), nullptr, nullptr,
                                 &completion, nullptr),
            RR_OK);
  silent.wait_for_requests(1);
  rr_request_release(silent.take());
  EXPECT_TRUE(eventually([&] { return status == RR_OPERATION_ABORTED; }));
}

TEST(Requests, AreAnsweredOnceAndAsTheyAsk) {
  SilentService silent;
  std::atomic<bool> is_done = false;
  Done done([&](rr_status status, void* result) {
    EXPECT_EQ(status, RR_OK);
    rr_data_release(static_cast<rr_data*>(result));
    is_done = true;
  });
  const rr_completion completion = done.completion();
  ASSERT_EQ(rr_object_call_async(silent.root.get(), RR_FUNCTION_CALL, view("ask"), nullptr, nullptr,
                                 &completion, nullptr),
            RR_OK);
  silent.wait_for_requests(1);
  rr_request* const request = silent.take();
  EXPECT_EQ(rr_request_answer_end(request, nullptr), RR_INVALID_OPERATION);
  EXPECT_EQ(rr_request_answer_object(request, nullptr, 0, nullptr), RR_INVALID_OPERATION);
  EXPECT_EQ(rr_request_answer(request, nullptr, nullptr), RR_DATA_SERIALIZATION_ERROR);
  Packed value;
  value.number("", 1);
  EXPECT_EQ(rr_request_answer(request, &value, nullptr), RR_OK);
  EXPECT_EQ(rr_request_answer(request, &value, nullptr), RR_INVALID_OPERATION);
  rr_request_release(request);
  EXPECT_TRUE(eventually([&] { return is_done.load(); }));
}

TEST(Connecting, TriesOneUrlAfterTheOther) {
  Pair pair;
  const std::string good = "rr+tcp://127.0.0.1:" + std::to_string(pair.port) + "/?service=counter";
  const rr_str urls[] = {view("rr+tcp://127.0.0.1:1/?service=counter"), view(good)};
  std::atomic<bool> is_done = false;
  Done done([&](rr_status status, void* result) {
    EXPECT_EQ(status, RR_OK);
    rr_client_release(static_cast<rr_client*>(result));
    is_done = true;
  });
  const rr_completion completion = done.completion();
  ASSERT_EQ(rr_client_connect_async(pair.node.get(), urls, 2, nullptr, &completion, nullptr),
            RR_OK);
  EXPECT_TRUE(eventually([&] { return is_done.load(); }));
  rr_client* client = nullptr;
  EXPECT_EQ(rr_client_connect(pair.node.get(), urls, 1, nullptr, &client, nullptr),
            RR_CONNECTION_ERROR);
  EXPECT_EQ(client, nullptr);
  rr_connect_options options{};
  options.size = sizeof options;
  options.object_type = view("test.counter.Wrong");
  rr_error* error = nullptr;
  EXPECT_EQ(rr_client_connect(pair.node.get(), urls + 1, 1, &options, &client, &error),
            RR_SERVICE_ERROR);
  rr_error_release(error);
}

}  // namespace
}  // namespace rr::testing::c
