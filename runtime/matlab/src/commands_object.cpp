// SPDX-License-Identifier: Apache-2.0
// Members of objects: what the user writes behind the dot.
#include "rr/error.hpp"
#include "runtime/matlab/src/access.hpp"

namespace rr::matlab {
namespace {

using dynamic::Value;

Accessed give_value(const Value& value, const Resolved& member, ObjectHandle& object, Given kind) {
  if (member.plan == nullptr) return {make_null(), Given::nothing};
  return {to_mex(value, *member.plan, object.connection()->plans), kind};
}

Value get(Runtime& runtime, const ObjectHandle& object, const std::string& name) {
  return runtime.call<Value>([&] { return object.object().get(name); },
                             [&](auto done) { object.object().async_get(name, std::move(done)); });
}

void set(Runtime& runtime, const ObjectHandle& object, const Resolved& member,
         const mxArray* given) {
  const std::string& name = member.member.name;
  const Value value = read_value(object, given, member.plan, member.subject);
  runtime.call<>([&] { object.object().set(name, value); },
                 [&](auto done) { object.object().async_set(name, value, std::move(done)); });
}

Value call_member(Runtime& runtime, const ObjectHandle& object, const Resolved& member,
                  const dynamic::List& arguments) {
  const std::string& name = member.member.name;
  return runtime.call<Value>(
      [&] { return object.object().call(name, arguments); },
      [&](auto done) { object.object().async_call(name, arguments, std::move(done)); });
}

mxArray* open_generator(Runtime& runtime, const ObjectHandle& object, const Resolved& member,
                        const dynamic::List& arguments) {
  const std::string& name = member.member.name;
  auto generator = runtime.call<dynamic::Generator>(
      [&] { return object.object().generate(name, arguments); },
      [&](auto done) { object.object().async_generate(name, arguments, std::move(done)); });
  return give_generator(runtime, object, member, std::move(generator));
}

mxArray* find_object(Runtime& runtime, const ObjectHandle& object, const Resolved& member,
                     const std::vector<const mxArray*>& indexes) {
  if (indexes.size() > 1) {
    throw Error(ErrorCode::invalid_argument, member.subject + ": expected one index at most");
  }
  const Value index = read_index(member, indexes.empty() ? nullptr : indexes[0]);
  const std::string& name = member.member.name;
  const dynamic::Object& from = object.object();
  auto found = runtime.call<dynamic::Object>(
      [&] {
        if (index.is_null()) return from.object(name);
        if (index.kind() == dynamic::Kind::text) return from.object(name, index.text());
        return from.object(name, index.as<std::int32_t>());
      },
      [&](auto done) { from.async_object(name, index, std::move(done)); });
  return give_object(runtime, object.connection(), std::move(found));
}

// access(object, name, arguments...): [value, kind]
void access(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const auto given = call.rest(2);
  const Accessed accessed =
      access_member(runtime, *object, call.text(1), {given.begin(), given.end()});
  call.give(accessed.value);
  call.give(mxCreateDoubleScalar(static_cast<double>(accessed.kind)));
}

// assign(object, name, value)
void assign(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  assign_member(runtime, *object, call.text(1), call[2]);
}

// kind(object, name): `property`, ...; '' for no member
void kind(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  std::string word;
  try {
    const std::string& declaration = object->resolve(call.text(1)).member.declaration;
    word = declaration.substr(0, declaration.find(' '));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::member_not_found) throw;
  }
  call.give(make_text(word));
}

// members(object): [names, declarations, documentation], cells
void members(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  std::vector<mxArray*> names;
  std::vector<mxArray*> declarations;
  std::vector<mxArray*> documentation;
  for (const auto& member : object->object().members()) {
    names.push_back(make_text(member.name));
    declarations.push_back(make_text(member.declaration));
    documentation.push_back(make_text(member.documentation));
  }
  call.give(make_cells(names));
  call.give(make_cells(declarations));
  call.give(make_cells(documentation));
}

// about(object): struct with path, type, documentation, is_open
void about(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const bool is_open = object->connection()->is_open();
  call.give(make_struct({{"path", make_text(object->object().path())},
                         {"type", make_text(object->object().type_name())},
                         {"documentation", make_text(object->object().documentation())},
                         {"is_open", mxCreateLogicalScalar(is_open)}}));
}

// same(object, object)
void same(Runtime& runtime, Call& call) {
  const auto a = object_of(runtime, call, 0);
  const auto b = object_of(runtime, call, 1);
  call.give(
      mxCreateLogicalScalar(a->object().path() == b->object().path() &&
                            a->object().stub().rr_session() == b->object().stub().rr_session()));
}

}  // namespace

Accessed access_member(Runtime& runtime, ObjectHandle& object, const std::string& name,
                       const std::vector<const mxArray*>& arguments) {
  const Resolved& member = object.resolve(name);
  switch (member.use) {
    case Use::get:
      return give_value(get(runtime, object, member.member.name), member, object, Given::value);
    case Use::set:
      if (arguments.size() != 1) {
        throw Error(ErrorCode::invalid_argument, member.subject + ": expected one value");
      }
      set(runtime, object, member, arguments[0]);
      return {make_null(), Given::nothing};
    case Use::call:
      return give_value(
          call_member(runtime, object, member, read_arguments(object, member, arguments)), member,
          object, Given::result);
    case Use::generate:
      return {open_generator(runtime, object, member, read_arguments(object, member, arguments)),
              Given::generator};
    case Use::object:
      return {find_object(runtime, object, member, arguments), Given::object};
    case Use::wire:
      return {make_text(member.member.name), Given::wire};
    case Use::pipe:
      return {make_text(member.member.name), Given::pipe};
    case Use::memory:
      return {make_text(member.member.name), Given::memory};
    case Use::callback:
      return {callback_function(object, member), Given::value};
    case Use::event:
      break;
  }
  throw Error(ErrorCode::member_format_mismatch, member.subject +
                                                     ": it is an event; use addlistener(object, '" +
                                                     member.member.name + "', function)");
}

void assign_member(Runtime& runtime, ObjectHandle& object, const std::string& name,
                   const mxArray* value) {
  const Resolved& member = object.resolve(name);
  if (member.use == Use::get || member.use == Use::set) return set(runtime, object, member, value);
  if (member.use == Use::callback) return set_callback(runtime, object, member, value);
  const std::string& of = member.member.name;
  const std::string remedy =
      member.use == Use::wire
          ? ": it is a wire; w = object." + of + ".Connect(); w.OutValue = value, or object." + of +
                ".PokeOutValue(value)"
      : member.use == Use::pipe
          ? ": it is a pipe; p = object." + of + ".Connect(-1); p.SendPacket(packet)"
      : member.use == Use::memory ? ": it is a memory; object." + of + "(:) = items"
                                  : ": only properties and callbacks can be assigned";
  throw Error(ErrorCode::member_format_mismatch, member.subject + remedy);
}

Value read_index(const Resolved& member, const mxArray* given) {
  if (given == nullptr) return {};
  return as_subject(member.subject + ", index", [&]() -> Value {
    if (mxIsChar(given)) return read_text(given);
    return read_number<std::int32_t>(given);
  });
}

std::vector<Command> object_commands() {
  return {{"access", access},   {"assign", assign}, {"kind", kind},
          {"members", members}, {"about", about},   {"same", same}};
}

}  // namespace rr::matlab
