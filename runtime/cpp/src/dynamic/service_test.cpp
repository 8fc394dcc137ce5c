// SPDX-License-Identifier: Apache-2.0
// Properties, functions, events, objects and errors of services without generated code.
#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <thread>

#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/rig.hpp"
#include "runtime/cpp/src/dynamic/testing.hpp"

namespace rr::dynamic {
namespace {

using ::testing::ElementsAre;
using testing::error_text;
using ::testing::HasSubstr;
using testing::rig_definitions;

class DynamicService : public testing::Rigged {};
INSTANTIATE_TEST_SUITE_P(Versions, DynamicService, ::testing::Values(2, 4));

Error error_of(const std::function<void()>& what) {
  try {
    what();
  } catch (const Error& error) {
    return error;
  }
  return {ErrorCode::none, ""};
}

Value note(const std::string& text, const List& numbers = {}) {
  return StringMap{{"text", text}, {"numbers", numbers}};
}

TEST_P(DynamicService, KeepsProperties) {
  rig.store("speed", 1);
  rig.store("mode", "busy");
  rig.store("note", Value());
  EXPECT_EQ(client->get("speed"), Value(1.0));
  EXPECT_EQ(client->get("mode").text(), "busy");
  EXPECT_TRUE(client->get("note").is_null());
  client->set("note", note("a", {1, 2}));
  client->set("mode", 7);
  EXPECT_EQ(rig.stored("note")["text"].text(), "a");
  EXPECT_EQ(client->get("note"), rig.stored("note"));
  EXPECT_EQ(rig.stored("mode").as<int>(), 7);
  rig.store("speed", 2);
  EXPECT_EQ(client->get("speed").as<int>(), 2);
}

TEST_P(DynamicService, KeepsAValueForEachClient) {
  rig.store("mine", 1);
  const Client other = connect(node, url);
  client->set("mine", 2);
  EXPECT_EQ(client->get("mine").as<int>(), 2);
  EXPECT_EQ(other->get("mine").as<int>(), 1);
  EXPECT_EQ(rig.stored("mine").as<int>(), 1);
}

TEST_P(DynamicService, AnswersPropertiesByFunctions) {
  double speed = 0;
  rig.on_get("speed", [&] { return Value(speed + 1); });
  rig.on_set("speed", [&](const Value& value) { speed = value.as<double>(); });
  client->set("speed", 3);
  EXPECT_EQ(client->get("speed").as<double>(), 4);
}

TEST_P(DynamicService, AnswersLater) {
  std::promise<Reply> asked;
  rig.on_get_later("speed", [&](const Reply& reply) { asked.set_value(reply); });
  rig.on_set_later("speed", [](const Value& value, const Reply& reply) {
    std::thread([value, reply] {
      if (value.as<double>() < 0) {
        reply.fail(std::make_exception_ptr(Error(ErrorCode::out_of_range, "too slow")));
      } else {
        reply();
      }
    }).detach();
  });
  rig.on_call_later("add", [](const List& arguments, const Reply& reply) {
    reply(arguments[0].as<double>() + arguments[1].as<double>());
  });
  client->set("speed", 1);
  EXPECT_EQ(error_text([&] { client->set("speed", -1); }), "29: too slow");
  EXPECT_EQ(client->call("add", {1, 2}).as<double>(), 3);
  auto speed = std::async([&] { return client->get("speed").as<double>(); });
  {
    const Reply reply = asked.get_future().get();
    EXPECT_EQ(error_text([&] { reply("fast"); }), "11: member speed: expected double, got string");
    reply(5);
    EXPECT_EQ(error_of([&] { reply(6); }).code(), ErrorCode::invalid_operation);
  }
  EXPECT_EQ(speed.get(), 5);
}

TEST_P(DynamicService, FailsWhatIsDropped) {
  rig.on_get_later("speed", [](const Reply&) {});
  EXPECT_EQ(error_of([&] { (void)client->get("speed"); }).code(), ErrorCode::operation_aborted);
  rig.on_get_later("speed", [](const Reply&) { throw Error(ErrorCode::io_error, "broken"); });
  EXPECT_EQ(error_text([&] { (void)client->get("speed"); }), "26: broken");
}

TEST_P(DynamicService, CallsFunctions) {
  std::atomic<bool> is_stopped = false;
  rig.on_call("add", [](const List& arguments) -> Value {
    return arguments[0].as<double>() + arguments[1].as<double>();
  });
  rig.on_call("stop", [&](const List&) {
    is_stopped = true;
    return Value("does not matter");
  });
  rig.on_call("annotate", [](const List& arguments) -> Value {
    if (arguments[0].is_null()) return {};
    return note(arguments[0]["text"].text() + arguments[1].at(0).text(), {arguments[1].size()});
  });
  EXPECT_EQ(client->call("add", {1, 2.5}).as<double>(), 3.5);
  EXPECT_TRUE(client->call("stop").is_null());
  EXPECT_TRUE(is_stopped);
  EXPECT_TRUE(client->call("annotate", {Value(), List{}}).is_null());
  const Value annotated = client->call("annotate", {note("a"), List{"b", 1}});
  EXPECT_EQ(annotated["text"].text(), "ab");
  EXPECT_THAT(annotated["numbers"].array<double>(), ElementsAre(2));
  EXPECT_EQ(annotated.type_text(), "example.parts.Note");
}

TEST_P(DynamicService, NamesMemberAndTypeOfWrongValues) {
  rig.on_get("speed", [] { return Value("fast"); });
  rig.on_get("note", [] { return note("a", {1, "b"}); });
  rig.on_call("add", [](const List&) { return Value(List{1}); });
  EXPECT_EQ(error_text([&] { (void)client->get("speed"); }),
            "11: member speed: expected double, got string");
  EXPECT_EQ(error_text([&] { (void)client->get("note"); }),
            "11: member note, field numbers[1]: expected double, got string");
  EXPECT_EQ(error_text([&] {
              client->call("add", {1, 2});
            }),
            "11: member add, result: expected double, got list");
  EXPECT_EQ(error_text([&] { rig.store("speed", "x"); }),
            "11: member speed: expected double, got string");
  EXPECT_EQ(error_text([&] { rig.fire("changed", {1}); }),
            "18: member changed: expected 2 arguments (example.parts.Mode mode, "
            "example.parts.Vector3 at), got 1");
}

TEST_P(DynamicService, NamesWhatIsNoMember) {
  EXPECT_EQ(error_text([&] { rig.store("sped", 1); }),
            "9: `example.rig.Rig` has no property `sped`; did you mean `speed`?");
  EXPECT_EQ(error_text([&] { rig.on_call("count", {}); }),
            "10: member count: expected plain function, got generator function");
  EXPECT_EQ(error_text([&] { (void)rig.wire("samples"); }),
            "10: member samples: expected wire, got pipe");
  EXPECT_EQ(error_text([] { ServedObject(rig_definitions(), "example.rig.Rug"); }),
            "30: no object `example.rig.Rug`");
  EXPECT_EQ(error_of([] { ServedObject().fire("changed"); }).code(), ErrorCode::invalid_operation);
}

TEST_P(DynamicService, SaysWhatIsNotThere) {
  const auto code = [](const std::function<void()>& what) { return error_of(what).code(); };
  EXPECT_EQ(code([&] { (void)client->get("speed"); }), ErrorCode::not_implemented_error);
  EXPECT_EQ(code([&] { client->set("speed", 1); }), ErrorCode::not_implemented_error);
  EXPECT_EQ(code([&] { client->call("stop"); }), ErrorCode::not_implemented_error);
  EXPECT_EQ(code([&] { (void)client->generate("count", {1}).next(); }),
            ErrorCode::not_implemented_error);
  EXPECT_EQ(code([&] { (void)client->object("child"); }), ErrorCode::object_not_found);
  EXPECT_EQ(code([&] { (void)client->memory("buffer").length(); }), ErrorCode::invalid_operation);
}

TEST_P(DynamicService, ThrowsExceptionsOfTheDefinition) {
  rig.on_call("jam", [](const List& arguments) -> Value {
    throw Error(ErrorCode::remote_error, "example.rig.Jam", arguments[0].text(), "paper",
                to_varvalue(StringMap{{"why", List{3}}}));
  });
  const Error error = error_of([&] { client->call("jam", {"stuck"}); });
  EXPECT_EQ(error.code(), ErrorCode::remote_error);
  EXPECT_EQ(error.name(), "example.rig.Jam");
  EXPECT_EQ(error.message(), "stuck");
  EXPECT_EQ(error.subname(), "paper");
  EXPECT_EQ(client.value(error.parameter())["why"].at(0).as<int>(), 3);
  rig.on_call("stop", [](const List&) -> Value { throw std::runtime_error("something"); });
  EXPECT_THAT(error_of([&] { client->call("stop"); }).message(), HasSubstr("something"));
}

TEST_P(DynamicService, FiresEvents) {
  std::promise<List> came;
  const Subscription subscription =
      client->on_event("changed", [&](const List& arguments) { came.set_value(arguments); });
  rig.fire("changed", {"busy", StringMap{{"x", 1}, {"y", 2}, {"z", 3}}});
  const List arguments = came.get_future().get();
  ASSERT_EQ(arguments.size(), 2U);
  EXPECT_EQ(arguments[0].text(), "busy");
  EXPECT_EQ(arguments[1]["z"].as<double>(), 3);
}

ServedObject child_of(std::int32_t number) {
  ServedObject child(rig_definitions(), "example.rig.Child");
  child.store("number", number);
  child.on_get("title", [number] { return Value("child " + std::to_string(number)); });
  return child;
}

TEST_P(DynamicService, GivesObjectsWhenTheyAreAskedFor) {
  std::atomic<int> made = 0;
  const auto make = [&](std::int32_t number) {
    ++made;
    return child_of(number);
  };
  rig.on_object("child", [&](const Value& index) {
    EXPECT_TRUE(index.is_null());
    return make(1);
  });
  rig.on_object("by_index", [&](const Value& index) { return make(index.as<std::int32_t>()); });
  rig.on_object("by_name", [&](const Value& index) -> std::shared_ptr<Skeleton> {
    if (index.text() == "none") return nullptr;
    return make(static_cast<std::int32_t>(index.text().size()));
  });
  EXPECT_EQ(made, 0);
  const Object child = client->object("child");
  EXPECT_EQ(child.get("number").as<int>(), 1);
  client->object("child").set("number", 10);
  EXPECT_EQ(child.get("number").as<int>(), 10);
  EXPECT_EQ(made, 1);
  EXPECT_EQ(client->object("by_index", -3).get("number").as<int>(), -3);
  EXPECT_EQ(client->object("by_name", "ab[1]").get("title").text(), "child 5");
  EXPECT_EQ(error_of([&] { (void)client->object("by_name", "none"); }).code(),
            ErrorCode::service_error);
}

TEST_P(DynamicService, GivesObjectsOfTheDeclaredTypesOnly) {
  rig.on_object("child",
                [](const Value&) { return ServedObject(rig_definitions(), "example.rig.Other"); });
  EXPECT_EQ(error_text([&] { (void)client->object("child"); }),
            "17: member child: expected a `example.rig.Child`, got a `example.rig.Other`");
  rig.on_object("anything", [](const Value& index) -> std::shared_ptr<Skeleton> {
    if (index.as<int>() == 0) return child_of(0);
    return ServedObject(Definitions({testing::rig_text, testing::parts_text}), "example.rig.Other");
  });
  EXPECT_EQ(client->object("anything", 0).type_name(), "example.rig.Child");
  EXPECT_EQ(error_text([&] { (void)client->object("anything", 1); }),
            "17: member anything: the object is one of other definitions");
}

TEST_P(DynamicService, GivesEachClientAnObjectOfItsOwn) {
  std::atomic<int> made = 0;
  rig.on_object("child", [&](const Value&) { return per_client(child_of(++made).skeleton()); });
  const Client other = connect(node, url);
  EXPECT_EQ(client->object("child").get("number").as<int>(), 1);
  EXPECT_EQ(other->object("child").get("number").as<int>(), 2);
}

TEST_P(DynamicService, IsToldWhereItIs) {
  ServedObject child = child_of(1);
  std::promise<std::string> released;
  std::string attached;
  child.on_attached([&](ServiceContext&, const std::string& path) { attached = path; });
  child.on_released([&](const std::string& path) { released.set_value(path); });
  rig.on_object("child", [&](const Value&) { return child; });
  (void)client->object("child").get("number");
  EXPECT_EQ(attached, "rig.child");
  service->release_path("rig.child");
  EXPECT_EQ(released.get_future().get(), "rig.child");
}

TEST_P(DynamicService, SendsItsDefinitions) {
  EXPECT_THAT(client.types().services(), ElementsAre("example.parts", "example.rig"));
  EXPECT_EQ(client->member("ask").declaration, "callback Note ask(string question, Vector3 at)");
}

TEST_P(DynamicService, SendsWhatIsNotImportedToo) {
  constexpr const char* extra =
      "service example.extra\n\nstdver 0.10\n\nstruct Late\n"
      "    field int32 number\nend\n";
  const Definitions definitions({testing::rig_text, testing::parts_text, extra});
  const ServedObject other(definitions, "example.rig.Rig");
  other.on_call("annotate", [](const List&) { return Value(); });
  const Service offered = register_service(server, "other", other);
  const Client second = connect(node, url.substr(0, url.rfind('=') + 1) + "other");
  EXPECT_THAT(second.types().services(),
              ElementsAre("example.extra", "example.parts", "example.rig"));
  const Value late = second.types().type("example.extra.Late").convert(StringMap{{"number", 1}});
  EXPECT_TRUE(second->call("annotate", {Value(), List{late}}).is_null());
}

TEST_P(DynamicService, SendsWhatIsNotImportedOnlyIfItIsNamed) {
  using Names = std::set<std::string>;
  constexpr const char* late = "service example.late\n\nstdver 0.10\n";
  constexpr const char* extra = "service example.extra\n\nstdver 0.10\n";
  const Definitions definitions({testing::rig_text, testing::parts_text, late, extra});
  const std::string place = url.substr(0, url.rfind('=') + 1);
  const ServedObject less(definitions, "example.rig.Rig");
  const Service plain = register_service(server, "plain", less, {}, Names());
  EXPECT_THAT(connect(node, place + "plain").types().services(),
              ElementsAre("example.parts", "example.rig"));
  const ServedObject more(definitions, "example.rig.Rig");
  const Service named = register_service(server, "named", more, {}, Names{"example.late"});
  EXPECT_THAT(connect(node, place + "named").types().services(),
              ElementsAre("example.late", "example.parts", "example.rig"));
}

TEST_P(DynamicService, MayBeOfferedAgainFromTheSameText) {
  service->close();
  for (int time = 0; time < 3; ++time) {
    const Definitions definitions({testing::rig_text, testing::parts_text});
    const ServedObject again(definitions, "example.rig.Rig");
    again.store("speed", time);
    again.on_call("annotate", [](const List& arguments) { return arguments[1].at(0); });
    const Service offered = register_service(server, "rig", again);
    const Client second = connect(node, url);
    EXPECT_EQ(second->get("speed").as<int>(), time);
    // The varvalue holds a struct of the definition, which the node knows from before.
    const Value given = second.types().type("example.parts.Note").convert(note("n", {time}));
    EXPECT_EQ(second->call("annotate", {Value(), List{given}}), given);
    offered->close();
  }
}

TEST_P(DynamicService, GoesWithItsLastHandle) {
  std::weak_ptr<int> captured;
  {
    ServedObject object(rig_definitions(), "example.rig.Rig");
    auto held = std::make_shared<int>(1);
    captured = held;
    const WeakServedObject weak(object);
    object.on_call("stop", [held, weak](const List&) {
      weak.lock().store("speed", *held);
      return Value();
    });
    EXPECT_TRUE(weak.lock());
    object = ServedObject();
    EXPECT_FALSE(weak.lock());
  }
  EXPECT_TRUE(captured.expired());
}

}  // namespace
}  // namespace rr::dynamic
