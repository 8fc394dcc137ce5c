// SPDX-License-Identifier: Apache-2.0
// Generators, pipes, wires, callbacks, memories and monitors of services without generated code.
#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <mutex>
#include <semaphore>

#include "rr/error.hpp"
#include "rr/lock_keeper.hpp"
#include "rr/locks.hpp"
#include "rr/node.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/dynamic/rig.hpp"
#include "runtime/cpp/src/dynamic/testing.hpp"

namespace rr::dynamic {
namespace {

using ::testing::ElementsAre;
using testing::error_text;
using testing::rig_definitions;

using testing::limit;

class DynamicStreams : public testing::Rigged {};
INSTANTIATE_TEST_SUITE_P(Versions, DynamicStreams, ::testing::Values(2, 4));

Value vector(double x, double y, double z) { return StringMap{{"x", x}, {"y", y}, {"z", z}}; }
Value sample(int id) { return StringMap{{"id", id}, {"at", List{id, 2, 3}}}; }

Sequence<Value> count_to(double end) {
  for (double value = 0; value < end; ++value) co_yield Value(value);
}
Sequence<Value, Value> sum_from(double start) {
  while (true) {
    const Value next = co_await taken<Value>;
    start += next.as<double>();
    co_yield Value(start);
  }
}
Sequence<void, Value> collect_into(std::shared_ptr<std::atomic<std::size_t>> collected) {
  while (true) {
    const Value note = co_await taken<Value>;
    if (note.is_null()) co_return;
    *collected += note["numbers"].size();
  }
}

TEST_P(DynamicStreams, StepThroughSequences) {
  const auto collected = std::make_shared<std::atomic<std::size_t>>(0);
  rig.on_generate("count",
                  [](const List& arguments) { return count_to(arguments[0].as<double>()); });
  rig.on_generate("sum", [](const List& arguments) { return sum_from(arguments[0].as<double>()); });
  rig.on_generate("collect", [=](const List&) { return collect_into(collected); });
  Generator count = client->generate("count", {2});
  EXPECT_EQ(count.next()->as<double>(), 0);
  EXPECT_EQ(count.next()->as<double>(), 1);
  EXPECT_EQ(count.next(), std::nullopt);
  Generator sum = client->generate("sum", {10});
  EXPECT_EQ(sum.next(1)->as<double>(), 11);
  EXPECT_EQ(sum.next(2)->as<double>(), 13);
  sum.close();
  Generator collect = client->generate("collect");
  EXPECT_TRUE(collect.next(StringMap{{"text", "a"}, {"numbers", List{1, 2}}}).has_value());
  EXPECT_EQ(collect.next(Value()), std::nullopt);
  EXPECT_EQ(*collected, 2U);
}

TEST_P(DynamicStreams, StepThroughFunctions) {
  std::promise<bool> ended;
  rig.on_generate("sum", [&](const List& arguments) {
    auto sum = std::make_shared<double>(arguments[0].as<double>());
    return Steps(
        [sum](const Value& value) -> std::optional<Value> {
          if (value.as<double>() < 0) throw Error(ErrorCode::out_of_range, "negative");
          if (value.as<double>() > 100) return Value("much");
          return *sum += value.as<double>();
        },
        [&](bool aborts) { ended.set_value(aborts); });
  });
  Generator sum = client->generate("sum", {1});
  EXPECT_EQ(sum.next(2)->as<double>(), 3);
  sum.abort();
  EXPECT_TRUE(ended.get_future().get());
  EXPECT_EQ(error_text([&] { (void)client->generate("sum", {1}).next(-1); }), "29: negative");
  EXPECT_EQ(error_text([&] { (void)client->generate("sum", {1}).next(101); }),
            "11: member sum, result: expected double, got string");
}

TEST_P(DynamicStreams, GiveStepsOfTheDeclaredForm) {
  rig.on_generate("sum", [](const List&) { return count_to(2); });
  EXPECT_EQ(error_text([&] { (void)client->generate("sum", {1}).next(1); }),
            "17: member sum: its steps give or take otherwise than declared");
}

TEST_P(DynamicStreams, SendAndReceivePackets) {
  std::promise<PipeEndpoint> connected;
  rig.pipe("samples").on_connect([&](const PipeEndpoint& end) { connected.set_value(end); });
  PipeEndpoint end = client->pipe("samples").connect();
  PipeEndpoint served = connected.get_future().get();
  EXPECT_EQ(rig.pipe("samples").endpoint_count(), 1U);
  rig.pipe("samples").send(List{sample(1), sample(2)});
  served.send(List{sample(3)});
  EXPECT_EQ(end.receive_for(limit)->size(), 2U);
  EXPECT_EQ(end.receive_for(limit)->at(0)["id"].as<int>(), 3);
  end.send(List{sample(4)});
  EXPECT_EQ(served.receive_for(limit)->at(0)["at"].at(0).as<double>(), 4);
  EXPECT_EQ(error_text([&] { rig.pipe("samples").send(List{1}); }),
            "11: member samples, item [0]: expected example.parts.Sample, got int32");
  EXPECT_EQ(rig.pipe("samples").endpoints().size(), 1U);
}

TEST_P(DynamicStreams, CarryWireValues) {
  const WireServer force = rig.wire("force");
  std::promise<std::pair<Value, std::uint32_t>> came;
  force.on_out([&](const Value& value, const TimeSpec&, std::uint32_t from) {
    came.set_value({value, from});
  });
  force.set_in(vector(1, 2, 3));
  WireConnection connection = client->wire("force").connect();
  ASSERT_TRUE(connection.wait_in(limit));
  EXPECT_EQ(connection.in()["y"].as<double>(), 2);
  EXPECT_EQ(client->wire("force").peek_in().value["z"].as<double>(), 3);
  connection.set_out(vector(4, 5, 6));
  const auto [value, from] = came.get_future().get();
  EXPECT_EQ(value["x"].as<double>(), 4);
  EXPECT_EQ(force.out()->value, value);
  ASSERT_EQ(force.connection_count(), 1U);
  EXPECT_EQ(force.connections().at(0).client(), from);
  force.connections().at(0).set_in(vector(7, 8, 9));
  std::promise<void> seven;
  std::atomic<bool> is_seven = false;
  const Subscription values = connection.on_in([&](const Value& one, const TimeSpec&) {
    if (one["x"].as<double>() == 7 && !is_seven.exchange(true)) seven.set_value();
  });
  EXPECT_EQ(seven.get_future().wait_for(limit), std::future_status::ready);
  EXPECT_EQ(error_text([&] { force.set_in(1); }),
            "11: member force: expected example.parts.Vector3, got int32");
}

TEST_P(DynamicStreams, AnswerPeeksByFunctions) {
  const WireServer level = rig.wire("level");
  level.on_peek_in([] { return Value(1); });
  level.on_peek_out([] { return Value("high"); });
  EXPECT_EQ(client->wire("level").peek_in().value, Value(1.0));
  EXPECT_EQ(error_text([&] { (void)client->wire("level").peek_out(); }),
            "11: member level: expected double, got string");
  client->wire("level").poke_out(3);
  EXPECT_EQ(level.out()->value.as<double>(), 3);
}

TEST_P(DynamicStreams, CallBackTheirClient) {
  rig.on_call("call_ping", [weak = WeakServedObject(rig)](const List&) {
    return weak.lock().call_back("ping", ServiceContext::current_client());
  });
  std::atomic<int> pings = 0;
  client->callback("ping").set([&](const List&) {
    ++pings;
    return Value();
  });
  client->call("call_ping");
  EXPECT_EQ(pings, 1);

  client->callback("ask").set([](const List& arguments) -> Value {
    if (arguments[0].text() == "fail")
      throw Error(ErrorCode::remote_error, "example.rig.Jam", "no");
    return StringMap{{"text", arguments[0].text() + "!"}, {"numbers", List{arguments[1]["x"]}}};
  });
  const std::uint32_t number = service->clients().at(0).endpoint;
  const Value answer = rig.call_back("ask", number, {"who", vector(1, 2, 3)});
  EXPECT_EQ(answer["text"].text(), "who!");
  EXPECT_EQ(error_text([&] {
              rig.call_back("ask", number, {"fail", vector(1, 2, 3)});
            }),
            "100: no");
  std::promise<Value> later;
  rig.async_call_back("ask", number, {"later", vector(1, 2, 3)},
                      [&](const std::exception_ptr& error, const Value& value) {
                        EXPECT_EQ(error, nullptr);
                        later.set_value(value);
                      });
  EXPECT_EQ(later.get_future().get()["text"].text(), "later!");
  EXPECT_EQ(error_text([&] {
              rig.call_back("ask", number, {1, vector(1, 2, 3)});
            }),
            "11: member ask, parameter question: expected string, got int32");
}

TEST_P(DynamicStreams, KeepMemories) {
  rig.store_memory("buffer", List{0, 1, 2, 3});
  rig.store_memory("grid", StringMap{{"dims", List{2, 2}},
                                     {"array", List{sample(1), sample(2), sample(3), sample(4)}}});
  const Memory buffer = client->memory("buffer");
  EXPECT_EQ(buffer.length(), 4U);
  buffer.write({1}, List{10, 20});
  EXPECT_THAT(buffer.read({0}, {4}).array<double>(), ElementsAre(0, 10, 20, 3));
  EXPECT_THAT(rig.stored_memory("buffer").array<double>(), ElementsAre(0, 10, 20, 3));
  const Memory grid = client->memory("grid");
  EXPECT_THAT(grid.dims(), ElementsAre(2, 2));
  const Value column = grid.read({0, 1}, {2, 1});
  EXPECT_EQ(column.at(0)["id"].as<int>(), 3);
  grid.write({1, 0}, StringMap{{"dims", List{1, 1}}, {"array", List{sample(9)}}});
  EXPECT_EQ(rig.stored_memory("grid").at(1)["id"].as<int>(), 9);
  // Dims of 1 at the end may be left out, or be too many.
  grid.write({0, 1}, StringMap{{"dims", List{1}}, {"array", List{sample(7)}}});
  grid.write({1, 1}, StringMap{{"dims", List{1, 1, 1}}, {"array", List{sample(8)}}});
  EXPECT_EQ(rig.stored_memory("grid").at(2)["id"].as<int>(), 7);
  EXPECT_EQ(rig.stored_memory("grid").at(3)["id"].as<int>(), 8);
  EXPECT_EQ(error_text([&] { (void)buffer.read({3}, {2}); }).substr(0, 3), "29:");
}

TEST_P(DynamicStreams, GiveMemoriesByFunctions) {
  std::vector<std::uint64_t> written_at;
  Value written;
  rig.serve_memory("flags", {.dims = [] { return MemoryFunctions::Numbers{5}; },
                             .read =
                                 [](const auto& position, const auto& count) {
                                   List flags(count[0], position[0] == 0);
                                   return Value(std::move(flags));
                                 },
                             .write =
                                 [&](const auto& position, const Value& items) {
                                   written_at = position;
                                   written = items;
                                 }});
  rig.serve_memory("buffer", {.dims = [] { return MemoryFunctions::Numbers{5}; },
                              .read =
                                  [](const auto&, const auto&) {
                                    return Value(List{1, 2});
                                  }});
  const Memory flags = client->memory("flags");
  EXPECT_THAT(flags.read({0}, {2}).array<bool>(), ElementsAre(true, true));
  EXPECT_THAT(flags.read({1}, {1}).array<bool>(), ElementsAre(false));
  flags.write({3}, List{true, false});
  EXPECT_THAT(written_at, ElementsAre(3));
  EXPECT_THAT(written.array<bool>(), ElementsAre(true, false));
  const Memory buffer = client->memory("buffer");
  EXPECT_THAT(buffer.read({0}, {2}).array<double>(), ElementsAre(1, 2));
  EXPECT_EQ(error_text([&] { (void)buffer.read({0}, {3}); }),
            "11: member buffer: expected 3 items, got 2");
  EXPECT_EQ(error_text([&] { buffer.write({0}, List{1}); }).substr(0, 4), "104:");
}

TEST_P(DynamicStreams, HaveMonitors) {
  const auto free = std::make_shared<std::binary_semaphore>(1);
  const ServedObject guarded(rig_definitions(), "example.rig.Rig");
  guarded.set_monitor(
      [free](std::chrono::milliseconds timeout) { return free->try_acquire_for(timeout); },
      [free] { free->release(); });
  const Service offered = register_service(server, "guarded", guarded);
  const Client other = connect(node, url.substr(0, url.rfind('=') + 1) + "guarded");
  {
    const MonitorLock lock(other->stub(), limit);
    EXPECT_FALSE(free->try_acquire());
  }
  EXPECT_TRUE(free->try_acquire_for(limit));
}

constexpr const char* lab_definition = R"(service test.lab
stdver 0.10
object Lab
  pipe double samples
  pipe double notes [nolock]
  wire double level [readonly]
  wire double light [nolock]
end
)";

// Keeps all locks in its hands, and notes what it is asked.
class Strict final : public LockKeeper {
 public:
  void keep(LockRequest /*request*/, Answer answer) override { answer(nullptr, false); }
  void check_connect(const ConnectAttempt& attempt) override {
    const std::scoped_lock lock(mutex_);
    asked_.push_back(attempt.path + "." + std::string(attempt.member->name));
    client_ = attempt.client;
    if (is_locked) throw Error(ErrorCode::object_locked_error, "by another robot");
  }
  std::vector<std::string> asked() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(asked_, {});
  }
  std::uint32_t client() {
    const std::scoped_lock lock(mutex_);
    return client_;
  }

  std::atomic<bool> is_locked{true};

 private:
  std::mutex mutex_;
  std::vector<std::string> asked_;
  std::uint32_t client_ = 0;
};

TEST(DynamicLocks, AKeeperIsAskedBeforeAPipeOrWireIsConnected) {
  ServedObject lab(Definitions({lab_definition}), "test.lab.Lab");
  lab.wire("level").set_in(1.5);
  const auto keeper = std::make_shared<Strict>();
  Node server;
  Node node;
  const Service service = register_service(server, "lab", lab, {.lock_keeper = keeper});
  const Client client =
      connect(node, "rr+tcp://localhost:" + std::to_string(server.listen_tcp(0)) + "/?service=lab");

  EXPECT_EQ(error_text([&] { client->pipe("samples").connect(); }), "151: by another robot");
  EXPECT_EQ(error_text([&] { client->wire("level").connect(); }), "151: by another robot");
  EXPECT_THAT(keeper->asked(), ElementsAre("lab.samples", "lab.level"));
  EXPECT_EQ(keeper->client(), service->clients().front().endpoint);
  EXPECT_EQ(lab.pipe("samples").endpoint_count(), 0U);
  EXPECT_EQ(lab.wire("level").connection_count(), 0U);

  const PipeEndpoint notes = client->pipe("notes").connect();
  const WireConnection light = client->wire("light").connect();
  EXPECT_TRUE(notes.is_open());
  EXPECT_TRUE(light.is_open());
  EXPECT_TRUE(keeper->asked().empty());

  keeper->is_locked = false;
  const PipeEndpoint samples = client->pipe("samples").connect();
  const WireConnection level = client->wire("level").connect();
  EXPECT_EQ(lab.pipe("samples").endpoint_count(), 1U);
  EXPECT_EQ(lab.wire("level").connection_count(), 1U);
  EXPECT_THAT(keeper->asked(), ElementsAre("lab.samples", "lab.level"));
}

// Lets everyone in, to lock what there is.
class Lockers final : public Users {
 public:
  [[nodiscard]] User authenticate(const std::string& name,
                                  const std::map<std::string, VarValue>& /*credentials*/,
                                  const NodeId& /*node*/) const override {
    return {.name = name, .privileges = {"objectlock"}};
  }
};

// What a lock says of a client that would connect a pipe.
std::string lock_check(const Pipe& pipe) {
  std::promise<void> done;
  pipe.async_check_lock([&](const std::exception_ptr& error) {
    error ? done.set_exception(error) : done.set_value();
  });
  return error_text([&] { done.get_future().get(); });
}

TEST(DynamicLocks, OfAPipeAreFoundWithoutAnEndpoint) {
  ServedObject lab(Definitions({lab_definition}), "test.lab.Lab");
  std::atomic<int> connected{0};
  for (const char* pipe : {"samples", "notes"}) {
    lab.pipe(pipe).on_connect([&](const PipeEndpoint&) { ++connected; });
  }
  Node server;
  Node node;
  const Service service =
      register_service(server, "lab", lab, {.users = std::make_shared<Lockers>()});
  const std::string url =
      "rr+tcp://localhost:" + std::to_string(server.listen_tcp(0)) + "/?service=lab";
  const ConnectOptions login{.username = "operator"};
  const Client holder = connect(node, url, login);
  const Client other = connect(node, url, login);

  EXPECT_EQ(lock_check(other->pipe("samples")).substr(0, 4), "18: ") << "no endpoint, no lock";
  lock(holder->stub(), LockOwner::session);
  EXPECT_EQ(lock_check(other->pipe("samples")).substr(0, 5), "151: ");
  EXPECT_EQ(lock_check(other->pipe("notes")).substr(0, 4), "18: ") << "of no lock";
  EXPECT_EQ(lock_check(holder->pipe("samples")).substr(0, 4), "18: ");
  const PipeEndpoint samples = holder->pipe("samples").connect();
  EXPECT_EQ(lock_check(holder->pipe("samples")).substr(0, 4), "18: ");
  EXPECT_TRUE(samples.is_open());
  EXPECT_EQ(connected, 1);
  EXPECT_EQ(lab.pipe("samples").endpoint_count(), 1U);
}

}  // namespace
}  // namespace rr::dynamic
