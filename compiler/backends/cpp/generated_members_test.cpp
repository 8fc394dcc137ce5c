// SPDX-License-Identifier: Apache-2.0
// Generated classes of both sides, used over a connection: what only the two together can show.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/use_future.hpp>
#include <chrono>
#include <future>
#include <rr/async.hpp>
#include <rr/node.hpp>
#include <string>
#include <vector>

#include "experimental/members.hpp"

namespace {

using boost::asio::use_future;
using experimental::members::Frame;
using experimental::members::Mode;
using experimental::namedarrays::Vector3;
using experimental::pods::Sample;
using testing::ElementsAre;
namespace members = experimental::members;

constexpr std::chrono::seconds limit{10};

class Generators : public members::GeneratorsSkeleton {
 public:
  rr::Sequence<double> count(double end) override {
    for (double value = 0; value < end; ++value) co_yield value;
  }
  rr::Sequence<std::optional<Frame>> all_frames() override {
    const Frame frame{.values = {1, 2}};
    co_yield frame;
    co_yield std::nullopt;
  }
  rr::Sequence<void, std::optional<Frame>> collect(std::string label) override {
    while (true) {
      const auto frame = co_await rr::taken<std::optional<Frame>>;
      if (!frame) co_return;
      collected += label + std::to_string(frame->values.size());
    }
  }
  rr::Sequence<void, rr::Array<std::uint8_t>> accept() override {
    rr::throw_not_implemented("accept");
  }
  rr::Sequence<double, double> running_sum(double start, std::string unit) override {
    double sum = start + static_cast<double>(unit.size());
    while (true) {
      sum += co_await rr::taken<double>;
      co_yield sum;
    }
  }
  rr::Sequence<std::string, rr::Array<Sample>> relabel() override {
    while (true) {
      const auto samples = co_await rr::taken<rr::Array<Sample>>;
      co_yield std::to_string(samples.size());
    }
  }
  rr::Sequence<Vector3> trace_a_path_between_points(
      Vector3 first, rr::Array<Vector3> others, std::optional<std::vector<Mode>> modes) override {
    co_yield first;
    for (const Vector3& other : others) co_yield other;
    if (modes) co_yield Vector3{.x = static_cast<double>(modes->size())};
  }
  rr::Sequence<rr::VarValue> token(rr::VarValue value, std::int32_t count) override {
    for (std::int32_t i = 0; i < count; ++i) co_yield value;
  }

  std::string collected;
};

class Station : public members::StationDefault {
 public:
  Station() {
    rr_memory_buffer =
        std::make_shared<rr::StoredArrayMemory<double>>(rr::Array<double>{1, 2, 3, 4});
    rr_memory_point_grid = std::make_shared<rr::StoredMultiMemory<Vector3>>(
        rr::MultiArray<Vector3>{{2, 2}, rr::Array<Vector3>(4)});
  }
  std::shared_ptr<members::GeneratorsSkeleton> get_generators() override { return generators; }
  rr::Sequence<double> count(double end) override { return generators->count(end); }

  std::shared_ptr<Generators> generators = std::make_shared<Generators>();
};

/// A service and a client of it, each on a node of its own.
template <class StubType, class SkeletonType>
class Connected {
 public:
  Connected() {
    server_.register_service("tested", skeleton,
                             {.on_client_connected = [this](const rr::ServiceClient& one) {
                               endpoint.set_value(one.endpoint);
                             }});
    const auto port = server_.listen_tcp(0, "127.0.0.1");
    client_ =
        node_.connect<StubType>("rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=tested");
  }
  StubType* operator->() const { return client_.stub().get(); }

  std::shared_ptr<SkeletonType> skeleton = std::make_shared<SkeletonType>();
  std::promise<std::uint32_t> endpoint;  ///< of the client

 private:
  rr::Node server_;
  rr::Node node_;
  rr::Client<StubType> client_;
};

class GeneratedMembers : public testing::Test {
 protected:
  Connected<members::StationStub, Station> station_;
};

TEST_F(GeneratedMembers, GeneratorsGiveAndTake) {
  const auto generators = station_->get_generators();
  EXPECT_THAT(generators->count(3).all(), ElementsAre(0, 1, 2));
  EXPECT_THAT(generators->all_frames().all(), ElementsAre(Frame{.values = {1, 2}}, std::nullopt));
  auto collect = generators->collect("n");
  EXPECT_TRUE(collect.next(Frame{.values = {1, 2, 3}}));
  EXPECT_TRUE(collect.next(Frame{}));
  EXPECT_FALSE(collect.next(std::nullopt));
  EXPECT_EQ(station_.skeleton->generators->collected, "n3n0");
  auto sum = generators->running_sum(10, "mm");
  EXPECT_EQ(sum.next(1), 13);
  EXPECT_EQ(sum.next(2), 15);
  sum.close();
  EXPECT_THAT(generators
                  ->trace_a_path_between_points({.x = 1}, {Vector3{.x = 2}},
                                                std::vector{Mode::idle, Mode::busy, Mode::idle})
                  .all(),
              ElementsAre(Vector3{.x = 1}, Vector3{.x = 2}, Vector3{.x = 3}));
  const auto tokens = generators->token(rr::VarValue(1.5), 2).all();
  ASSERT_EQ(tokens.size(), 2U);
  for (const rr::VarValue& token : tokens) EXPECT_EQ(token.number<double>(), 1.5);
  EXPECT_THROW((void)generators->accept(), rr::Error);
}

TEST_F(GeneratedMembers, GeneratorsAreCalledAsynchronously) {
  auto count = station_->async_count(2, use_future).get();
  EXPECT_EQ(count.async_next(use_future).get(), 0);
  EXPECT_EQ(count.next(), 1);
  EXPECT_EQ(count.next(), std::nullopt);
}

TEST_F(GeneratedMembers, PipesOfImplementedObjectsAreConnected) {
  std::promise<rr::PipeEndpoint<std::optional<Frame>>> connected;
  station_.skeleton->frames().on_connect([&](auto end) { connected.set_value(std::move(end)); });
  auto frames = station_->frames().connect();
  ASSERT_EQ(connected.get_future().wait_for(limit), std::future_status::ready);
  EXPECT_EQ(station_.skeleton->frames().endpoint_count(), 1U);
  station_.skeleton->frames().send(Frame{.values = {4, 5}});
  EXPECT_EQ(frames.receive_for(limit), std::optional(std::optional(Frame{.values = {4, 5}})));
  EXPECT_THROW(frames.send(Frame{}), rr::Error);  // readonly
}

TEST_F(GeneratedMembers, WiresOfImplementedObjectsAreConnected) {
  auto force = station_->force().connect();
  station_.skeleton->force().set_in({1, 2, 3});
  ASSERT_TRUE(force.wait_in(limit));
  EXPECT_THAT(force.in(), ElementsAre(1, 2, 3));
  EXPECT_THAT(station_->force().peek_in().value, ElementsAre(1, 2, 3));
}

TEST_F(GeneratedMembers, WiresTakeValues) {
  std::promise<Mode> received;
  station_.skeleton->mode().on_out(
      [&](Mode mode, const rr::TimeSpec&, std::uint32_t) { received.set_value(mode); });
  auto mode = station_->mode().connect();
  mode.set_out(Mode::busy);
  auto future = received.get_future();
  ASSERT_EQ(future.wait_for(limit), std::future_status::ready);
  EXPECT_EQ(future.get(), Mode::busy);
}

TEST_F(GeneratedMembers, CallbacksOfImplementedObjectsAreCalled) {
  station_->ask().set([](std::int32_t question) { return question + 1; });
  const std::uint32_t client = station_.endpoint.get_future().get();
  EXPECT_EQ(station_.skeleton->ask(client, 41), 42);
  EXPECT_EQ(station_.skeleton->async_ask(client, 1, use_future).get(), 2);
  station_->ask().clear();
  EXPECT_THROW((void)station_.skeleton->ask(client, 0), rr::Error);
}

TEST_F(GeneratedMembers, MemoriesAreReadAndWritten) {
  EXPECT_EQ(station_->buffer().length(), 4U);
  station_->buffer().write(1, std::vector<double>{7, 8});
  EXPECT_THAT(station_->buffer().read(0, 4), ElementsAre(1, 7, 8, 4));
  EXPECT_EQ(station_->m_double().length(), 0U);
  EXPECT_THAT(station_->point_grid().dims(), ElementsAre(2, 2));
  const std::vector<std::uint64_t> corner{1, 1};
  const rr::MultiArray<Vector3> one{{1, 1}, {Vector3{.x = 9}}};
  station_->point_grid().write(corner, one);
  EXPECT_EQ(station_->point_grid().read(corner, std::vector<std::uint64_t>{1, 1}), one);
  EXPECT_THROW((void)station_->points().read(0, 0), rr::Error);  // writeonly
}

class Pipes : public members::PipesSkeleton {};

TEST(GeneratedPipes, CarryArraysWhoseTypeDoesNotTellTheirLength) {
  Connected<members::PipesStub, Pipes> pipes;
  auto long_ones = pipes->long_ones().connect();
  rr::Array<double> sent(100000);
  sent.mutate()[99999] = 3;
  pipes.skeleton->long_ones().send(sent);
  EXPECT_EQ(long_ones.receive_for(limit), sent);
  EXPECT_THROW(pipes.skeleton->long_ones().endpoints().at(0).send(rr::Array<double>(1)), rr::Error);
  std::promise<rr::Array<double>> received;
  const auto subscription = pipes.skeleton->long_ones().endpoints().at(0).on_packet(
      [&](rr::Array<double> packet) { received.set_value(std::move(packet)); });
  long_ones.send(sent);
  auto future = received.get_future();
  ASSERT_EQ(future.wait_for(limit), std::future_status::ready);
  EXPECT_EQ(future.get(), sent);
}

}  // namespace
