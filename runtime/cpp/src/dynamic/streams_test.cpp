// SPDX-License-Identifier: Apache-2.0
// Generators, pipes, wires, callbacks, memories and locks of services whose definitions only the
// service knows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "experimental/members.hpp"
#include "runtime/cpp/src/dynamic/connected.hpp"
#include "runtime/cpp/src/dynamic/testing.hpp"

namespace rr::dynamic {
namespace {

namespace members = experimental::members;
using experimental::namedarrays::Vector3;
using experimental::pods::Sample;
using testing::Awaited;
using testing::AwaitedEnd;
using testing::Connected;
using ::testing::ElementsAre;
using testing::error_text;

using testing::limit;

class Generators : public members::GeneratorsSkeleton {
 public:
  rr::Sequence<double> count(double end) override {
    for (double value = 0; value < end; ++value) co_yield value;
  }
  rr::Sequence<void, std::optional<members::Frame>> collect(std::string) override {
    while (true) {
      const auto frame = co_await rr::taken<std::optional<members::Frame>>;
      if (!frame) co_return;
      collected += frame->values.size();
    }
  }
  rr::Sequence<double, double> running_sum(double start, std::string) override {
    while (true) {
      start += co_await rr::taken<double>;
      co_yield start;
    }
  }
  rr::Sequence<std::optional<members::Frame>> all_frames() override {
    rr::throw_not_implemented("all_frames");
  }
  rr::Sequence<void, rr::Array<std::uint8_t>> accept() override {
    rr::throw_not_implemented("accept");
  }
  rr::Sequence<std::string, rr::Array<Sample>> relabel() override {
    rr::throw_not_implemented("relabel");
  }
  rr::Sequence<Vector3> trace_a_path_between_points(
      Vector3 first, rr::Array<Vector3>, std::optional<std::vector<members::Mode>>) override {
    co_yield first;
  }
  rr::Sequence<VarValue> token(VarValue value, std::int32_t) override { co_yield value; }

  std::size_t collected = 0;
};

TEST(DynamicGenerators, GiveAndTake) {
  Connected<Generators> generators;
  Generator count = generators->generate("count", {2});
  EXPECT_EQ(count.next()->as<double>(), 0);
  EXPECT_EQ(count.next()->as<double>(), 1);
  EXPECT_EQ(count.next(), std::nullopt);
  Generator collect = generators->generate("collect", {"label"});
  const Value frame = StringMap{{"values", List{1, 2, 3}}};
  EXPECT_TRUE(collect.next(frame).value().is_null());
  EXPECT_EQ(collect.next(Value()), std::nullopt);
  EXPECT_EQ(generators.skeleton->collected, 3U);
  Generator sum = generators->generate("running_sum", {10, "mm"});
  EXPECT_EQ(sum.next(1)->as<double>(), 11);
  sum.close();
  EXPECT_EQ(error_text([&] { (void)count.next(1); }), "18: member count: its steps take no value");
  EXPECT_EQ(error_text([&] { (void)sum.next("x"); }),
            "11: member running_sum: expected double, got string");
  EXPECT_EQ(error_text([&] { (void)generators->call("count", {1}); }),
            "10: member count: expected plain function, got generator function");
}

TEST(DynamicGenerators, AreUsedAsynchronously) {
  Connected<Generators> generators;
  Awaited<Generator> opened;
  generators->async_generate("running_sum", {1, ""}, opened.done());
  Generator sum = opened.get();
  Awaited<std::optional<Value>> step;
  sum.async_next(2, step.done());
  EXPECT_EQ(step.get()->as<double>(), 3);
  AwaitedEnd closed;
  sum.async_close(closed.done());
  closed.get();
  Awaited<std::optional<Value>> after;
  sum.async_next(2, after.done());
  EXPECT_EQ(after.get(), std::nullopt);
}

class Pipes : public members::PipesSkeleton {};

TEST(DynamicPipes, CarryPacketsBothWays) {
  Connected<Pipes> pipes;
  PipeEndpoint points = pipes->pipe("points").connect();
  pipes.skeleton->points().send(Vector3{.x = 1, .y = 2, .z = 3});
  EXPECT_EQ(points.receive_for(limit).value()["y"].as<double>(), 2);
  EXPECT_EQ(error_text([&] { points.send(List{1, 2, 3}); }).substr(0, 4), "102:");

  std::promise<rr::Array<Sample>> received;
  pipes.skeleton->samples().on_connect([&](rr::PipeEndpoint<rr::Array<Sample>> end) {
    end.on_packet([&](const rr::Array<Sample>& packet) { received.set_value(packet); }).detach();
  });
  Awaited<PipeEndpoint> connected;
  pipes->pipe("samples").async_connect(connected.done());
  PipeEndpoint samples = connected.get();
  samples.send(List{StringMap{{"sequence", 4}, {"stamp", 1}, {"acceleration", List{1, 2, 3}}}});
  const rr::Array<Sample> packet = received.get_future().get();
  ASSERT_EQ(packet.size(), 1U);
  EXPECT_EQ(packet[0].sequence, 4U);
  EXPECT_EQ(error_text([&] { samples.send(List{1}); }),
            "11: member samples, item [0]: expected experimental.pods.Sample, got int32");
  std::promise<void> closed;
  samples.on_closed([&] { closed.set_value(); });
  samples.close();
  EXPECT_EQ(closed.get_future().wait_for(limit), std::future_status::ready);
}

class Wires : public members::WiresSkeleton {};

TEST(DynamicWires, CarryValuesBothWays) {
  Connected<Wires> wires;
  WireConnection point = wires->wire("point").connect();
  std::promise<Value> changed;
  std::atomic<bool> is_told{false};
  const Subscription values = point.on_in([&](const Value& value, const TimeSpec&) {
    if (!is_told.exchange(true)) changed.set_value(value);
  });
  wires.skeleton->point().set_in(Vector3{.x = 1, .y = 2, .z = 3});
  ASSERT_TRUE(point.wait_in(limit));
  EXPECT_EQ(point.in()["z"].as<double>(), 3);
  EXPECT_EQ(changed.get_future().get()["x"].as<double>(), 1);
  EXPECT_EQ(wires->wire("point").peek_in().value["y"].as<double>(), 2);

  wires->wire("modes").poke_out(IntMap{{3, "busy"}});
  EXPECT_EQ(wires.skeleton->modes().out().value().value->at(3), members::Mode::busy);
  EXPECT_EQ(wires->wire("modes").peek_out().value.at_key(3).text(), "busy");
  EXPECT_EQ(error_text([&] { wires->wire("level").poke_out("x"); }),
            "11: member level: expected double, got string");
  EXPECT_EQ(error_text([&] { point.set_out(List{1}); }),
            "11: member point: expected experimental.namedarrays.Vector3, which has 3 numbers, "
            "got 1");
  point.close();
  EXPECT_FALSE(point.is_open());
}

TEST(DynamicWires, AreUsedAsynchronously) {
  Connected<Wires> wires;
  AwaitedEnd poked;
  wires->wire("level").async_poke_out(2, poked.done());
  poked.get();
  Awaited<Timed<Value>> out;
  wires->wire("level").async_peek_out(out.done());
  EXPECT_EQ(out.get().value.as<double>(), 2);
  wires.skeleton->level().set_in(5);
  Awaited<Timed<Value>> in;
  wires->wire("level").async_peek_in(in.done());
  EXPECT_EQ(in.get().value.as<double>(), 5);
  Awaited<WireConnection> connected;
  wires->wire("level").async_connect(connected.done());
  WireConnection level = connected.get();
  level.set_out(7);
  ASSERT_TRUE(level.wait_in(limit));
}

class Callbacks : public members::CallbacksSkeleton {};

TEST(DynamicCallbacks, AreCalled) {
  Connected<Callbacks> callbacks;
  const std::uint32_t client = callbacks.endpoint.get_future().get();
  callbacks->callback("add").set(
      [](const List& given) { return Value(given[0].as<int>() + given[1].as<int>()); });
  EXPECT_EQ(callbacks.skeleton->add(client, 40, 2), 42);
  callbacks->callback("measure").set([](const List& given) -> Value {
    return StringMap{{"values", List{given[1]["x"], 2}}};
  });
  EXPECT_THAT(callbacks.skeleton->measure(client, "label", Vector3{.x = 1}).value().values,
              ElementsAre(1, 2));
  int pings = 0;
  callbacks->callback("ping").set([&](const List&) {
    ++pings;
    return Value();
  });
  callbacks.skeleton->ping(client);
  EXPECT_EQ(pings, 1);
  callbacks->callback("add").set([](const List&) { return Value("x"); });
  EXPECT_EQ(error_text([&] { (void)callbacks.skeleton->add(client, 1, 2); }),
            "11: member add, result: expected int32, got string");
  callbacks->callback("add").clear();
  EXPECT_THROW((void)callbacks.skeleton->add(client, 1, 2), Error);
}

class Memories : public members::MemoriesDefault {
 public:
  Memories() {
    rr_memory_m_double =
        std::make_shared<rr::StoredArrayMemory<double>>(rr::Array<double>{1, 2, 3, 4});
    rr_memory_md_cdouble = std::make_shared<rr::StoredMultiMemory<std::complex<double>>>(
        rr::MultiArray<std::complex<double>>{{2, 2}, rr::Array<std::complex<double>>(4)});
    rr_memory_samples = std::make_shared<rr::StoredArrayMemory<Sample>>(
        rr::Array<Sample>{Sample{.sequence = 1}, Sample{.sequence = 2}});
    rr_memory_point_grid = std::make_shared<rr::StoredMultiMemory<Vector3>>(
        rr::MultiArray<Vector3>{{2, 2}, rr::Array<Vector3>(4)});
  }
};

TEST(DynamicMemories, AreReadAndWritten) {
  Connected<Memories> memories;
  const Memory numbers = memories->memory("m_double");
  EXPECT_EQ(numbers.length(), 4U);
  EXPECT_THAT(numbers.dims(), ElementsAre(4));
  numbers.write({1}, List{7, 8});
  EXPECT_THAT(numbers.read({0}, {4}).array<double>(), ElementsAre(1, 7, 8, 4));
  EXPECT_EQ(memories->memory("samples").read({1}, {1}).at(0)["sequence"].as<int>(), 2);
  const Memory grid = memories->memory("point_grid");
  EXPECT_THAT(grid.dims(), ElementsAre(2, 2));
  EXPECT_EQ(grid.dim_count(), 2U);
  grid.write({1, 1}, List{List{StringMap{{"x", 9}, {"y", 8}, {"z", 7}}}});
  const Value corner = grid.read({1, 1}, {1, 1});
  EXPECT_THAT(corner.dims(), ElementsAre(1, 1));
  EXPECT_EQ(corner.at(0)["x"].as<double>(), 9);
  EXPECT_EQ(error_text([&] { numbers.write({0}, List{"x"}); }),
            "11: member m_double, item [0]: expected double, got string");
  EXPECT_EQ(error_text([&] { (void)memories->memory("points").read({0}, {0}); }).substr(0, 4),
            "103:");
}

TEST(DynamicMemories, AreUsedAsynchronously) {
  Connected<Memories> memories;
  const Memory matrix = memories->memory("md_cdouble");
  AwaitedEnd written;
  matrix.async_write({0, 1}, List{List{List{1, 2}}, List{List{3, 4}}}, written.done());
  written.get();
  Awaited<Value> read;
  matrix.async_read({0, 0}, {2, 2}, read.done());
  EXPECT_EQ(read.get().to_json(), "[[[0,0],[1,2]],[[0,0],[3,4]]]");
}

TEST(DynamicClient, EntersNoMonitorThatIsNotThere) {
  Connected<Memories> memories;
  EXPECT_EQ(error_text([&] { enter_monitor(memories->stub()); }).substr(0, 3), "18:");
}

}  // namespace
}  // namespace rr::dynamic
