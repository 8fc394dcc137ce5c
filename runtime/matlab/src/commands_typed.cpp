// SPDX-License-Identifier: Apache-2.0
// Objects of generated classes: the same as all others, but members are found in the class's list.
// With the classes' stubs compiled in, properties and functions go through these; arguments of
// another form than the usual one, and everything else, go the way of the dynamic object, so that
// both behave alike.
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "rr/matlab/module.hpp"
#include "rr/registry.hpp"
#include "rr/stub_beside.hpp"
#include "runtime/matlab/src/access.hpp"

namespace rr::matlab {
namespace {

/// An object of a generated class.
class TypedHandle final : public ObjectHandle {
 public:
  TypedHandle(const ObjectHandle& object, std::vector<std::string> names,
              std::shared_ptr<Stub> stub, std::span<const TypedMember> members)
      : ObjectHandle(object.connection(), object.object()),
        stub_(std::move(stub)),
        members_(members) {
    for (std::size_t i = 0; i < names.size(); ++i) places_.emplace(std::move(names[i]), i);
  }

  /// Null where there is no typed stub, or the member is used as that of a dynamic object.
  [[nodiscard]] const TypedMember* typed(const std::string& name) const {
    const auto place = places_.find(name);
    if (place == places_.end()) {
      throw Error(ErrorCode::member_not_found, "the object's class has no member `" + name + "`");
    }
    const bool has_one = stub_ && members_[place->second].run != nullptr;
    return has_one ? &members_[place->second] : nullptr;
  }
  [[nodiscard]] Stub& stub() const { return *stub_; }

 private:
  std::unordered_map<std::string, std::size_t> places_;
  const std::shared_ptr<Stub> stub_;
  const std::span<const TypedMember> members_;
};

/// A typed call as it goes on in this interpreter.
class RunningCall final : public TypedCall {
 public:
  explicit RunningCall(Runtime& runtime) : runtime_(runtime) {}

  void block(void (*body)(void*), void* context) override {
    has_begun_ = true;
    runtime_.call_directly([&] { body(context); });
  }
  /// Whether something may have been sent.
  [[nodiscard]] bool has_begun() const { return has_begun_; }

 private:
  Runtime& runtime_;
  bool has_begun_ = false;
};

const TypedObject* find_class(const Runtime& runtime, const std::string& name) {
  for (const Module* const module : runtime.modules) {
    for (const TypedObject& object : module->objects) {
      if (object.name == name) return &object;
    }
  }
  return nullptr;
}

/// Whether an object's type is `wanted` or implements it, directly or not.
bool is_or_implements(const ObjectType& type, const TypeRegistry& types, const std::string& wanted,
                      std::set<std::string>& seen) {
  if (type.name == wanted) return true;
  for (const std::string_view base : type.implements) {
    std::string name(base);
    // Names without a dot are of the type's own definition.
    if (name.find('.') == std::string::npos) {
      name = std::string(type.definition.name) + "." + name;
    }
    if (!seen.insert(name).second) continue;
    if (name == wanted) return true;
    const ObjectType* const found = types.find_object(name);
    if (found != nullptr && is_or_implements(*found, types, wanted, seen)) return true;
  }
  return false;
}

void check_class(const ObjectHandle& object, const std::string& wanted) {
  std::set<std::string> seen;
  const ObjectType& type = object.object().stub().rr_object_type();
  const dynamic::Definitions types = object.object().types();
  if (is_or_implements(type, types.registry(), wanted, seen)) return;
  throw Error(ErrorCode::service_error,
              "the object is a `" + std::string(type.name) + "`, not a `" + wanted + "`");
}

std::vector<std::string> read_names(const mxArray* given) {
  std::vector<std::string> names;
  for (const mxArray* const cell : read_cells(given)) names.push_back(read_text(cell));
  return names;
}

// What was compiled in must be of the same definition as the class.
void check_names(const TypedObject& compiled, const std::vector<std::string>& names) {
  bool is_same = compiled.members.size() == names.size();
  for (std::size_t i = 0; is_same && i < names.size(); ++i) {
    is_same = compiled.members[i].name == names[i];
  }
  if (is_same) return;
  throw Error(ErrorCode::invalid_operation, "the MEX file was built for another definition of `" +
                                                std::string(compiled.name) + "`: build it again");
}

// typed(object, class, names): number of the same object, with the members of the class
void typed(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const std::string name = call.text(1);
  std::vector<std::string> names = read_names(call[2]);
  check_class(*object, name);
  std::shared_ptr<Stub> stub;
  std::span<const TypedMember> members;
  const TypedObject* const compiled = find_class(runtime, name);
  if (compiled != nullptr) {
    check_names(*compiled, names);
    stub = make_stub_beside(object->object().stub(), compiled->type());
    members = compiled->members;
  }
  call.give(give_handle(
      runtime, std::make_shared<TypedHandle>(*object, std::move(names), std::move(stub), members)));
}

// member(object, name, arguments...): a property's value, a function's result; a property with an
// argument is set
void member(Runtime& runtime, Call& call) {
  const auto object = runtime.handles().get<TypedHandle>(call.handle(0));
  runtime.current = object->connection();
  if (!mxIsChar(call[1])) {
    throw Error(ErrorCode::invalid_operation,
                "the class was generated for another version of the toolbox: run robdef again");
  }
  const std::string name = call.text(1);
  const TypedMember* const typed = object->typed(name);
  if (typed != nullptr && runtime.may_block()) {
    RunningCall running(runtime);
    try {
      if (mxArray* const result = typed->run(object->stub(), call.rest(2), running)) {
        call.give(result);
      }
      return;
    } catch (const Misfit&) {
      if (running.has_begun()) throw;
    }
  }
  const auto given = call.rest(2);
  if (!given.empty() && object->resolve(name).use == Use::get) {
    return assign_member(runtime, *object, name, given[0]);
  }
  const Accessed accessed = access_member(runtime, *object, name, {given.begin(), given.end()});
  if (accessed.kind != Given::nothing) call.give(accessed.value);
}

}  // namespace

std::vector<Command> typed_commands() { return {{"typed", typed}, {"member", member}}; }

}  // namespace rr::matlab
