// SPDX-License-Identifier: Apache-2.0
// What a service may make its client hold and do: events, callbacks, packets and steps of
// generators without end.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rr/callbacks.hpp"
#include "rr/generators.hpp"
#include "rr/node.hpp"
#include "rr/pipes.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/src/node/testing/raw_service.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using std::chrono_literals::operator""us;
using Answer = RawService::Answer;
using Clock = std::chrono::steady_clock;
using ServiceRequest = RawService::Request;

constexpr std::size_t mib = std::size_t{1} << 20U;

// Of this process, by all its threads.
std::chrono::nanoseconds processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

// Sends the same again and again, until it ends or nobody takes it any more. Not before most of the
// answers to it have been read: a client closes a connection to a service that does not read.
class Flood {
 public:
  Flood(RawService& service, std::function<Answer(std::uint32_t)> what,
        std::chrono::microseconds pause)
      : service_(service), thread_([this, &service, what = std::move(what), pause] {
          for (std::uint32_t number = 1; !is_over_; ++number) {
            const Answer next = what(number);
            const bool is_answered = next.type == EntryType::callback_call_req;
            while (is_answered && !is_over_ && number > service.answered() + most_unread) {
              std::this_thread::sleep_for(100us);
            }
            if (!service.send(next)) break;
            if (pause.count() != 0) std::this_thread::sleep_for(pause);
          }
        }) {}
  ~Flood() {
    is_over_ = true;
    service_.hang_up();  // the client may have ceased to read
    thread_.join();
  }
  Flood(const Flood&) = delete;
  Flood& operator=(const Flood&) = delete;

 private:
  static constexpr std::size_t most_unread = 1'000;

  RawService& service_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

Answer event(std::size_t size) {
  Answer event;
  event.type = EntryType::event_req;
  event.path = "raw";
  event.member = "ticked";
  event.elements = [text = std::string(size, 'e')](Writer& writer) {
    type_of<std::string>.write(writer, "text", &text);
    const std::int32_t count = 1;
    type_of<std::int32_t>.write(writer, "count", &count);
    return 2U;
  };
  return event;
}

Answer callback(std::uint32_t number) {
  Answer request;
  request.type = EntryType::callback_call_req;
  request.path = "raw";
  request.member = "fail";
  request.id = number;
  request.elements = RawService::value("text", std::string("again"));
  return request;
}

// A client that may be made to hold 3.5 MiB.
NodeOptions small_client() {
  NodeOptions options;
  options.limits.message_size = 1 * mib;
  options.budget.client_session = 0;
  options.request_timeout = 2s;
  return options;
}

// The service sends events for as long as a call waits; each is handled slowly.
struct Flooded {
  explicit Flooded(std::size_t size, std::chrono::microseconds pause)
      : service(std::string(rr_definition.text), "test.counter.Counter",
                [](const ServiceRequest& request) {
                  return request.type == EntryType::property_get_req;
                }),
        node(small_client()),
        counter(node.connect<CounterStub>(service.url())),
        handler(counter->ticked().connect(
            [](std::int32_t, const std::string&) { std::this_thread::sleep_for(20ms); })) {
    const std::size_t before = ProcessState::now().resident;
    const auto time_before = processor_time();
    const Flood flood(
        service, [size](std::uint32_t) { return event(size); }, pause);
    const auto begin = Clock::now();
    code = code_of([&] { counter->get_value(); });
    waited = Clock::now() - begin;
    processor = processor_time() - time_before;
    const std::size_t after = ProcessState::now().resident;
    grown = after > before ? after - before : 0;
    is_open = counter.is_open();
    counter.close();
  }

  RawService service;
  Node node;
  Client<CounterStub> counter;
  Subscription handler;
  ErrorCode code{};
  Clock::duration waited{};
  std::chrono::nanoseconds processor{};
  std::size_t grown = 0;
  bool is_open = false;
};

TEST(ClientLimits, ACallThatWaitsAmongManyEventsTakesNoProcessor) {
  const Flooded flooded(1'000, 0us);
  EXPECT_EQ(flooded.code, ErrorCode::request_timeout);
  EXPECT_TRUE(flooded.is_open);
  EXPECT_LT(flooded.processor, slowness() * 700ms);
  EXPECT_LT(flooded.waited, 4s);
  EXPECT_TRUE(keeps_freed_memory() || flooded.grown < 24 * mib) << flooded.grown;
}

TEST(ClientLimits, EventsThatComeOneByOneWhileACallWaitsAreHeldUpToALimit) {
  const Flooded flooded(60'000, 200us);
  EXPECT_EQ(flooded.code, ErrorCode::request_timeout);
  EXPECT_TRUE(flooded.is_open);
  EXPECT_TRUE(keeps_freed_memory() || flooded.grown < 24 * mib) << flooded.grown;
}

TEST(ClientLimits, ACallEndsInItsTimeWhateverElseComes) {
  RawService service(
      std::string(rr_board_definition.text), "test.board.Board",
      [](const ServiceRequest& request) { return request.type == EntryType::function_call_req; });
  Node node(small_client());
  auto board = node.connect<BoardStub>(service.url());
  const std::size_t before = ProcessState::now().resident;
  const Flood flood(service, callback, 0us);
  for (int i = 0; i < 3; ++i) {
    const auto begin = Clock::now();
    EXPECT_EQ(code_of([&] { board->run("x"); }), ErrorCode::request_timeout);
    EXPECT_LT(Clock::now() - begin, slowness() * 3s);
  }
  const std::size_t after = ProcessState::now().resident;
  EXPECT_TRUE(keeps_freed_memory() || after < before + 24 * mib) << after - before;
  board->fail().set([](const std::string& /*text*/) {
    std::this_thread::sleep_for(20ms);
    return 1.0;
  });
  const auto begin = Clock::now();
  EXPECT_EQ(code_of([&] { board->run("x"); }), ErrorCode::request_timeout);
  EXPECT_LT(Clock::now() - begin, slowness() * 3s);
  board.close();
}

TEST(ClientLimits, WhatWaitsToBeHandledGoesWhenTheClientIsClosed) {
  RawService service(std::string(rr_definition.text), "test.counter.Counter");
  auto node = std::make_unique<Node>(small_client());
  auto counter = node->connect<CounterStub>(service.url());
  std::atomic<int> handled{0};
  const auto handler = counter->ticked().connect([&](std::int32_t, const std::string&) {
    ++handled;
    std::this_thread::sleep_for(20ms);
  });
  std::vector<Answer> events(500, event(10));
  service.send(events);
  for (int i = 0; i < 500; ++i) service.send(event(10));
  ASSERT_TRUE(eventually([&] { return handled > 5; }));
  const auto begin = Clock::now();
  counter.close();
  const int at_close = handled;
  node.reset();
  EXPECT_LT(Clock::now() - begin, slowness() * 3s);
  EXPECT_LE(handled, at_close + 1);
}

// An object with pipes: endpoint 1 gets packets, and `sync` is answered with what is of no use.
class PipeService {
 public:
  PipeService()
      : service_(std::string(rr_pipe_board_definition.text), "test.pipes.PipeBoard",
                 [this](const ServiceRequest& request) { return handle(request); }) {}

  RawService* operator->() { return &service_; }
  void send_packet(std::uint32_t number, std::size_t size) {
    Answer packet;
    packet.type = EntryType::pipe_packet;
    packet.path = "raw";
    packet.member = "blobs";
    packet.elements = [number, value = Array<std::uint8_t>(size)](Writer& writer) {
      const std::size_t end = writer.position();
      type_of<Array<std::uint8_t>>.write(writer, "packet", &value);
      type_of<std::uint32_t>.write(writer, "packetnumber", &number);
      writer.element(ElementName(std::int32_t{1}), ElementType::dictionary, {}, 2, end);
      return 1U;
    };
    service_.send(packet);
  }

 private:
  bool handle(const ServiceRequest& request) {
    Answer answer = RawService::answer_to(request);
    if (request.type == EntryType::get_service_desc && request.service_type == "test.counter") {
      answer.elements = RawService::value("servicedef", std::string(rr_definition.text));
    } else if (request.type == EntryType::pipe_connect_req) {
      answer.elements = RawService::value<std::int32_t>("index", 1);
    } else if (request.type == EntryType::function_call_req) {
      answer.elements = RawService::value("return", std::string(900'000, 'b'));
    } else {
      return false;
    }
    service_.send(answer);
    return true;
  }

  RawService service_;
};

TEST(ClientLimits, FullPipesDoNotKeepALargeAnswerOut) {
  PipeService service;
  Node node(small_client());
  auto board = node.connect<PipeBoardStub>(service->url());
  auto blobs = board->blobs().connect();
  constexpr std::size_t packets = 34;
  for (std::uint32_t number = 1; number <= packets; ++number) service.send_packet(number, 100'000);
  ASSERT_TRUE(eventually([&] { return blobs.available() == packets; })) << blobs.available();
  const auto time_before = processor_time();
  EXPECT_EQ(code_of([&] { board->sync(); }), ErrorCode::none);
  EXPECT_LT(processor_time() - time_before, slowness() * 500ms);
  EXPECT_TRUE(board.is_open());
  EXPECT_TRUE(blobs.is_open());
}

TEST(ClientLimits, OnePacketTooManyEndsItsEndpointAlone) {
  PipeService service;
  Node node(small_client());
  auto board = node.connect<PipeBoardStub>(service->url());
  auto blobs = board->blobs().connect();
  for (std::uint32_t number = 1; number <= 40; ++number) service.send_packet(number, 100'000);
  EXPECT_TRUE(eventually([&] { return !blobs.is_open(); }));
  EXPECT_EQ(code_of([&] { board->sync(); }), ErrorCode::none);
  EXPECT_TRUE(board.is_open());
}

// Each step gives 100 kB, without end.
std::unique_ptr<RawService> endless_generator(std::atomic<int>& steps) {
  auto service = std::make_unique<RawService*>();
  RawService** const place = service.get();
  auto made = std::make_unique<RawService>(
      std::string(rr_board_definition.text), "test.board.Board",
      [&steps, place,
       kept = std::shared_ptr<RawService*>(std::move(service))](const ServiceRequest& request) {
        Answer answer = RawService::answer_to(request);
        if (request.type == EntryType::function_call_req) {
          answer.elements = RawService::value<std::int32_t>("index", 1);
        } else if (request.type == EntryType::generator_next_req) {
          ++steps;
          answer.elements = RawService::value("return", std::string(100'000, 'g'));
        } else {
          return false;
        }
        return (*place)->send(answer);
      });
  *place = made.get();
  return made;
}

TEST(ClientLimits, AllValuesOfAGeneratorWithoutEndAreRefused) {
  std::atomic<int> steps{0};
  const auto service = endless_generator(steps);
  Node node(small_client());
  auto board = node.connect<BoardStub>(service->url());
  const Error error = error_of([&] { board->names("x").all(); });
  EXPECT_EQ(error.code(), ErrorCode::out_of_system_resource) << error.what();
  EXPECT_NE(error.message().find("next()"), std::string::npos) << error.message();
  EXPECT_GE(steps, 30);
  EXPECT_LE(steps, 40);
  EXPECT_TRUE(board.is_open());
  // What was kept is given back, and steps one by one have no limit.
  const int before = steps;
  auto names = board->names("x");
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(names.next());
  EXPECT_GE(steps, before + 60);
  EXPECT_EQ(code_of([&] { board->names("x").all(); }), ErrorCode::out_of_system_resource);
  EXPECT_GE(steps, before + 90);
}

// Services whose callbacks block a function of the client each time, as often as they may.
TEST(ClientLimits, CallbacksOfManyServicesLeaveThreadsToOthers) {
  constexpr int services = 6;
  NodeOptions options;
  options.max_threads = 40;  // less than the services may have together
  options.request_timeout = 5s;
  Gate gate;
  Node node(options);
  const auto counter = node.register_service("counter", std::make_shared<Counter>());
  const std::uint16_t port = node.listen_tcp(0, "127.0.0.1");
  std::vector<std::unique_ptr<RawService>> hostile;
  std::vector<Client<BoardStub>> boards;
  for (int i = 0; i < services; ++i) {
    hostile.push_back(
        std::make_unique<RawService>(std::string(rr_board_definition.text), "test.board.Board"));
    boards.push_back(node.connect<BoardStub>(hostile.back()->url()));
    boards.back()->fail().set([&](const std::string& /*text*/) {
      gate.pass();
      return 1.0;
    });
  }
  for (const auto& service : hostile) {
    for (std::uint32_t number = 1; number <= 20; ++number) service->send(callback(number));
  }
  EXPECT_TRUE(gate.has_entered(20));
  EXPECT_TRUE(eventually([&] {
    const int before = gate.entered();
    std::this_thread::sleep_for(300ms);
    return gate.entered() == before;
  }));
  EXPECT_LT(gate.entered(), 40);
  Node honest(NodeOptions{.request_timeout = 5s});
  const auto begin = Clock::now();
  EXPECT_EQ(code_of([&] {
              auto client = honest.connect<CounterStub>(
                  "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=counter");
              for (int i = 0; i < 10; ++i) client->get_value();
            }),
            ErrorCode::none);
  EXPECT_LT(Clock::now() - begin, slowness() * 2s);
  gate.open();
  // Those that had to wait are called in the end.
  EXPECT_TRUE(gate.has_entered(services * 20)) << gate.entered();
}

}  // namespace
}  // namespace rr::testing
