// SPDX-License-Identifier: Apache-2.0
// Pipes, wires, generators, callbacks and memories by their functions and completions.
#include <gtest/gtest.h>

#include "runtime/c/test/silent_service.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing::c {
namespace {

constexpr std::uint32_t numbers_place = 2;
constexpr std::uint32_t level_place = 3;
constexpr std::uint32_t sum_place = 4;

// Waits for one completion, and has its result.
template <class T>
struct Result {
  Done done{[this](rr_status code, void* given) {
    status = code;
    result = static_cast<T*>(given);
    is_done = true;
  }};
  rr_completion completion = done.completion();
  std::atomic<rr_status> status = RR_OK;
  std::atomic<T*> result = nullptr;
  std::atomic<bool> is_done = false;
  T* wait() {
    EXPECT_TRUE(eventually([&] { return is_done.load(); }));
    EXPECT_EQ(status, RR_OK);
    return result;
  }
};

double number_in(rr_data* data) {
  const DataHandle owner(data);
  const rr_elements elements = rr_data_elements(data);
  return unpack_double(&elements, nullptr);
}

TEST(Pipes, GoBothWaysByFunctions) {
  struct Served {
    rr_pipe* pipe = nullptr;
    std::atomic<int> packets = 0;
    std::atomic<bool> is_closed = false;
  } served;
  SilentService silent;
  rr_served_pipe_handler handler{};
  handler.size = sizeof handler;
  handler.context = &served;
  handler.on_connect = [](void* context, rr_pipe* pipe) {
    static_cast<Served*>(context)->pipe = pipe;
    rr_pipe_handler told{};
    told.size = sizeof told;
    told.context = context;
    told.on_packet = [](void* of, const rr_elements* packet, rr_data* data) {
      auto& end = *static_cast<Served*>(of);
      EXPECT_EQ(unpack_double(packet, nullptr), end.packets);
      ++end.packets;
      const rr_elements answer = rr_data_elements(data);
      EXPECT_EQ(rr_pipe_send(end.pipe, &answer, nullptr, nullptr), RR_OK);  // as it has come
    };
    told.on_closed = [](void* of) { static_cast<Served*>(of)->is_closed = true; };
    EXPECT_EQ(rr_pipe_set_handler(pipe, &told, nullptr), RR_OK);
  };
  ASSERT_EQ(rr_served_pipe_set_handler(silent.object.get(), numbers_place, &handler, nullptr),
            RR_OK);
  Result<rr_pipe> connected;
  rr_pipe_options options{};
  options.size = sizeof options;
  options.index = 7;
  ASSERT_EQ(rr_pipe_connect_async(silent.root.get(), view("numbers"), &options, nullptr,
                                  &connected.completion, nullptr),
            RR_OK);
  const PipeHandle pipe(connected.wait());
  ASSERT_TRUE(pipe);
  EXPECT_EQ(rr_pipe_index(pipe.get()), 7);
  for (int i = 0; i < 10; ++i) {
    Result<rr_data> received;
    ASSERT_EQ(rr_pipe_receive_async(pipe.get(), &received.completion, nullptr), RR_OK);
    Packed packet;
    packet.number("", i);
    ASSERT_EQ(rr_pipe_send(pipe.get(), &packet, nullptr, nullptr), RR_OK);
    EXPECT_EQ(number_in(received.wait()), i);
  }
  EXPECT_EQ(served.packets, 10);
  rr_pipe* ends[2] = {};
  std::size_t count = 2;
  ASSERT_EQ(rr_served_pipe_endpoints(silent.object.get(), numbers_place, ends, &count, nullptr),
            RR_OK);
  ASSERT_EQ(count, 1U);
  EXPECT_NE(rr_pipe_client(ends[0]), 0U);
  rr_pipe_release(ends[0]);
  rr_pipe_close(pipe.get());
  EXPECT_TRUE(eventually([&] { return served.is_closed.load(); }));
  rr_pipe_release(served.pipe);
}

TEST(Pipes, CancelledReceivesTakeNoPacket) {
  SilentService silent;
  rr_pipe* made = nullptr;
  ASSERT_EQ(rr_pipe_connect(silent.root.get(), view("numbers"), nullptr, nullptr, &made, nullptr),
            RR_OK);
  const PipeHandle pipe(made);
  rr_cancellation* stop = nullptr;
  ASSERT_EQ(rr_cancellation_new(&stop, nullptr), RR_OK);
  const CancellationHandle stop_owner(stop);
  rr_call_options options{};
  options.size = sizeof options;
  options.cancellation = stop;
  Result<rr_data> cancelled;
  Result<rr_data> kept;
  ASSERT_EQ(rr_pipe_receive_within_async(made, &options, &cancelled.completion, nullptr), RR_OK);
  ASSERT_EQ(rr_pipe_receive_within_async(made, nullptr, &kept.completion, nullptr), RR_OK);
  rr_cancellation_cancel(stop);
  EXPECT_TRUE(eventually([&] { return cancelled.is_done.load(); }));
  EXPECT_EQ(cancelled.status, RR_OPERATION_CANCELLED);
  Result<rr_data> late;  // of a cancellation that has been used
  ASSERT_EQ(rr_pipe_receive_within_async(made, &options, &late.completion, nullptr), RR_OK);
  EXPECT_TRUE(eventually([&] { return late.is_done.load(); }));
  EXPECT_EQ(late.status, RR_OPERATION_CANCELLED);
  options.cancellation = nullptr;
  options.timeout_ms = 20;
  Result<rr_data> expired;
  ASSERT_EQ(rr_pipe_receive_within_async(made, &options, &expired.completion, nullptr), RR_OK);
  EXPECT_TRUE(eventually([&] { return expired.is_done.load(); }));
  EXPECT_EQ(expired.status, RR_REQUEST_TIMEOUT);
  for (int i = 1; i <= 2; ++i) {
    Packed packet;
    packet.number("", i);
    ASSERT_EQ(rr_served_pipe_send(silent.object.get(), numbers_place, &packet, nullptr), RR_OK);
  }
  EXPECT_EQ(number_in(kept.wait()), 1);
  ASSERT_EQ(rr_pipe_wait(made, 20'000), 1);
  rr_data* next = nullptr;
  ASSERT_EQ(rr_pipe_receive(made, &next, nullptr), RR_OK);
  EXPECT_EQ(number_in(next), 2);
}

TEST(Pipes, FullQueuesLoseWhatTheyAreToldTo) {
  SilentService silent;
  rr_pipe* made = nullptr;
  ASSERT_EQ(rr_pipe_connect(silent.root.get(), view("numbers"), nullptr, nullptr, &made, nullptr),
            RR_OK);
  const PipeHandle pipe(made);
  ASSERT_EQ(rr_pipe_set_queue_limit(made, 2, 0, RR_DROP_OLDEST, nullptr), RR_OK);
  EXPECT_EQ(rr_pipe_set_queue_limit(made, 2, 0, 9, nullptr), RR_INVALID_ARGUMENT);
  for (int i = 0; i < 5; ++i) {
    Packed packet;
    packet.number("", i);
    ASSERT_EQ(rr_served_pipe_send(silent.object.get(), numbers_place, &packet, nullptr), RR_OK);
  }
  EXPECT_TRUE(eventually([&] { return rr_pipe_lost_count(made) == 3; }));
  EXPECT_EQ(rr_pipe_available(made), 2U);
  rr_data* packet = nullptr;
  ASSERT_EQ(rr_pipe_peek(made, &packet, nullptr), RR_OK);
  EXPECT_EQ(number_in(packet), 3);
  ASSERT_EQ(rr_pipe_receive(made, &packet, nullptr), RR_OK);
  EXPECT_EQ(number_in(packet), 3);
}

TEST(Wires, GoBothWaysByFunctions) {
  struct State {
    std::atomic<double> at_service = 0;
    std::atomic<double> at_client = 0;
    std::atomic<int> connected = 0;
    std::atomic<bool> is_closed = false;
  } state;
  SilentService silent;
  rr_served_wire_handler handler{};
  handler.size = sizeof handler;
  handler.context = &state;
  handler.on_connect = [](void* context, rr_wire* wire) {
    ++static_cast<State*>(context)->connected;
    EXPECT_NE(rr_wire_client(wire), 0U);
    rr_wire_release(wire);
  };
  handler.on_value = [](void* context, std::uint32_t client, const rr_elements* value,
                        const rr_time* time, rr_data*) {
    EXPECT_NE(client, 0U);
    EXPECT_NE(time->seconds, 0);
    static_cast<State*>(context)->at_service = unpack_double(value, nullptr);
  };
  handler.handles_peek_in = 1;
  ASSERT_EQ(rr_served_wire_set_handler(silent.object.get(), level_place, &handler, nullptr), RR_OK);
  Result<rr_wire> connected;
  ASSERT_EQ(rr_wire_connect_async(silent.root.get(), view("level"), 0, nullptr,
                                  &connected.completion, nullptr),
            RR_OK);
  const WireHandle wire(connected.wait());
  ASSERT_TRUE(wire);
  EXPECT_EQ(state.connected, 1);
  rr_wire_handler told{};
  told.size = sizeof told;
  told.context = &state;
  told.on_value = [](void* context, const rr_elements* value, const rr_time*, rr_data*) {
    static_cast<State*>(context)->at_client = unpack_double(value, nullptr);
  };
  told.on_closed = [](void* context) { static_cast<State*>(context)->is_closed = true; };
  ASSERT_EQ(rr_wire_set_handler(wire.get(), &told, nullptr), RR_OK);
  Packed value;
  value.number("", 1.5);
  ASSERT_EQ(rr_wire_send(wire.get(), &value, nullptr), RR_OK);
  EXPECT_TRUE(eventually([&] { return state.at_service == 1.5; }));
  ASSERT_EQ(rr_served_wire_send(silent.object.get(), level_place, &value, nullptr), RR_OK);
  EXPECT_TRUE(eventually([&] { return state.at_client == 1.5; }));
  rr_data* received = nullptr;
  rr_time time{};
  ASSERT_EQ(rr_served_wire_received(silent.object.get(), level_place, &received, &time, nullptr),
            RR_OK);
  EXPECT_EQ(number_in(received), 1.5);

  // The program answers the peek.
  Result<rr_data> peeked;
  ASSERT_EQ(rr_wire_peek_in_async(silent.root.get(), view("level"), nullptr, &time,
                                  &peeked.completion, nullptr),
            RR_OK);
  silent.wait_for_requests(1);
  rr_request* const request = silent.take();
  rr_request_info info{};
  info.size = sizeof info;
  rr_request_read(request, &info);
  EXPECT_EQ(info.kind, std::uint32_t{RR_REQUEST_PEEK_IN});
  EXPECT_EQ(info.member, level_place);
  Packed other;
  other.number("", 9.5);
  EXPECT_EQ(rr_request_answer(request, &other, nullptr), RR_OK);
  rr_request_release(request);
  EXPECT_EQ(number_in(peeked.wait()), 9.5);

  Result<void> poked;
  ASSERT_EQ(rr_wire_poke_out_async(silent.root.get(), view("level"), &other, nullptr,
                                   &poked.completion, nullptr),
            RR_OK);
  poked.wait();
  EXPECT_EQ(state.at_service, 9.5);
  rr_wire* again = nullptr;
  EXPECT_EQ(rr_wire_connect(silent.root.get(), view("level"), 0, nullptr, &again, nullptr),
            RR_INVALID_OPERATION);
  rr_wire_close(wire.get());
  EXPECT_TRUE(eventually([&] { return state.is_closed.load(); }));
}

TEST(Wires, WithoutAValueSaySo) {
  SilentService silent;
  rr_data* value = nullptr;
  EXPECT_EQ(rr_wire_peek_in(silent.root.get(), view("level"), nullptr, &value, nullptr, nullptr),
            RR_VALUE_NOT_SET);
  EXPECT_EQ(rr_served_wire_received(silent.object.get(), level_place, &value, nullptr, nullptr),
            RR_VALUE_NOT_SET);
  rr_wire* made = nullptr;
  ASSERT_EQ(rr_wire_connect(silent.root.get(), view("level"), 0, nullptr, &made, nullptr), RR_OK);
  const WireHandle wire(made);
  EXPECT_EQ(rr_wire_received(made, &value, nullptr, nullptr), RR_VALUE_NOT_SET);
  EXPECT_EQ(rr_wire_wait(made, 1), 0);
}

TEST(Generators, TakeAndGiveByCompletions) {
  Pair pair("board");
  Packed start;
  start.number("start", 10);
  Result<rr_generator> opened;
  ASSERT_EQ(rr_generator_open_async(pair.root.get(), view("running_sum"), &start, nullptr,
                                    &opened.completion, nullptr),
            RR_OK);
  const GeneratorHandle generator(opened.wait());
  ASSERT_TRUE(generator);
  double sum = 10;
  for (int i = 1; i < 4; ++i) {
    Packed parameter;
    parameter.number("", i);
    Result<rr_data> step;
    ASSERT_EQ(
        rr_generator_next_async(generator.get(), &parameter, nullptr, &step.completion, nullptr),
        RR_OK);
    EXPECT_EQ(number_in(step.wait()), sum += i);
  }
  Result<void> ended;
  ASSERT_EQ(rr_generator_end_async(generator.get(), 0, nullptr, &ended.completion, nullptr), RR_OK);
  ended.wait();
  rr_data* value = nullptr;
  Packed parameter;
  parameter.number("", 1);
  EXPECT_EQ(rr_generator_next(generator.get(), &parameter, nullptr, &value, nullptr),
            RR_STOP_ITERATION);
}

TEST(Generators, AreAbortedAndLeft) {
  Pair pair("board");
  Packed limit;
  limit.integer("limit", 3);
  rr_generator* made = nullptr;
  ASSERT_EQ(rr_generator_open(pair.root.get(), view("count_to"), &limit, nullptr, &made, nullptr),
            RR_OK);
  GeneratorHandle generator(made);
  ASSERT_EQ(rr_generator_end(made, 1, nullptr, nullptr), RR_OK);
  rr_data* value = nullptr;
  EXPECT_EQ(rr_generator_next(made, nullptr, nullptr, &value, nullptr), RR_OPERATION_ABORTED);
  ASSERT_EQ(rr_generator_open(pair.root.get(), view("count_to"), &limit, nullptr, &made, nullptr),
            RR_OK);
  generator.reset(made);  // the first is let go
}

TEST(Callbacks, AreCalledWithoutWaiting) {
  SilentService silent;
  rr_callback_handler handler{};
  handler.size = sizeof handler;
  handler.on_call = [](void*, rr_request* request) {
    rr_request_info info{};
    info.size = sizeof info;
    rr_request_read(request, &info);
    Packed sum;
    sum.integer("", unpack_int32(&info.arguments, "a") + unpack_int32(&info.arguments, "b"));
    EXPECT_EQ(rr_request_answer(request, &sum, nullptr), RR_OK);
    rr_request_release(request);
  };
  std::uint32_t client = 0;
  rr_service_clients(
      silent.service.get(), &client,
      [](void* context, const rr_client_info* info) {
        *static_cast<std::uint32_t*>(context) = info->client;
      },
      nullptr);
  Packed arguments;
  arguments.integer("a", 2).integer("b", 3);
  rr_data* none = nullptr;
  EXPECT_EQ(rr_served_callback_call(silent.object.get(), sum_place, client, &arguments, nullptr,
                                    &none, nullptr),
            RR_INVALID_OPERATION);  // not set yet
  ASSERT_EQ(rr_callback_set(silent.root.get(), view("sum"), 0, 1, &handler, nullptr), RR_OK);
  Result<rr_data> called;
  ASSERT_EQ(rr_served_callback_call_async(silent.object.get(), sum_place, client, &arguments,
                                          nullptr, &called.completion, nullptr),
            RR_OK);
  const DataHandle data(called.wait());
  const rr_elements answer = rr_data_elements(data.get());
  EXPECT_EQ(unpack_int32(&answer, nullptr), 5);
  ASSERT_EQ(rr_callback_clear(silent.root.get(), view("sum"), nullptr), RR_OK);
  EXPECT_EQ(rr_served_callback_call(silent.object.get(), sum_place, client, &arguments, nullptr,
                                    &none, nullptr),
            RR_INVALID_OPERATION);
  EXPECT_EQ(rr_served_callback_call(silent.object.get(), sum_place, client + 1, &arguments, nullptr,
                                    &none, nullptr),
            RR_CONNECTION_ERROR);
}

TEST(Memories, AreTransferredByCompletions) {
  Pair pair("store");
  rr_memory_type type{};
  type.element = PACK_DOUBLE;
  const std::uint64_t position[] = {10};
  const std::uint64_t count[] = {50};
  double written[50];
  double read[50] = {};
  for (int i = 0; i < 50; ++i) written[i] = i * 0.25;
  Result<void> sent;
  ASSERT_EQ(rr_memory_write_async(pair.root.get(), view("numbers"), &type, position, count, 1,
                                  written, sizeof written, nullptr, &sent.completion, nullptr),
            RR_OK);
  sent.wait();
  Result<void> received;
  ASSERT_EQ(rr_memory_read_async(pair.root.get(), view("numbers"), &type, position, count, 1, read,
                                 sizeof read, nullptr, &received.completion, nullptr),
            RR_OK);
  received.wait();
  EXPECT_EQ(read[49], 49 * 0.25);
  EXPECT_EQ(rr_memory_read(pair.root.get(), view("numbers"), &type, position, count, 1, read,
                           sizeof read - 1, nullptr, nullptr),
            RR_INVALID_ARGUMENT);
  type.element = 11;
  EXPECT_EQ(rr_memory_read(pair.root.get(), view("numbers"), &type, position, count, 1, read,
                           sizeof read, nullptr, nullptr),
            RR_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace rr::testing::c
