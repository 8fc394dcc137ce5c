// SPDX-License-Identifier: Apache-2.0
// A client that was compiled with another definition than its service has.
#include "runtime/cpp/src/client/definition_differences.hpp"

#include <gtest/gtest.h>

#include <boost/asio/use_future.hpp>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/node.hpp"
#include "rr/registry.hpp"
#include "runtime/cpp/src/client/definition_shape.hpp"
#include "runtime/cpp/src/node/testing/async_counter.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/kept_log.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_service.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

using boost::asio::use_future;
using Answer = RawService::Answer;
using ServiceRequest = RawService::Request;

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the definition has no " + std::string(from));
  return text.replace(at, from.size(), to);
}

std::string counter_with(std::string_view from, std::string_view to) {
  return replaced(std::string(rr_definition.text), from, to);
}

// A counter of another version, as far as a client looks at it.
struct OtherCounter {
  explicit OtherCounter(std::string definition)
      : service(std::move(definition), "test.counter.Counter",
                [this](const ServiceRequest& request) {
                  if (request.type != EntryType::property_get_req) return false;
                  Answer answer = RawService::answer_to(request);
                  answer.elements = RawService::value("value", 1.5);
                  return service.send(answer);
                }) {}
  RawService service;
};

TEST(DefinitionDifferences, OfATypeAreLoggedOnceAndFailTheMemberThatIsUsed) {
  OtherCounter other(counter_with("property double value", "property int32 value"));
  KeptLog log;
  Node node(log.options());
  auto counter = node.connect<CounterStub>(other.service.url());
  const auto lines = log.with("test.counter.Counter.value");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0],
            "service `raw`: `test.counter.Counter.value` is `property double` here and "
            "`property int32` at the service");
  for (int i = 0; i < 3; ++i) {
    const Error error = error_of([&] { counter->get_value(); });
    EXPECT_EQ(error.code(), ErrorCode::data_type_mismatch);
    EXPECT_EQ(error.message(),
              "`test.counter.Counter.value` is `property double` here and `property int32` at "
              "the service");
  }
  EXPECT_EQ(code_of([&] { counter->set_value(1); }), ErrorCode::data_type_mismatch);
  EXPECT_EQ(counter->get_fixed(), 1.5) << "others can be used";
  EXPECT_EQ(log.with("test.counter.Counter.value").size(), 1U);
  EXPECT_EQ(log.all().size(), 1U);
}

TEST(DefinitionDifferences, FailAsynchronousCallsByTheirCompletion) {
  OtherCounter other(counter_with("property double value", "property int32 value"));
  Node node;
  auto counter = node.connect<CounterStub>(other.service.url());
  auto value = counter->async_get_value(use_future);
  EXPECT_EQ(code_of([&] { value.get(); }), ErrorCode::data_type_mismatch);
}

TEST(DefinitionDifferences, AreOneMoreArgument) {
  OtherCounter other(counter_with("function double add(double a, double b)",
                                  "function double add(double a, double b, double c)"));
  Node node;
  auto counter = node.connect<CounterStub>(other.service.url());
  const Error error = error_of([&] { counter->add(1, 2); });
  EXPECT_EQ(error.code(), ErrorCode::data_type_mismatch);
  EXPECT_EQ(error.message(),
            "`test.counter.Counter.add` is `function double(double a,double b)` here and "
            "`function double(double a,double b,double c)` at the service");
}

TEST(DefinitionDifferences, OfAnEventAreToldToWhoWantsToHearIt) {
  OtherCounter other(
      counter_with("event ticked(int32 count, string text)", "event ticked(int32 count)"));
  Node node;
  auto counter = node.connect<CounterStub>(other.service.url());
  EXPECT_EQ(code_of([&] {
              auto handler = counter->ticked().connect([](std::int32_t, const std::string&) {});
            }),
            ErrorCode::data_type_mismatch);
}

TEST(DefinitionDifferences, OfAWireAreToldToWhoConnectsOrPeeks) {
  const std::string text =
      "service test.wired\nstdver 0.10\nobject Wired\n  wire int32 level\n  wire string note\n"
      "  wire double[] trace\n  wire double reading [readonly]\n"
      "  wire double target [writeonly]\n  function void set_level(double value)\n"
      "  function void close_level()\n  objref Wired{string} child\nend\n";
  RawService service(text, "test.wired.Wired");
  Node node;
  auto wired = node.connect<WiredStub>(service.url());
  EXPECT_EQ(code_of([&] { wired->level().connect(); }), ErrorCode::data_type_mismatch);
  EXPECT_EQ(code_of([&] { wired->level().peek_in(); }), ErrorCode::data_type_mismatch);
  EXPECT_EQ(code_of([&] { wired->level().poke_out(1); }), ErrorCode::data_type_mismatch);
  EXPECT_EQ(code_of([&] { wired->note().connect(); }), ErrorCode::none);
}

TEST(DefinitionDifferences, OfAStructAreThoseOfTheMembersThatUseIt) {
  OtherCounter other(counter_with("field string label", "field string[] label"));
  KeptLog log;
  Node node(log.options());
  auto counter = node.connect<CounterStub>(other.service.url());
  const Error error = error_of([&] { counter->read("a"); });
  EXPECT_EQ(error.code(), ErrorCode::data_type_mismatch);
  EXPECT_NE(error.message().find("string label;"), std::string::npos) << error.message();
  EXPECT_NE(error.message().find("string[] label;"), std::string::npos) << error.message();
  EXPECT_EQ(counter->get_value(), 1.5);
  EXPECT_EQ(log.all().size(), 1U);
}

TEST(DefinitionDifferences, AreMembersThatTheServiceLacksButNotThoseItHasBesides) {
  OtherCounter older(counter_with("  function void reset()\n", ""));
  KeptLog log;
  Node node(log.options());
  {
    auto counter = node.connect<CounterStub>(older.service.url());
    EXPECT_EQ(code_of([&] { counter->reset(); }), ErrorCode::member_not_found);
    EXPECT_EQ(log.with("has no `test.counter.Counter.reset`").size(), 1U);
    EXPECT_EQ(log.all().size(), 1U);
  }
  OtherCounter newer(counter_with("  function void reset()\n",
                                  "  function void reset()\n  property double[] more\n"));
  auto counter = node.connect<CounterStub>(newer.service.url());
  EXPECT_EQ(code_of([&] { counter->reset(); }), ErrorCode::none);
  EXPECT_EQ(log.all().size(), 1U);
}

TEST(DefinitionDifferences, AreNotBlanksCommentsOptionsAndOrder) {
  std::string text =
      counter_with("  property double value\n",
                   "  ## How far it has come\n\tproperty   double \\\n  value  # x\n");
  text = replaced(text, "function double add(double a, double b)",
                  "function double add( double a ,double b ) [nolock]");
  text = replaced(text, "  property double fixed [readonly]\n", "");
  text = replaced(text, "  event ticked",
                  "  property double fixed [readonly, urgent]\n  event ticked");
  text = replaced(text, "stdver 0.10\n", "stdver 0.10\nconstant int32 MORE 7\n");
  text = replaced(text, "  field string label\n", "");
  text = replaced(text, "  field uint8[] picture\n",
                  "  field uint8[] picture\n  field string label\n");
  text = replaced(text, "objref Counter{int32} by_number", "objref Counter[] by_number");
  OtherCounter other(text);
  KeptLog log;
  Node node(log.options());
  auto counter = node.connect<CounterStub>(other.service.url());
  EXPECT_EQ(counter->get_value(), 1.5);
  EXPECT_TRUE(log.all().empty()) << log.all().front();
}

TEST(DefinitionDifferences, CanMakeConnectingFail) {
  OtherCounter other(counter_with("property double value", "property int32 value"));
  Node strict({.definition_check = DefinitionCheck::refuse});
  const Error error = error_of([&] { strict.connect<CounterStub>(other.service.url()); });
  EXPECT_EQ(error.code(), ErrorCode::service_definition_error);
  EXPECT_NE(error.message().find("test.counter.Counter.value"), std::string::npos);

  Node node;
  ConnectOptions refuse;
  refuse.definition_check = DefinitionCheck::refuse;
  EXPECT_EQ(code_of([&] { node.connect<CounterStub>(other.service.url(), refuse); }),
            ErrorCode::service_definition_error);
  OtherCounter same(std::string(rr_definition.text));
  EXPECT_EQ(code_of([&] { node.connect<CounterStub>(same.service.url(), refuse); }),
            ErrorCode::none);
}

TEST(DefinitionDifferences, CanBeLeftAlone) {
  OtherCounter other(counter_with("property double value", "property int32 value"));
  KeptLog log;
  NodeOptions options = log.options();
  options.definition_check = DefinitionCheck::off;
  Node node(options);
  auto counter = node.connect<CounterStub>(other.service.url());
  EXPECT_EQ(counter->get_value(), 1.5);
  EXPECT_TRUE(log.all().empty());
}

TEST(DefinitionDifferences, DoNotReachALogAsTheServiceWroteThem) {
  OtherCounter other(counter_with(
      "property double value",
      "property string{\x1b]0;OWNED\x07\u202e" + std::string(100'000, 'x') + "} value"));
  KeptLog log;
  Node node(log.options());
  auto counter = node.connect<CounterStub>(other.service.url());
  const auto lines = log.with("test.counter.Counter.value");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].find('\x1b'), std::string::npos);
  EXPECT_EQ(lines[0].find("\u202e"), std::string::npos);
  EXPECT_LT(lines[0].size(), 1200U);
}

using client::DefinitionShape;
using client::shape_of;

TEST(DefinitionShape, QualifiesTypesByAliasesAndTheOwnService) {
  const DefinitionShape shape = shape_of(
      "service a.b\nimport m.n\nusing m.n.Pose\nusing m.n.Twist as T\n"
      "enum Mode\n A = 0x10,\n B, C=-3\n D\nend\n"
      "pod P\n field double[3,4] x\n field Pose[2-] y\nend\n"
      "object O\n property T[] t\n property P{list} p\n function void f(Mode m, m.n.Pose q)\n"
      " wire single[*] w [readonly]\n memory uint8[] m\n property double[0] z\n"
      " callback int32 c( )\n function double{generator} g(string{generator} s)\nend\n");
  const auto& members = shape.objects.at("O");
  EXPECT_EQ(members.at("t").text, "property m.n.Twist[]");
  EXPECT_EQ(members.at("p").text, "property a.b.P{list}");
  EXPECT_EQ(members.at("f").text, "function void(a.b.Mode m,m.n.Pose q)");
  EXPECT_EQ(members.at("w").text, "wire single[*]");
  EXPECT_EQ(members.at("m").text, "memory uint8[]");
  EXPECT_EQ(members.at("z").text, "property double[]");
  EXPECT_EQ(members.at("c").text, "callback int32()");
  EXPECT_EQ(members.at("g").text, "function double{generator}(string{generator} s)");
  EXPECT_EQ(shape.records.at("P").text, "pod double[3,4] x; m.n.Pose[2-] y;");
  EXPECT_EQ(members.at("f").types, (std::set<std::string>{"a.b.Mode", "m.n.Pose"}));
  const auto& mode = shape.enums.at("Mode");
  EXPECT_EQ(mode.at("A"), 16);
  EXPECT_EQ(mode.at("B"), 17);
  EXPECT_EQ(mode.at("C"), -3);
}

TEST(DefinitionShape, OfAnotherTakesOnlyWhatIsWanted) {
  const DefinitionShape wanted =
      shape_of("service a\nstruct S\nfield double x\nend\nobject O\nproperty double p\nend\n");
  std::string text = "service a\n";
  for (int i = 0; i < 10'000; ++i) {
    const std::string number = std::to_string(i);
    text += "struct S" + number + "\nfield double x\nend\nobject O" + number + "\nend\n";
  }
  text += "object O\nproperty int32 p\nproperty int32 q\nproperty int8 p\nend\n";
  const DefinitionShape shape = shape_of(text, &wanted);
  EXPECT_TRUE(shape.records.empty());
  ASSERT_EQ(shape.objects.size(), 1U);
  ASSERT_EQ(shape.objects.at("O").size(), 1U);
  EXPECT_EQ(shape.objects.at("O").at("p").text, "property int32") << "the first counts";
}

TEST(DefinitionShape, SurvivesTextsThatAreNone) {
  for (const std::string text :
       {"", "object", "object O\nproperty", "object O\nfunction void f(", "enum E\n=,=,,\nend",
        "struct S\nfield", "object O\nproperty double[ x", "object O\nproperty double{ x\nend\nend",
        "using\nimport\nservice", "enum E\nA = 99999999999999999999,\nB\nend",
        "object O\nevent e(((((\nobjref\nend"}) {
    shape_of(text);
  }
  SUCCEED();
}

}  // namespace
}  // namespace rr::testing
