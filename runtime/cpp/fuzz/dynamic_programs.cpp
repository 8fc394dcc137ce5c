// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "rr/dynamic.hpp"
#include "runtime/cpp/fuzz/client_programs.hpp"

namespace rr::fuzz {
namespace {

using dynamic::List;
using dynamic::Object;
using dynamic::Value;

// What is waited for that may never come.
constexpr std::chrono::milliseconds a_moment{1};

using Use = void(dynamic::Client& root, Attempts& attempts);

template <Use* use>
void with_client(Node& node, std::string_view url, Attempts& attempts) {
  dynamic::Client client;
  const bool is_connected = attempts.attempt([&] { client = dynamic::connect(node, url); });
  if (!is_connected) return;
  attempts.watch(client);
  use(client, attempts);
  attempts.attempt([&] { client.close(); });
}

// All that can be done with a value, so that none is kept that cannot be looked at.
void look_at(const Value& value, const dynamic::ValueType& type) {
  static_cast<void>(value.type_text());
  static_cast<void>(value.to_json());
  const std::string json = type.to_json(value);
  promise(type.to_json(type.from_json(json)) == json, "a value is the same after JSON");
  static_cast<void>(type.convert(value));
}

void get(const Object& object, Attempts& attempts, std::initializer_list<const char*> names) {
  for (const char* const name : names) {
    Value value;
    if (attempts.attempt([&] { value = object.get(name); })) {
      attempts.attempt([&] { look_at(value, object.member(name).type); });
    }
  }
}

Value leaf() {
  return Value::record({{"name", "leaf"},
                        {"mode", "manual"},
                        {"stats", Value::record({{"count", 1}, {"mean", 2.5}, {"label", "one"}})}});
}

// What the definitions say of themselves, whatever they are.
void look_through(const dynamic::Definitions& types) {
  for (const std::string& service : types.services()) {
    static_cast<void>(types.outline(service));
    static_cast<void>(types.text(service));
    static_cast<void>(types.constants(service));
    const dynamic::DeclaredNames declared = types.declared(service);
    for (const std::string& name : declared.records) {
      const dynamic::ValueType type = types.type(name);
      static_cast<void>(types.constants(name));
      for (const dynamic::Field& field : type.fields()) static_cast<void>(field.type.text());
    }
    for (const std::string& name : declared.enums) {
      static_cast<void>(types.type(name).enum_values());
    }
    for (const std::string& name : declared.objects) {
      static_cast<void>(types.documentation(name));
      static_cast<void>(types.constants(name));
      for (const dynamic::MemberDescription& member : types.members(name)) {
        static_cast<void>(member.type.text());
      }
    }
  }
}

void describe(dynamic::Client& root, Attempts& attempts) {
  attempts.attempt([&] { look_through(root.types()); });
  attempts.attempt([&] { static_cast<void>(root.attributes()); });
  attempts.attempt([&] { static_cast<void>(root.fetch_attributes()); });
  attempts.attempt([&] { static_cast<void>(root->members()); });
  attempts.attempt([&] { look_through(root->object("child").types()); });
}

void get_numbers(dynamic::Client& root, Attempts& attempts) {
  Object props;
  if (!attempts.attempt([&] { props = root->object("props"); })) return;
  get(props, attempts,
      {"v_double", "v_uint64", "v_bool", "v_cdouble", "v_string", "v_mode", "a_double", "a_uint8",
       "a_bool", "f_double", "x_int32", "m_double", "m_bool", "g_single", "g_uint8", "failing"});
  attempts.attempt([&] { props.set("v_double", 0.5); });
  attempts.attempt([&] { props.set("a_int64", List{1, 2, 3}); });
  attempts.attempt([&] { props.set("v_mode", "automatic"); });
}

void get_containers(dynamic::Client& root, Attempts& attempts) {
  Object props;
  if (!attempts.attempt([&] { props = root->object("props"); })) return;
  attempts.attempt([&] { props.set("t_leaf", leaf()); });
  attempts.attempt([&] { props.set("l_double", List{1.5, 2.5}); });
  attempts.attempt([&] { props.set("any", dynamic::StringMap{{"a", 1.5}, {"b", "two"}}); });
  get(props, attempts,
      {"t_leaf", "l_double", "any", "t_tree", "l_bool", "i_bool", "l_string", "l_array",
       "l_multidim", "l_mode", "l_stats", "i_array", "s_array", "s_stats", "l_any", "i_any",
       "s_any"});
}

void get_records(dynamic::Client& root, Attempts& attempts) {
  Object props;
  if (!attempts.attempt([&] { props = root->object("props"); })) return;
  attempts.attempt([&] { props.set("n_array", List{List{1, 2, 3}, List{4, 5, 6}}); });
  get(props, attempts,
      {"p_one", "p_array", "p_fixed", "p_max", "p_multidim", "p_grid", "p_list_array", "p_map",
       "p_reading", "n_one", "n_array", "n_fixed", "n_max", "n_multidim", "n_grid", "n_map_array",
       "n_transform", "n_image"});
}

void call_functions(dynamic::Client& root, Attempts& attempts) {
  Object funcs;
  if (!attempts.attempt([&] { funcs = root->object("funcs"); })) return;
  const auto call = [&](const char* name, const List& arguments) {
    Value value;
    if (attempts.attempt([&] { value = funcs.call(name, arguments); })) {
      attempts.attempt([&] { look_at(value, funcs.member(name).type); });
    }
  };
  call("nothing", {});
  call("add", {1, 2});
  call("five", {1, 2, 3, List{4}, "five"});
  call("make_stats", {1, 2, "three"});
  call("echo_leaf", {leaf()});
  call("cross", {List{1, 2, 3}, List{4, 5, 6}});
  call("echo_any", {"any"});
  call("echo_map", {dynamic::StringMap{{"a", 1}}});
  call("next_mode", {"idle"});
  attempts.attempt([&] { static_cast<void>(funcs.call("none")); });
  attempts.attempt_async([&] {
    auto promise = std::make_shared<std::promise<Value>>();
    funcs.async_call("add", {1, 2}, [promise](std::exception_ptr error, Value value) {
      if (error) {
        promise->set_exception(std::move(error));
      } else {
        promise->set_value(std::move(value));
      }
    });
    return promise->get_future();
  });
}

void take_errors(dynamic::Client& root, Attempts& attempts) {
  Object errs;
  if (!attempts.attempt([&] { errs = root->object("errs"); })) return;
  attempts.attempt([&] { static_cast<void>(errs.call("raise_service_fault", {"fault"})); });
  attempts.attempt([&] {
    try {
      static_cast<void>(errs.call("raise_calibration_error", {"error", "subname", 2.5}));
    } catch (const Error& error) {
      static_cast<void>(root.value(error.parameter()).to_json());
      throw;
    }
  });
  attempts.attempt([&] { static_cast<void>(errs.call("raise_code", {7, "code"})); });
  get(errs, attempts, {"failing_value"});
}

void find_objects(dynamic::Client& root, Attempts& attempts) {
  const auto look = [&](const auto& find) {
    attempts.attempt([&] {
      const Object object = find();
      static_cast<void>(object.type_name());
      for (const dynamic::MemberDescription& member : object.members()) {
        static_cast<void>(object.member(member.name).declaration);
      }
    });
  };
  look([&] { return root->object("child").object("next_child"); });
  look([&] { return root->object("by_index", 1); });
  look([&] { return root->object("by_name", "a b"); });
  look([&] { return root->object("any_named", "c"); });
  look([&] { return root->object("anything"); });
  look([&] { return root->object("anything_by_number", 3); });
  attempts.attempt([&] { static_cast<void>(root->call("release_child", {"child"})); });
  look([&] { return root->object("child"); });
}

void use_streams(dynamic::Client& root, Attempts& attempts) {
  Object streams;
  if (!attempts.attempt([&] { streams = root->object("streams"); })) return;
  dynamic::PipeEndpoint leaves;
  dynamic::PipeEndpoint parcels;
  dynamic::WireConnection state;
  dynamic::WireConnection force;
  Subscription packets;
  Subscription values;
  Subscription events;
  const bool has_leaves = attempts.attempt([&] { leaves = streams.pipe("leaves").connect(); });
  const bool has_parcels = attempts.attempt([&] { parcels = streams.pipe("parcels").connect(); });
  const bool has_state = attempts.attempt([&] { state = streams.wire("state").connect(); });
  const bool has_force = attempts.attempt([&] { force = streams.wire("force").connect(); });
  if (has_parcels) {
    attempts.attempt([&] {
      packets = parcels.on_packet([](const Value& packet) { static_cast<void>(packet.to_json()); });
    });
  }
  if (has_state) {
    attempts.attempt([&] {
      values = state.on_in(
          [](const Value& value, const TimeSpec&) { static_cast<void>(value.to_json()); });
    });
  }
  attempts.attempt([&] { events = streams.on_event("fired", [](const List&) {}); });
  attempts.attempt(
      [&] { streams.callback("ask").set([](const List& arguments) { return arguments.at(0); }); });
  attempts.attempt([&] { streams.callback("ask_leaf").set([](const List&) { return leaf(); }); });
  attempts.attempt([&] { static_cast<void>(streams.call("fire")); });
  if (has_leaves) attempts.attempt([&] { static_cast<void>(leaves.receive_for(a_moment)); });
  if (has_force) {
    attempts.attempt([&] { force.set_out(List{1, 2, 3}); });
    attempts.attempt([&] { static_cast<void>(force.wait_in(a_moment)); });
  }
  attempts.attempt([&] { static_cast<void>(streams.wire("state").peek_in().value.to_json()); });
  attempts.attempt([&] { streams.wire("force").poke_out(List{1, 2, 3}); });
  attempts.attempt([&] { static_cast<void>(streams.pipe("samples").connect().send(List{1})); });
  if (has_leaves) attempts.attempt([&] { leaves.close(); });
  if (has_state) attempts.attempt([&] { state.close(); });
}

void use_memories(dynamic::Client& root, Attempts& attempts) {
  Object streams;
  if (!attempts.attempt([&] { streams = root->object("streams"); })) return;
  const auto use = [&](const char* name, const dynamic::Memory::Numbers& position,
                       const dynamic::Memory::Numbers& count) {
    attempts.attempt([&] { static_cast<void>(streams.memory(name).length()); });
    attempts.attempt([&] { static_cast<void>(streams.memory(name).dims()); });
    Value value;
    if (attempts.attempt([&] { value = streams.memory(name).read(position, count); })) {
      attempts.attempt([&] { static_cast<void>(value.to_json()); });
      attempts.attempt([&] { streams.memory(name).write(position, value); });
    }
  };
  use("bytes", {0}, {64});
  use("grid", {1, 1}, {3, 2});
  use("cells", {2}, {4});
}

void use_generators(dynamic::Client& root, Attempts& attempts) {
  Object streams;
  if (!attempts.attempt([&] { streams = root->object("streams"); })) return;
  dynamic::Generator count;
  if (attempts.attempt([&] { count = streams.generate("count", {2}); })) {
    for (int step = 0; step != 4; ++step) {
      attempts.attempt([&] { static_cast<void>(count.next()); });
    }
  }
  dynamic::Generator exchange;
  if (attempts.attempt([&] { exchange = streams.generate("exchange"); })) {
    attempts.attempt([&] {
      const std::optional<Value> value = exchange.next("one");
      if (value) look_at(*value, streams.member("exchange").type);
    });
    attempts.attempt([&] { exchange.close(); });
  }
  dynamic::Generator take;
  if (attempts.attempt([&] { take = streams.generate("take", {"ab"}); })) {
    attempts.attempt([&] { static_cast<void>(take.next(1.5)); });
    attempts.attempt([&] { take.abort(); });
  }
}

}  // namespace

std::span<ClientProgram* const> dynamic_programs() {
  static constexpr std::array<ClientProgram*, 10> programs = {
      with_client<describe>,      with_client<get_numbers>,    with_client<get_containers>,
      with_client<get_records>,   with_client<call_functions>, with_client<take_errors>,
      with_client<find_objects>,  with_client<use_streams>,    with_client<use_memories>,
      with_client<use_generators>};
  return programs;
}

}  // namespace rr::fuzz
