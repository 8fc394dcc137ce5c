// SPDX-License-Identifier: Apache-2.0
// arm_client URL VERSION: uses every member of the arm of the tests of C#, in message format 2
// or 4. Prints what was otherwise than it should be; exit code 0 means nothing was.
#include <chrono>
#include <cstdio>
#include <exception>
#include <future>
#include <numeric>
#include <string>
#include <thread>

#include "experimental/arm.hpp"
#include "rr/node.hpp"

namespace {

namespace a = experimental::arm;
using namespace std::chrono_literals;

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  ++failures;
  std::printf("does not hold: %s\n", what);
}
#define EXPECT(condition) expect((condition), #condition)

template <class Condition>
bool eventually(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

void values(a::ArmStub& arm) {
  arm.set_speed(2.5);
  EXPECT(arm.get_speed() == 2.5);
  arm.set_note("mine");
  EXPECT(arm.get_note() == "mine");
  EXPECT(arm.add(3, 4) == 7);
  EXPECT(arm.get_calls() == 1);
  rr::Array<double> many(100'000);
  std::iota(many.mutate().begin(), many.mutate().end(), 0.0);
  EXPECT(arm.numbers(many) == many);
  EXPECT(arm.echo("text").get<std::string>() == "text");
  EXPECT(arm.echo({}).is_null());
  EXPECT(arm.echo(a::Pose{1, "p"}).get<a::Pose>() == (a::Pose{1, "p"}));
}

void errors(a::ArmStub& arm) {
  try {
    arm.fail("rusty");
    EXPECT(false && "it has not failed");
  } catch (const a::Stuck& stuck) {
    EXPECT(stuck.message() == "rusty");
    EXPECT(stuck.subname() == "by.test");
    EXPECT(stuck.parameter().get<rr::Array<double>>()[0] == 5.5);
  }
  try {
    arm.get_joints(4);
    EXPECT(false && "there is a joint 4");
  } catch (const rr::Error& error) {
    EXPECT(error.code() == rr::ErrorCode::invalid_argument);
  }
}

void objects_and_events(a::ArmStub& arm) {
  std::promise<std::pair<double, std::string>> came;
  const rr::Subscription moved = arm.moved().connect([&](double x, const std::string& label) {
    came.set_value({x, label});
  });
  EXPECT(arm.move(a::Pose{4, "home"}) == (a::Pose{5, "home"}));
  auto event = came.get_future();
  EXPECT(event.wait_for(20s) == std::future_status::ready);
  EXPECT(event.get() == (std::pair<double, std::string>{4, "home"}));
  const auto joint = arm.get_joints(3);
  joint->set_angle(0.25);
  EXPECT(std::dynamic_pointer_cast<a::JointStub>(arm.get_anything())->get_angle() == 0.25);
}

void streams(a::ArmStub& arm) {
  rr::PipeEndpoint<double> end = arm.samples().connect();
  for (int i = 1; i <= 3; ++i) end.send(i);
  for (int i = 1; i <= 3; ++i) EXPECT(end.receive_for(20s) == 2.0 * i);
  arm.broadcast(100);
  EXPECT(end.receive_for(20s) == 100.0);
  end.close();
  rr::WireConnection<a::Vector3> wire = arm.force().connect();
  wire.set_out({1, 2, 3});
  EXPECT(wire.wait_in(20s));
  EXPECT(wire.in() == (a::Vector3{2, 2, 3}));
  EXPECT(arm.force().peek_in().value == (a::Vector3{2, 2, 3}));
  arm.force().poke_out({9, 0, 0});
  EXPECT(arm.force().peek_out().value == (a::Vector3{9, 0, 0}));
  wire.close();
}

void callbacks(a::ArmStub& arm) {
  arm.ask().set([](std::int32_t question) { return question * 10; });
  EXPECT(arm.ask_back(7) == 71);
  arm.ask().set([](std::int32_t) -> std::int32_t { throw a::Stuck("no answer"); });
  try {
    arm.ask_back(7);
    EXPECT(false && "it has not failed");
  } catch (const a::Stuck& stuck) {
    EXPECT(stuck.message() == "no answer");
  }
  arm.ask().clear();
}

void memories(a::ArmStub& arm) {
  EXPECT(arm.buffer().length() == 1000);
  arm.buffer().write(10, rr::Array<double>{1, 2, 3});
  EXPECT((arm.buffer().read(9, 5) == rr::Array<double>{0, 1, 2, 3, 0}));
  EXPECT((arm.grid().dims() == std::vector<std::uint64_t>{20, 30}));
  const std::vector<std::uint64_t> at{2, 3}, shape{2, 2}, behind{3, 3}, row{1, 2};
  const std::vector<double> items{1, 2, 3, 4};
  arm.grid().write(at, shape, items);
  EXPECT((arm.grid().read(behind, row).items == rr::Array<double>{2, 4}));
  arm.records().write(4, rr::Array<a::Sample>{a::Sample{7, {1, 2, 3}}});
  EXPECT((arm.records().read(3, 2)[1] == a::Sample{7, {1, 2, 3}}));
}

void generators(a::ArmStub& arm) {
  std::vector<std::int32_t> counted;
  for (const std::int32_t value : arm.count(4)) counted.push_back(value);
  EXPECT((counted == std::vector<std::int32_t>{0, 1, 2, 3}));
  auto sink = arm.collect();
  EXPECT(sink.next(5));
  EXPECT(sink.next(6));
  sink.close();
  EXPECT(eventually([&] { return arm.get_collected() == rr::Array<std::int32_t>{5, 6}; }));
  auto twice = arm.twice();
  EXPECT(twice.next(21) == 42);
  EXPECT(twice.next(4) == 8);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fputs("usage: arm_client URL VERSION\n", stderr);
    return 2;
  }
  rr::NodeOptions options;
  options.client_offer.message_v4 = std::string(argv[2]) == "4";
  rr::Node node(options);
  const auto arm = node.connect<a::ArmStub>(argv[1]);
  values(*arm);
  errors(*arm);
  objects_and_events(*arm);
  streams(*arm);
  callbacks(*arm);
  memories(*arm);
  generators(*arm);
  return failures == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::printf("ended by %s\n", error.what());
  return 1;
}
