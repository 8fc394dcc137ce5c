// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/dynamic/script.hpp"

#include <utility>

#include "conformance/runners/dynamic/notation.hpp"
#include "conformance/runners/shared/outcomes.hpp"

namespace rr::conformance {

using dynamic::MemberDescription;
using dynamic::Value;

dynamic::ServedObject DynamicScript::serve(const dynamic::Definitions& definitions,
                                           const std::string& type, Json node) {
  const dynamic::ServedObject object(definitions, type);
  const auto script = std::make_shared<DynamicScript>(definitions, std::move(node));
  script->object_ = object;
  script->add_members();
  object.on_attached(
      [script](ServiceContext& context, const std::string&) { script->attached(context); });
  if (has_monitor(object.skeleton()->rr_object_type())) {
    object.set_monitor([script](auto timeout) { return script->enter_monitor(timeout); },
                       [script] { script->exit_monitor(); });
  }
  return object;
}

void DynamicScript::add_members() {
  for (const MemberDescription& member : object().members()) {
    switch (member.kind) {
      case MemberKind::property:
        add_property(member);
        break;
      case MemberKind::function:
        add_function(member);
        break;
      case MemberKind::event:
        add_event(member.name);
        break;
      case MemberKind::objref:
        add_objref(member.name);
        break;
      case MemberKind::pipe:
        add_pipe(member);
        break;
      case MemberKind::callback:
        add_callback(member);
        break;
      case MemberKind::wire:
        add_wire(member);
        break;
      case MemberKind::memory:
        add_memory(member);
        break;
    }
  }
}

void DynamicScript::add_property(const MemberDescription& member) {
  object().on_get(member.name, [self = shared_from_this(), name = member.name, type = member.type] {
    return value_of_json(self->definitions_, type, self->value_of(name));
  });
  object().on_set(member.name, [self = shared_from_this(), name = member.name,
                                type = member.type](const Value& value) {
    self->set_value(name, json_of_value(self->definitions_, type, value));
  });
}

void DynamicScript::add_function(const MemberDescription& member) {
  if (member.generator == GeneratorForm::none) {
    object().on_call(
        member.name, [self = shared_from_this(), member](const dynamic::List& arguments) {
          const Json result =
              self->outcome(member.name, json_of_parameters(self->definitions_, member, arguments),
                            member.type.text());
          return value_of_json(self->definitions_, member.type, result);
        });
    return;
  }
  object().on_generate(
      member.name,
      [self = shared_from_this(), member](const dynamic::List& arguments) -> dynamic::Steps {
        const auto steps = std::make_shared<ScriptedSteps>(
            *self, self->next_outcome(member.name,
                                      json_of_parameters(self->definitions_, member, arguments)));
        return [self, steps, type = member.type](const Value&) -> std::optional<Value> {
          const std::optional<Json> value = steps->give();
          if (!value) return std::nullopt;
          return value_of_json(self->definitions_, type, *value);
        };
      });
}

dynamic::List DynamicScript::arguments_of(const std::string& member, const Json& json) const {
  return parameters_of_json(definitions_, object().member(member), json);
}

void DynamicScript::add_event(const std::string& name) {
  add_action("fire_" + name, [this, name](std::string_view) {
    for (const Json& arguments : told("events", name)) {
      object().fire(name, arguments_of(name, arguments));
    }
    return Json();
  });
}

void DynamicScript::add_pipe(const MemberDescription& member) {
  object().pipe(member.name).on_connect([weak = weak_from_this()](dynamic::PipeEndpoint end) {
    end.on_packet([weak](const Value&) {
         if (const auto self = weak.lock()) self->count_packet();
       })
        .detach();
  });
  add_action("received_count", [this](std::string_view) { return Json(packet_count()); });
  add_action("send_" + member.name, [this, member](std::string_view) {
    const Json packets = told("pipes", member.name);
    for (dynamic::PipeEndpoint& end : object().pipe(member.name).endpoints()) {
      for (const Json& entry : packets) {
        end.ask_for_acknowledgements(entry.value("ack", false));
        end.send(value_of_json(definitions_, member.type, entry.at("packet")));
      }
    }
    return Json();
  });
  add_action("close_" + member.name, [this, member](std::string_view) {
    for (dynamic::PipeEndpoint& end : object().pipe(member.name).endpoints()) end.close();
    return Json();
  });
}

void DynamicScript::add_wire(const MemberDescription& member) {
  const std::string name = member.name;
  const auto scripted = [weak = weak_from_this(), member](const char* key) {
    const auto self = weak.lock();
    const Json values = self->told("wires", member.name);
    if (!values.contains(key)) throw Error(ErrorCode::value_not_set, "Value not set");
    return value_of_json(self->definitions_, member.type, values.at(key));
  };
  object().wire(name).on_peek_in([scripted] { return scripted("peek_in"); });
  object().wire(name).on_peek_out([scripted, name, weak = object_] {
    const auto newest = weak.lock().wire(name).out();
    return newest ? newest->value : scripted("peek_out");
  });
  object().wire(name).on_connect(
      [weak = weak_from_this(), name, scripted](const dynamic::ServedWire& /*wire*/) {
        const auto self = weak.lock();
        if (!self || part(self->told("wires", name), "at_connect") != true) return;
        self->do_later(name + " at_connect", [wire = self->object().wire(name), scripted] {
          wire.set_in(scripted("peek_in"));
        });
      });
  add_action("send_" + name, [this, member](std::string_view) {
    for (const Json& value : part(told("wires", member.name), "send")) {
      object().wire(member.name).set_in(value_of_json(definitions_, member.type, value));
    }
    return Json();
  });
  add_action("last_" + name, [this, member](std::string_view) {
    const auto newest = object().wire(member.name).out();
    if (!newest) throw Error(ErrorCode::value_not_set, "Value not set");
    return json_of_value(definitions_, member.type, newest->value);
  });
  add_action("close_" + name, [this, name](std::string_view) {
    for (dynamic::ServedWire& end : object().wire(name).connections()) end.close();
    return Json();
  });
}

// A function of another type tells the error as a text.
void DynamicScript::add_callback(const MemberDescription& member) {
  add_action("call_" + member.name, [this, member](std::string_view result_type) {
    try {
      return json_of_value(
          definitions_, member.type,
          object().call_back(member.name, client(),
                             arguments_of(member.name, told("callbacks", member.name))));
    } catch (const Error& error) {
      if (result_type == member.type.text()) throw;
      return Json(error.what());
    }
  });
}

void DynamicScript::add_objref(const std::string& name) {
  object().on_object(name, [self = shared_from_this(), name](const Value& index) {
    if (index.is_null()) return self->child(name);
    if (index.kind() == dynamic::Kind::text) return self->child(name, index.text());
    return self->child(name, index.as<std::int32_t>());
  });
}

void DynamicScript::add_memory(const MemberDescription& member) {
  const Json content = told("memories", member.name);
  if (content.is_null()) return;
  object().store_memory(member.name, value_of_json(definitions_, member.type, content));
}

VarValue DynamicScript::read_parameter(const Json& json) const {
  return dynamic::to_varvalue(value_of_json(definitions_, definitions_.type("varvalue"), json));
}

std::shared_ptr<rr::Skeleton> DynamicScript::make_child(const std::string& type, Json node) const {
  return serve(definitions_, type, std::move(node));
}

}  // namespace rr::conformance
