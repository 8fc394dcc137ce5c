// SPDX-License-Identifier: Apache-2.0
// What the modifiers of members mean to a service, whatever its client may think of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "rr/locks.hpp"
#include "rr/memories.hpp"
#include "rr/pipes.hpp"
#include "rr/stored.hpp"
#include "rr/users.hpp"
#include "rr/wires.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_client.hpp"

namespace rr::testing {
namespace {

extern const ObjectType rr_Guarded;

constexpr std::string_view definition_text =
    "service test.guarded\n"
    "stdver 0.10\n"
    "object Guarded\n"
    "  property double p\n"
    "  property double p_open [nolock]\n"
    "  property double p_read [nolockread]\n"
    "  property double p_out [readonly]\n"
    "  property double p_in [writeonly]\n"
    "  function void f()\n"
    "  function void f_open() [nolock]\n"
    "  function double{generator} g()\n"
    "  function double{generator} g_open() [nolock]\n"
    "  pipe double s\n"
    "  pipe double s_open [nolock]\n"
    "  wire double w\n"
    "  wire double w_open [nolock]\n"
    "  wire double w_out [readonly]\n"
    "  wire double w_in [writeonly]\n"
    "  memory double[] m\n"
    "  memory double[] m_open [nolock]\n"
    "  memory double[] m_read [nolockread]\n"
    "  memory double[] m_out [readonly]\n"
    "  memory double[] m_in [writeonly]\n"
    "end\n";

constexpr Member members[] = {
    property<double>("p"),
    property<double>("p_open", nolock),
    property<double>("p_read", nolockread),
    property<double>("p_out", readonly),
    property<double>("p_in", writeonly),
    function<void>("f"),
    function<void>("f_open", {}, nolock),
    generator<double, void>("g"),
    generator<double, void>("g_open", {}, nolock),
    pipe<double>("s"),
    pipe<double>("s_open", nolock),
    wire<double>("w"),
    wire<double>("w_open", nolock),
    wire<double>("w_out", readonly),
    wire<double>("w_in", writeonly),
    memory<Array<double>>("m"),
    memory<Array<double>>("m_open", nolock),
    memory<Array<double>>("m_read", nolockread),
    memory<Array<double>>("m_out", readonly),
    memory<Array<double>>("m_in", writeonly),
};
constexpr const ObjectType* objects[] = {&rr_Guarded};
constinit const Definition definition{"test.guarded", definition_text, {0, 10, 0, 0}, {}, {}, {},
                                      objects};

class GuardedStub : public virtual Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Guarded; }
};
std::shared_ptr<Stub> make() { return std::make_shared<GuardedStub>(); }
constinit const ObjectType rr_Guarded{"test.guarded.Guarded", definition, {}, members, &make};

const Member& member(std::string_view name) {
  for (const Member& each : members) {
    if (each.name == name) return each;
  }
  throw Error(ErrorCode::member_not_found, std::string(name));
}

class Guarded : public Skeleton {
 public:
  Guarded() {
    for (const char* name : {"w", "w_open", "w_out"})
      WireServer<double>(*this, member(name)).set_in(1);
    for (const char* name : {"w", "w_open", "w_in"}) {
      WireServer<double>(*this, member(name)).on_peek_out([] { return 2.0; });
    }
  }
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Guarded; }
  void rr_dispatch(std::size_t place, Request& request) override {
    double value = 3;
    if (members[place].kind == MemberKind::function) return;
    if (request.is_set()) {
      request.read_value(&value);
      request.answer(nullptr);
    } else {
      request.answer(&value);
    }
  }
  std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override { return nullptr; }
  std::shared_ptr<MemorySource> rr_memory(std::size_t) override { return memory_; }

 private:
  const std::shared_ptr<StoredArrayMemory<double>> memory_ =
      std::make_shared<StoredArrayMemory<double>>(Array<double>{1, 2, 3, 4});
};

class Modifiers : public ::testing::Test {
 protected:
  // The error that a request is answered with.
  ErrorCode ask(EntryType type, std::string_view name) {
    client_.send(type, "guarded", name, [type](Writer& writer) -> std::uint32_t {
      const double value = 4;
      const std::int32_t index = 1;
      const std::uint64_t place = 1;
      const Array<double> data{5, 6};
      const std::uint64_t count = 2;
      const TimeSpec time{};
      switch (type) {
        case EntryType::property_set_req:
          type_of<double>.write(writer, "value", &value);
          return 1;
        case EntryType::generator_next_req:
        case EntryType::pipe_connect_req:
        case EntryType::pipe_disconnect_req:
          type_of<std::int32_t>.write(writer, "index", &index);
          return 1;
        case EntryType::wire_poke_out_value_req:
          type_of<double>.write(writer, "packet", &value);
          type_of<TimeSpec>.write(writer, "packettime", &time);
          return 2;
        case EntryType::memory_write:
          type_of<Array<double>>.write(writer, "data", &data);
          [[fallthrough]];
        case EntryType::memory_read:
          type_of<std::uint64_t>.write(writer, "count", &count);
          type_of<std::uint64_t>.write(writer, "memorypos", &place);
          return type == EntryType::memory_write ? 3 : 2;
        case EntryType::memory_get_param:
          writer.string_element("parameter", "Length");
          return 1;
        default:
          return 0;
      }
    });
    while (true) {
      const auto answer = client_.receive();
      if (!answer) return ErrorCode::request_timeout;
      if (answer->type != EntryType::wire_packet) return static_cast<ErrorCode>(answer->error);
    }
  }

  const std::shared_ptr<Guarded> object_ = std::make_shared<Guarded>();
  Node server_;
  Service service_ = server_.register_service(
      "guarded", object_,
      {.users =
           std::make_shared<PasswordUsers>("alice 6384e2b2184bcbf58eccf10ca7a6563c objectlock\n"),
       .require_user = false});
  Node locker_;
  RawClient client_{server_, "guarded"};
};

constexpr auto none = ErrorCode::none;
constexpr auto locked = ErrorCode::object_locked_error;

TEST_F(Modifiers, ForbidWhatAClientAsksForAllTheSame) {
  EXPECT_EQ(ask(EntryType::property_set_req, "p_out"), ErrorCode::read_only_member);
  EXPECT_EQ(ask(EntryType::property_get_req, "p_out"), none);
  EXPECT_EQ(ask(EntryType::property_get_req, "p_in"), ErrorCode::write_only_member);
  EXPECT_EQ(ask(EntryType::property_set_req, "p_in"), none);
  EXPECT_EQ(ask(EntryType::wire_peek_in_value_req, "w_out"), none);
  EXPECT_EQ(ask(EntryType::wire_peek_out_value_req, "w_out"), ErrorCode::read_only_member);
  EXPECT_EQ(ask(EntryType::wire_poke_out_value_req, "w_out"), ErrorCode::read_only_member);
  EXPECT_EQ(ask(EntryType::wire_peek_in_value_req, "w_in"), ErrorCode::write_only_member);
  EXPECT_EQ(ask(EntryType::wire_peek_out_value_req, "w_in"), none);
  EXPECT_EQ(ask(EntryType::wire_poke_out_value_req, "w_in"), none);
  EXPECT_EQ(ask(EntryType::memory_write, "m_out"), ErrorCode::read_only_member);
  EXPECT_EQ(ask(EntryType::memory_read, "m_out"), none);
  EXPECT_EQ(ask(EntryType::memory_read, "m_in"), ErrorCode::write_only_member);
  EXPECT_EQ(ask(EntryType::memory_write, "m_in"), none);
}

// 07, section 6: which requests a lock keeps out, and what passes for nolock and nolockread.
TEST_F(Modifiers, SayWhatALockKeepsOut) {
  const std::uint16_t port = server_.listen_tcp(0, "127.0.0.1");
  auto alice = locker_.connect<GuardedStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                            "/?service=guarded");
  alice.authenticate("alice", {{"password", VarValue("alice")}});
  lock(*alice);
  struct Case {
    EntryType type;
    const char* plain;
    const char* open;
    ErrorCode when_open = none;
  };
  const Case cases[] = {
      {EntryType::property_get_req, "p", "p_open"},
      {EntryType::property_set_req, "p", "p_open"},
      {EntryType::function_call_req, "f", "f_open", ErrorCode::none},
      {EntryType::generator_next_req, "g", "g_open",
       ErrorCode::invalid_operation},  // there is none
      {EntryType::pipe_connect_req, "s", "s_open"},
      {EntryType::pipe_disconnect_req, "s", "s_open"},
      {EntryType::wire_connect_req, "w", "w_open"},
      {EntryType::wire_disconnect_req, "w", "w_open"},
      {EntryType::wire_peek_in_value_req, "w", "w_open"},
      {EntryType::wire_peek_out_value_req, "w", "w_open"},
      {EntryType::wire_poke_out_value_req, "w", "w_open"},
      {EntryType::memory_read, "m", "m_open"},
      {EntryType::memory_write, "m", "m_open"},
      {EntryType::memory_get_param, "m", "m_open"},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(ask(one.type, one.plain), locked) << static_cast<int>(one.type);
    EXPECT_EQ(ask(one.type, one.open), one.when_open) << static_cast<int>(one.type);
  }
  EXPECT_EQ(ask(EntryType::property_get_req, "p_read"), none);
  EXPECT_EQ(ask(EntryType::property_set_req, "p_read"), locked);
  EXPECT_EQ(ask(EntryType::memory_read, "m_read"), none);
  EXPECT_EQ(ask(EntryType::memory_get_param, "m_read"), none);
  EXPECT_EQ(ask(EntryType::memory_write, "m_read"), locked);
  unlock(*alice);
  EXPECT_EQ(ask(EntryType::property_set_req, "p_read"), none);
}

// A counter whose value is `perclient`.
struct Held {
  double number = 0;
  std::shared_ptr<int> token;
};
class PerClient : public Counter {
 public:
  double get_value() override { return value.get().number; }
  void set_value(double number) override { value.set({number, token}); }
  void reset() override {
    std::thread([&] { elsewhere = value.get().number; }).join();
  }
  StoredPerClient<Held> value{Held{7, nullptr}};
  std::shared_ptr<int> token = std::make_shared<int>();
  double elsewhere = 0;
};

TEST(PerClientProperties, HaveAValueForEachClient) {
  const auto object = std::make_shared<PerClient>();
  Pair pair({}, {}, object);
  auto first = pair.connect();
  auto second = pair.connect();
  EXPECT_EQ(first->get_value(), 7);
  first->set_value(1);
  EXPECT_EQ(first->get_value(), 1);
  EXPECT_EQ(second->get_value(), 7);
  second->set_value(2);
  second->set_value(3);
  EXPECT_EQ(first->get_value(), 1);
  EXPECT_EQ(second->get_value(), 3);
  EXPECT_EQ(pair.connect()->get_value(), 7);
}

TEST(PerClientProperties, OfAClientThatLeavesAreForgotten) {
  const auto object = std::make_shared<PerClient>();
  Pair pair({}, {}, object);
  auto second = pair.connect();
  second->set_value(2);
  {
    auto first = pair.connect();
    first->set_value(1);
    EXPECT_EQ(object->token.use_count(), 3);
  }
  EXPECT_TRUE(eventually([&] { return object->token.use_count() == 2; }));
  EXPECT_EQ(second->get_value(), 2);
  EXPECT_EQ(pair.connect()->get_value(), 7);
}

TEST(PerClientProperties, OutsideOfHandlersAreWhatClientsStartWith) {
  const auto object = std::make_shared<PerClient>();
  Pair pair({}, {}, object);
  auto first = pair.connect();
  first->set_value(1);
  EXPECT_EQ(object->value.get().number, 7);
  object->value.set({9, nullptr});
  EXPECT_EQ(first->get_value(), 1);
  EXPECT_EQ(pair.connect()->get_value(), 9);
  first->reset();  // another thread than the handler's is outside
  EXPECT_EQ(object->elsewhere, 9);
}

TEST(PerClientProperties, MayOutliveTheirObjectsClientsAndTheOtherWayRound) {
  auto object = std::make_shared<PerClient>();
  Pair pair;
  auto service = pair.server.register_service("second", object);
  auto client = pair.client.connect<CounterStub>(pair.url("second"));
  client->set_value(1);
  const std::weak_ptr<int> token = object->token;
  client.close();
  EXPECT_TRUE(eventually([&] { return object->token.use_count() == 1; }));
  auto again = pair.client.connect<CounterStub>(pair.url("second"));
  again->set_value(1);
  service->close();
  service = {};
  object = {};
  EXPECT_TRUE(eventually([&] { return token.expired(); }));
}

}  // namespace
}  // namespace rr::testing
