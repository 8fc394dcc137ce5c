// SPDX-License-Identifier: Apache-2.0
// A service whose answers are none: to other requests, of other types, twice, late, unasked.
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "rr/callbacks.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/kept_log.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_client.hpp"
#include "runtime/cpp/src/node/testing/raw_service.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

using Answer = RawService::Answer;
using ServiceRequest = RawService::Request;

const NodeId evil = NodeId::parse("eeeeeeee-eeee-4eee-8eee-eeeeeeeeeeee").value();

// A service of counters. `before` sends something for each get of `value`, before its answer, 1.5.
class ForgingService {
 public:
  using Forge = std::function<void(RawService&, const ServiceRequest&)>;
  explicit ForgingService(Forge before)
      : before_(std::move(before)),
        service_(std::string(rr_definition.text), "test.counter.Counter",
                 [this](const ServiceRequest& request) { return handle(request); }) {}

  RawService* operator->() { return &service_; }
  [[nodiscard]] const std::vector<ServiceRequest>& requests() const { return requests_; }

 private:
  bool handle(const ServiceRequest& request) {
    requests_.push_back(request);
    if (request.type != EntryType::property_get_req) return false;
    before_(service_, request);
    Answer answer = RawService::answer_to(request);
    answer.elements = RawService::value("value", 1.5);
    service_.send(answer);
    return true;
  }

  const Forge before_;
  std::vector<ServiceRequest> requests_;  // before the thread that adds to it
  RawService service_;
};

Answer forged_identity(const ServiceRequest& request, EntryType type) {
  Answer answer = RawService::answer_to(request);
  answer.type = type;
  answer.endpoint = 0x66666666;
  answer.node_name = "evil." + std::string(120, 'x');
  answer.node = evil;
  return answer;
}

TEST(Answers, ToAGetAsOneToAConnectRequestLeavesTheServicesIdentity) {
  for (const EntryType type :
       {EntryType::connect_client_ret, EntryType::connect_client_combined_ret}) {
    ForgingService service([&](RawService& raw, const ServiceRequest& request) {
      raw.send(forged_identity(request, type));
      Answer unasked = forged_identity(request, type);
      unasked.id = 0;
      raw.send(unasked);
      unasked.id = 1;  // a connect request that was answered long ago
      raw.send(unasked);
    });
    KeptLog log;
    Node node(log.options());
    auto counter = node.connect<CounterStub>(service->url());
    const std::string_view name = counter.remote_name();
    const NodeId id = counter.remote_node();
    for (int i = 0; i < 3; ++i) EXPECT_EQ(counter->get_value(), 1.5);
    EXPECT_EQ(counter.remote_name(), "raw.service");
    EXPECT_EQ(name, "raw.service") << "what was given out before";
    EXPECT_EQ(counter.remote_node(), id);
    EXPECT_EQ(id, service->node());
    EXPECT_EQ(log.with("such entries are dropped").size(), 1U) << "once a session";
  }
}

TEST(Answers, OfAConnectRequestCountTheFirstTime) {
  std::unique_ptr<RawService> service;
  service = std::make_unique<RawService>(
      std::string(rr_definition.text), "test.counter.Counter", [&](const ServiceRequest& request) {
        if (request.type == EntryType::connect_client) {
          service->send(RawService::answer_to(request));
          service->send(forged_identity(request, EntryType::connect_client_ret));
          return true;
        }
        if (request.type != EntryType::property_get_req) return false;
        Answer late = forged_identity(request, EntryType::connect_client_ret);
        late.id -= 1;
        service->send(late);
        Answer answer = RawService::answer_to(request);
        answer.elements = RawService::value("value", 2.5);
        service->send(answer);
        return true;
      });
  Node node;
  auto counter = node.connect<CounterStub>(service->url());
  EXPECT_EQ(counter->get_value(), 2.5);
  EXPECT_EQ(counter.remote_name(), "raw.service");
  EXPECT_EQ(counter.remote_node(), service->node());
}

TEST(Answers, OfEveryOtherTypeAreDropped) {
  // All even numbers that mean something, but the right one.
  std::vector<std::uint16_t> types;
  for (int type = 2; type <= 1190; type += 2) {
    if (type != 1112 && type != 1142) types.push_back(static_cast<std::uint16_t>(type));
  }
  ForgingService service([&](RawService& raw, const ServiceRequest& request) {
    for (const std::uint16_t type : types) {
      if (type <= 4 || type == 112) continue;  // of the connection itself
      Answer answer = RawService::answer_to(request);
      answer.type = static_cast<EntryType>(type);
      answer.elements = RawService::value("value", 66.6);
      raw.send(answer);
      answer.error = 2;
      answer.elements = RawService::error_elements("RobotRaconteur.ProtocolError", "forged");
      raw.send(answer);
    }
  });
  KeptLog log;
  Node node(log.options());
  auto counter = node.connect<CounterStub>(service->url());
  EXPECT_EQ(counter->get_value(), 1.5);
  EXPECT_EQ(counter->get_value(), 1.5);
  EXPECT_TRUE(counter.is_open());
  EXPECT_EQ(log.with("such entries are dropped").size(), 1U);
}

TEST(Answers, ForAnotherMemberOrPathAreDropped) {
  ForgingService service([&](RawService& raw, const ServiceRequest& request) {
    Answer answer = RawService::answer_to(request);
    answer.elements = RawService::value("value", 66.6);
    answer.member = "hidden";
    raw.send(answer);
    answer.member = request.member;
    answer.path = request.path + ".child";
    raw.send(answer);
    answer.path = request.path;
    answer.id += 1;
    raw.send(answer);
  });
  Node node;
  auto counter = node.connect<CounterStub>(service->url());
  EXPECT_EQ(counter->get_value(), 1.5);
  EXPECT_EQ(counter->get_fixed(), 1.5);
}

TEST(Answers, ThatLeaveOutPathAndMemberAreTaken) {
  std::unique_ptr<RawService> service;
  service = std::make_unique<RawService>(std::string(rr_definition.text), "test.counter.Counter",
                                         [&](const ServiceRequest& request) {
                                           if (request.type != EntryType::property_get_req)
                                             return false;
                                           Answer answer = RawService::answer_to(request);
                                           answer.path.clear();
                                           answer.member.clear();
                                           answer.elements = RawService::value("value", 3.5);
                                           service->send(answer);
                                           return true;
                                         });
  Node node;
  auto counter = node.connect<CounterStub>(service->url());
  EXPECT_EQ(counter->get_value(), 3.5);
}

TEST(Answers, ToFinishedCallsAreDropped) {
  std::vector<ServiceRequest> before;
  ForgingService service([&](RawService& raw, const ServiceRequest& request) {
    before.push_back(request);
    for (const ServiceRequest& old : before) {
      if (old.id == request.id) continue;
      Answer answer = RawService::answer_to(old);
      answer.elements = RawService::value("value", 66.6);
      raw.send(answer);
    }
  });
  Node node;
  auto counter = node.connect<CounterStub>(service->url());
  for (int i = 0; i < 10; ++i) EXPECT_EQ(counter->get_value(), 1.5);
}

TEST(Answers, ForAsynchronousCallsAreHeldToTheSame) {
  ForgingService service([&](RawService& raw, const ServiceRequest& request) {
    raw.send(forged_identity(request, EntryType::connect_client_ret));
    Answer answer = RawService::answer_to(request);
    answer.type = EntryType::function_call_res;
    answer.elements = RawService::value("value", 66.6);
    raw.send(answer);
  });
  Node node;
  auto counter = node.connect<CounterStub>(service->url());
  std::vector<std::future<double>> values;
  for (int i = 0; i < 20; ++i) {
    values.push_back(counter->async_get_value(boost::asio::use_future));
  }
  for (auto& value : values) EXPECT_EQ(value.get(), 1.5);
  EXPECT_EQ(counter.remote_name(), "raw.service");
}

// Each kind of request, with an answer of each other kind before its own, which is an error here.
TEST(Answers, OfTheWrongTypeToEachKindOfRequestAreDropped) {
  std::unique_ptr<RawService> service;
  std::atomic<int> asked{0};
  const auto answer_all = [&](const ServiceRequest& request) {
    if (static_cast<int>(request.type) < 1111) return false;
    ++asked;
    for (int type = 102; type < 1190; type += 2) {
      if (type == static_cast<int>(request.type) + 1 || type == 112 || type == 1142) continue;
      if (request.type == EntryType::memory_write && type == 1172) continue;
      Answer wrong = forged_identity(request, static_cast<EntryType>(type));
      wrong.elements = RawService::value("return", std::int32_t{7});
      service->send(wrong);
    }
    Answer answer = RawService::answer_to(request);
    answer.error = static_cast<std::uint16_t>(ErrorCode::operation_failed);
    answer.elements = RawService::error_elements("RobotRaconteur.OperationFailed", "told");
    service->send(answer);
    return true;
  };
  Node node;
  {
    service = std::make_unique<RawService>(std::string(rr_definition.text), "test.counter.Counter",
                                           answer_all);
    auto counter = node.connect<CounterStub>(service->url());
    EXPECT_EQ(code_of([&] { counter->get_value(); }), ErrorCode::operation_failed);
    EXPECT_EQ(code_of([&] { counter->set_value(1); }), ErrorCode::operation_failed);
    EXPECT_EQ(code_of([&] { counter->reset(); }), ErrorCode::operation_failed);
    EXPECT_EQ(counter.remote_name(), "raw.service");
    counter.close();
  }
  {
    service = std::make_unique<RawService>("service test.wired\nobject Wired\nend\n",
                                           "test.wired.Wired", answer_all);
    ConnectOptions options;
    options.definition_check = DefinitionCheck::off;
    auto wired = node.connect<WiredStub>(service->url(), options);
    EXPECT_EQ(code_of([&] { wired->level().connect(); }), ErrorCode::operation_failed);
    EXPECT_EQ(code_of([&] { wired->level().peek_in(); }), ErrorCode::operation_failed);
    EXPECT_EQ(code_of([&] { wired->level().peek_out(); }), ErrorCode::operation_failed);
    EXPECT_EQ(code_of([&] { wired->level().poke_out(1); }), ErrorCode::operation_failed);
    EXPECT_EQ(wired.remote_name(), "raw.service");
    wired.close();
  }
  EXPECT_EQ(asked, 7);
}

TEST(Answers, OfAClientToWhatAnyNodeMayBeAsked) {
  RawService service(std::string(rr_definition.text), "test.counter.Counter");
  Node node;
  auto counter = node.connect<CounterStub>(service.url());
  constexpr auto unknown = static_cast<EntryType>(199);
  std::uint32_t id = 1000;
  for (const EntryType type : {EntryType::get_node_info, EntryType::node_check_capability,
                               EntryType::endpoint_check_capability, unknown}) {
    service.send({.type = type, .path = "", .member = "", .id = ++id});
  }
  ASSERT_TRUE(eventually([&] { return service.answers().size() == 4; }));
  constexpr auto refusal = static_cast<std::uint16_t>(ErrorCode::protocol_error);
  using Given = std::vector<std::pair<EntryType, std::uint16_t>>;
  EXPECT_EQ(service.answers(), (Given{{EntryType::get_node_info_ret, 0},
                                      {EntryType::node_check_capability_ret, 0},
                                      {EntryType::endpoint_check_capability_ret, 0},
                                      {static_cast<EntryType>(200), refusal}}));
}

// A client that answers a callback with something else, which a service of ours has called.
TEST(Answers, OfAClientToACallbackAreHeldToTheSame) {
  KeptLog log;
  Node server(log.options());
  const auto board = std::make_shared<Board>();
  auto service = server.register_service("board", board);
  RawClient client(server, "board");
  const std::uint32_t number = service->clients().at(0).endpoint;
  auto sum = std::async(std::launch::async, [&] { return board->sum(number, 1, 2); });
  const RawClient::Answer request = client.receive().value();
  ASSERT_EQ(request.type, EntryType::callback_call_req);
  const auto answer = [&](EntryType type, std::string path, std::string member,
                          std::int32_t value) {
    const RawClient::Request sent{type, std::move(path), std::move(member),
                                  [value](Writer& writer) {
                                    type_of<std::int32_t>.write(writer, "return", &value);
                                    return 1U;
                                  },
                                  request.id};
    client.send({&sent, 1});
  };
  for (int i = 0; i < 3; ++i) {
    answer(EntryType::property_get_res, "board", "sum", 6);
    answer(EntryType::connect_client_ret, "board", "sum", 6);
    answer(EntryType::callback_call_ret, "board", "describe", 6);
    answer(EntryType::callback_call_ret, "board.child", "sum", 6);
  }
  answer(EntryType::callback_call_ret, "board", "sum", 3);
  EXPECT_EQ(sum.get(), 3);
  EXPECT_TRUE(eventually([&] { return !log.with("such entries are dropped").empty(); }));
  EXPECT_EQ(log.with("such entries are dropped").size(), 1U);
}

}  // namespace
}  // namespace rr::testing
