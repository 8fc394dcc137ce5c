// SPDX-License-Identifier: Apache-2.0
// Properties, functions, events, objects and attributes of services whose definitions only the
// service knows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experimental/events.hpp"
#include "experimental/functions.hpp"
#include "experimental/objrefs.hpp"
#include "experimental/pods.hpp"
#include "experimental/properties.hpp"
#include "rr/stub_beside.hpp"
#include "runtime/cpp/src/dynamic/connected.hpp"
#include "runtime/cpp/src/dynamic/testing.hpp"

namespace rr::dynamic {
namespace {

using testing::Awaited;
using testing::AwaitedEnd;
using testing::Connected;
using ::testing::ElementsAre;
using testing::error_text;
using ::testing::HasSubstr;

namespace functions = experimental::functions;

class Machine : public functions::MachineSkeleton {
 public:
  void stop() override { is_stopped = true; }
  double speed() override { return 1; }
  void move_to(double pan, double tilt) override { at = {pan, tilt}; }
  std::string join(const std::string& first, const std::string& second,
                   const std::optional<std::vector<std::string>>& others) override {
    std::string all = first + second;
    for (const std::string& other : others.value_or(std::vector<std::string>())) all += other;
    return all;
  }
  std::optional<functions::Report> inspect(const std::optional<functions::Report>& previous,
                                           const rr::Array<std::uint8_t>& picture) override {
    if (!previous) {
      throw Error(ErrorCode::null_value, "test.NoReport", "no report", "",
                  VarStringMap{{"missing", "previous"}});
    }
    functions::Report report = *previous;
    report.count += static_cast<std::int32_t>(picture.size());
    return report;
  }
  rr::Array<double> filter(const rr::Array<double>& samples, const std::array<double, 3>&,
                           bool) override {
    return samples;
  }
  std::optional<std::map<std::string, VarValue>> a_function_whose_name_is_rather_long(
      const VarValue& first, const std::optional<std::vector<VarValue>>&) override {
    return std::map<std::string, VarValue>{{"first", first}};
  }

  bool is_stopped = false;
  std::pair<double, double> at;
};

TEST(DynamicClient, ReadsAndWritesPropertiesOfAllTypes) {
  Connected<experimental::properties::BoardDefault> board;
  const std::vector<std::pair<std::string, std::string>> values = {
      {"gain", "2.5"},
      {"enabled", "true"},
      {"label", "\"x\""},
      {"response", "[1,-2]"},
      {"mode", "\"running\""},
      {"samples", "[1,2,3]"},
      {"address", "[127,0,0,1]"},
      {"steps", "[-1,2]"},
      {"image", "[[1,2],[3,4]]"},
      {"rotation", "[[1,2,3],[4,5,6],[7,8,9]]"},
      {"names", R"(["a","b"])"},
      {"by_number", R"({"-1":0.5})"},
      {"by_name", R"({"k":[1]})"},
      {"anything", R"({"type":"double[]","value":[1]})"},
      {"settings", R"({"a":"b"})"},
  };
  for (const auto& [name, json] : values) {
    const ValueType type = board->member(name).type;
    board->set(name, type.from_json(json, name));
    EXPECT_EQ(type.to_json(board->get(name)), json) << name;
  }
  EXPECT_EQ(board.skeleton->get_mode(), experimental::properties::Mode::running);
  EXPECT_EQ(board.skeleton->get_gain(), 2.5);
}

TEST(DynamicClient, NamesMemberAndTypeInErrors) {
  Connected<experimental::properties::BoardDefault> board;
  EXPECT_EQ(error_text([&] { board->set("gain", "x"); }),
            "11: member gain: expected double, got string");
  EXPECT_EQ(error_text([&] {
              board->set("address", List{1, 2});
            }),
            "11: member address: expected uint8[4], got 2 items");
  EXPECT_EQ(error_text([&] { (void)board->get("gian"); }),
            "9: `experimental.properties.Board` has no property `gian`; did you mean `gain`?");
  EXPECT_EQ(error_text([&] { (void)board->member("gian"); }),
            "9: `experimental.properties.Board` has no member `gian`; did you mean `gain`?");
  EXPECT_EQ(error_text([&] { (void)board->call("gain"); }),
            "10: member gain: expected function, got property");
  EXPECT_EQ(error_text([&] { (void)board->get("password"); }).substr(0, 4), "103:");
  EXPECT_EQ(error_text([&] { board->set("serial_number", 1); }).substr(0, 4), "102:");
}

TEST(DynamicClient, CallsFunctions) {
  Connected<Machine> machine;
  EXPECT_TRUE(machine->call("stop").is_null());
  EXPECT_TRUE(machine.skeleton->is_stopped);
  machine->call("move_to", {1, 2.5});
  EXPECT_EQ(machine.skeleton->at, std::pair(1.0, 2.5));
  EXPECT_EQ(machine->call("join", {"a", "b", List{"c", "d"}}).text(), "abcd");
  EXPECT_EQ(machine->call("join", {"a", "b", Value()}).text(), "ab");
  const Value report =
      machine->call("inspect", {StringMap{{"count", 1}, {"text", "t"}}, List{1, 2}});
  EXPECT_EQ(report["count"].as<int>(), 3);
  EXPECT_EQ(report.type_text(), "experimental.functions.Report");
  const Value any = machine->call("a_function_whose_name_is_rather_long", {report, List{1}});
  EXPECT_EQ(any.at("first"), report);
}

TEST(DynamicClient, HasAStubOfGeneratedCodeBesideIt) {
  const Connected<Machine> machine;
  const auto stub = stub_beside<functions::MachineStub>(machine->stub());
  stub->move_to(1, 2);
  EXPECT_EQ(machine.skeleton->at, std::pair(1.0, 2.0));
  EXPECT_EQ(stub->rr_path(), machine->path());
  EXPECT_EQ(machine->call("speed").as<double>(), 1);
}

TEST(DynamicClient, NamesFunctionAndParameterInErrors) {
  Connected<Machine> machine;
  EXPECT_EQ(error_text([&] { machine->call("move_to", {1}); }),
            "18: member move_to: expected 2 arguments (double pan, double tilt), got 1");
  EXPECT_EQ(error_text([&] { machine->call("stop", {1}); }),
            "18: member stop: expected 0 arguments, got 1");
  EXPECT_EQ(error_text([&] {
              machine->call("move_to", {1, "x"});
            }),
            "11: member move_to, parameter tilt: expected double, got string");
  EXPECT_EQ(error_text([&] {
              machine->call("inspect", {StringMap{{"count", "x"}, {"text", ""}}, List{}});
            }),
            "11: member inspect, parameter previous, field count: expected int32, got string");
  EXPECT_EQ(error_text([&] { (void)machine->generate("stop"); }),
            "10: member stop: expected generator function, got plain function");
  EXPECT_EQ(error_text([&] { machine->call("inspect", {Value(), List{}}); }), "20: no report");
}

TEST(DynamicClient, ReadsTheParametersOfErrors) {
  Connected<Machine> machine;
  try {
    machine->call("inspect", {Value(), List{}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(machine.client.value(error.parameter())["missing"].text(), "previous");
  }
}

TEST(DynamicClient, CallsAsynchronously) {
  Connected<Machine> machine;
  Awaited<Value> joined;
  machine->async_call("join", {"a", "b", Value()}, joined.done());
  EXPECT_EQ(joined.get().text(), "ab");
  Awaited<Value> failed;
  machine->async_call("inspect", {Value(), List{}}, failed.done());
  EXPECT_EQ(error_text([&] { (void)failed.get(); }), "20: no report");

  Connected<experimental::properties::BoardDefault> board;
  AwaitedEnd set;
  board->async_set("gain", 3, set.done());
  set.get();
  Awaited<Value> got;
  board->async_get("gain", got.done());
  EXPECT_EQ(got.get().as<double>(), 3);
  Awaited<Client> connected;
  async_connect(board.node, board.url, {}, connected.done());
  EXPECT_EQ(connected.get()->get("gain").as<double>(), 3);
}

TEST(DynamicClient, TellsItsMembers) {
  Connected<Machine> machine;
  EXPECT_EQ(machine->type_name(), "experimental.functions.Machine");
  EXPECT_EQ(machine->path(), "tested");
  const auto members = machine->members();
  ASSERT_EQ(members.size(), 7U);
  EXPECT_EQ(members[2].declaration, "function void move_to(double pan, double tilt)");
  EXPECT_EQ(members[2].parameters[1].type.text(), "double");
  EXPECT_EQ(members[5].access, urgent);
  EXPECT_EQ(members[6].type.text(), "varvalue{string}");
  EXPECT_THAT(machine.client.types().services(), ElementsAre("experimental.functions"));
}

class Siren : public experimental::events::SirenSkeleton {
 public:
  void test() override {
    tick();
    raised(3, experimental::events::Alarm{.text = "fire"}, {1, 2}, std::nullopt);
  }
};

class Joint : public experimental::objrefs::JointDefault {};
class Robot : public experimental::objrefs::RobotSkeleton {
 public:
  std::shared_ptr<experimental::objrefs::JointSkeleton> get_base() override { return joint; }
  std::shared_ptr<experimental::objrefs::JointSkeleton> get_joint(std::int32_t) override {
    return joint;
  }
  std::shared_ptr<experimental::objrefs::JointSkeleton> get_joint_by_number(std::int32_t) override {
    return joint;
  }
  std::shared_ptr<experimental::objrefs::JointSkeleton> get_joint_by_name(
      const std::string& name) override {
    if (name != "elbow") throw Error(ErrorCode::invalid_argument, "no such joint");
    return joint;
  }
  std::shared_ptr<rr::Skeleton> get_tool() override { return joint; }
  std::shared_ptr<rr::Skeleton> get_tools(const std::string&) override {
    return std::make_shared<Siren>();
  }
  std::shared_ptr<Joint> joint = std::make_shared<Joint>();
};

TEST(DynamicClient, FindsObjects) {
  Connected<Robot> robot;
  const Object base = robot->object("base");
  EXPECT_EQ(base.type_name(), "experimental.objrefs.Joint");
  base.set("angle", 0.5);
  EXPECT_EQ(robot.skeleton->joint->get_angle(), 0.5);
  EXPECT_EQ(robot->object("joint", 3).path(), "tested.joint[3]");
  EXPECT_EQ(robot->object("joint_by_name", "elbow").get("angle").as<double>(), 0.5);
  EXPECT_EQ(robot->object("tool").type_name(), "experimental.objrefs.Joint");
  EXPECT_EQ(error_text([&] { (void)robot->object("joint"); }),
            "18: member joint: expected an index of type int32, got none");
  EXPECT_EQ(error_text([&] { (void)robot->object("joint_by_name", 1); }),
            "18: member joint_by_name: expected an index of type string, got int32");
  EXPECT_EQ(error_text([&] { (void)robot->object("base", "x"); }),
            "18: member base: expected no index, got string");
  Awaited<Object> found;
  robot->async_object("joint", 4, found.done());
  EXPECT_EQ(found.get().path(), "tested.joint[4]");
}

TEST(DynamicClient, ReadsDefinitionsThatComeLater) {
  Connected<Robot> robot;
  robot.server.add_definition(experimental::events::rr_definition);
  EXPECT_THAT(robot.client.types().services(), ElementsAre("experimental.objrefs"));
  const Object siren = robot->object("tools", "siren");
  EXPECT_EQ(siren.type_name(), "experimental.events.Siren");
  EXPECT_THAT(robot.client.types().services(),
              ElementsAre("experimental.events", "experimental.objrefs"));
  std::promise<List> raised;
  const Subscription subscription =
      siren.on_event("raised", [&](const List& arguments) { raised.set_value(arguments); });
  siren.call("test");
  EXPECT_EQ(raised.get_future().get().at(1)["text"].text(), "fire");
  // What was found before goes on.
  EXPECT_EQ(robot->object("base").type_name(), "experimental.objrefs.Joint");
}

TEST(DynamicClient, HearsEvents) {
  Connected<Siren> siren;
  std::promise<List> raised;
  std::promise<std::size_t> tick;
  const Subscription first =
      siren->on_event("raised", [&](const List& arguments) { raised.set_value(arguments); });
  const Subscription second =
      siren->on_event("tick", [&](const List& arguments) { tick.set_value(arguments.size()); });
  siren->call("test");
  EXPECT_EQ(tick.get_future().get(), 0U);
  const List arguments = raised.get_future().get();
  ASSERT_EQ(arguments.size(), 4U);
  EXPECT_EQ(arguments[0].as<int>(), 3);
  EXPECT_EQ(arguments[1]["text"].text(), "fire");
  EXPECT_THAT(arguments[2].array<double>(), ElementsAre(1, 2));
  EXPECT_TRUE(arguments[3].is_null());
}

class Recorder : public experimental::pods::RecorderDefault {
 public:
  experimental::pods::Burst record(const experimental::pods::Sample& from,
                                   const rr::Array<experimental::pods::Sample>& until) override {
    experimental::pods::Burst burst{};
    burst.first = from;
    for (const auto& sample : until) burst.rest.push_back(sample);
    return burst;
  }
};

TEST(DynamicClient, PassesPodsAsGeneratedClassesHaveThem) {
  Connected<Recorder> recorder;
  const Value sample = StringMap{{"sequence", 7}, {"stamp", 0.5}, {"acceleration", List{1, 2, 3}}};
  const Value burst = recorder->call("record", {sample, List{sample, sample}});
  EXPECT_EQ(burst["first"]["sequence"].as<int>(), 7);
  EXPECT_EQ(burst["rest"].size(), 2U);
  EXPECT_EQ(burst["rest"].at(1)["acceleration"].at(2).as<int>(), 3);
  EXPECT_THAT(burst["grid"].dims(), ElementsAre(2, 3));
  const Value bursts = List{burst, burst};
  recorder->set("bursts", bursts);
  EXPECT_EQ(recorder->get("bursts").items(), bursts.items());
}

TEST(DynamicClient, GetsAttributes) {
  const Value sent = StringMap{{"a", 1}};
  Connected<Siren> siren(
      {.attributes = {{"place", "roof"}, {"more", to_varvalue(sent)}, {"n", rr::Array<int>{1}}}});
  EXPECT_EQ(siren.client.attributes().at("place").text(), "roof");
  EXPECT_EQ(siren.client.attributes().at("more").at("a").as<int>(), 1);
  EXPECT_EQ(siren.client.fetch_attributes().at("n").as<int>(), 1);
}

TEST(DynamicClient, FetchesAttributesOfNamedTypes) {
  Connected<Siren> siren(
      {.attributes = {{"alarm", std::optional(experimental::events::Alarm{.text = "smoke"})}}});
  EXPECT_EQ(siren.client.fetch_attributes().at("alarm")["text"].text(), "smoke");
}

TEST(DynamicClient, FailsOnceItsSessionHasEnded) {
  Connected<Machine> machine;
  const Object root = machine.client.root();
  machine.client.close();
  EXPECT_FALSE(machine.client.is_open());
  EXPECT_EQ(error_text([&] { root.call("stop"); }).substr(0, 3), "17:");
  EXPECT_EQ(root.members().size(), 7U);
}

TEST(DynamicClient, RefusesWhatItCannotConnectTo) {
  Connected<Machine> machine;
  EXPECT_EQ(error_text([&] {
              (void)connect(machine.node, machine.url, {.object_type = "experimental.x.Y"});
            }).substr(0, 23),
            "8: Invalid object type:");
}

}  // namespace
}  // namespace rr::dynamic
