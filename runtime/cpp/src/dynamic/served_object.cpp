// SPDX-License-Identifier: Apache-2.0
// Objects that services offer, as the program sees them; their streams and memories are in files of
// their own.
#include <set>
#include <utility>

#include "rr/error.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/dynamic/members.hpp"
#include "runtime/cpp/src/dynamic/skeleton.hpp"
#include "runtime/cpp/src/dynamic/stub.hpp"

namespace rr::dynamic {
namespace {

template <class Stored>
class StoredProperty final : public PropertyStore {
 public:
  explicit StoredProperty(const Value& first) : stored_(first) {}
  [[nodiscard]] Value get() const override { return stored_.get(); }
  void set(const Value& value) override { stored_.set(value); }

 private:
  Stored stored_;
};

std::shared_ptr<DynamicSkeleton> make_skeleton(const Definitions& definitions,
                                               std::string_view type) {
  const ObjectTable* const table = definitions.tables()->find_object(type);
  if (table == nullptr) {
    throw Error(ErrorCode::key_not_found, "no object `" + std::string(type) + "`");
  }
  return std::make_shared<DynamicSkeleton>(definitions.tables(), *table);
}

void add_with_imports(const Definition& definition, std::set<const Definition*>& all) {
  if (!all.insert(&definition).second) return;
  for (const Definition* const import : definition.imports) add_with_imports(*import, all);
}

const MemberTable& property_of(const DynamicSkeleton& object, std::string_view name) {
  return need_member(object.table(), name, MemberKind::property);
}

}  // namespace

ServedObject::ServedObject(const Definitions& definitions, std::string_view type)
    : skeleton_(make_skeleton(definitions, type)) {}

DynamicSkeleton& ServedObject::need() const {
  if (!skeleton_) throw Error(ErrorCode::invalid_operation, "there is no object");
  return *skeleton_;
}

std::shared_ptr<Skeleton> ServedObject::skeleton() const { return skeleton_; }
const std::string& ServedObject::type_name() const { return need().table().name; }
Definitions ServedObject::types() const { return Definitions(need().tables()); }

std::vector<MemberDescription> ServedObject::members() const {
  return describe_members(need().table());
}

MemberDescription ServedObject::member(std::string_view name) const {
  return describe_member(need().table(), name);
}

void ServedObject::store(std::string_view property, const Value& first) const {
  const MemberTable& member = property_of(need(), property);
  const Value value = member.type->convert(first, Place(subject_of(member.name)));
  std::shared_ptr<PropertyStore> store;
  if ((skeleton_->wire(member).access & perclient) != 0) {
    store = std::make_shared<StoredProperty<StoredPerClient<Value>>>(value);
  } else {
    store = std::make_shared<StoredProperty<Stored<Value>>>(value);
  }
  skeleton_->change(member, [&](MemberFunctions& functions) {
    functions.get = [store] { return store->get(); };
    functions.set = [store](const Value& given) { store->set(given); };
    functions.get_later = {};
    functions.set_later = {};
    functions.store = store;
  });
}

Value ServedObject::stored(std::string_view property) const {
  const MemberTable& member = property_of(need(), property);
  const auto functions = skeleton_->functions(member);
  if (functions->store) return functions->store->get();
  throw Error(ErrorCode::invalid_operation, subject_of(member.name) + ": it is not stored");
}

void ServedObject::on_get(std::string_view property, Function<Value()> function) const {
  need().change(property_of(*skeleton_, property), [&](MemberFunctions& functions) {
    functions.get = function;
    functions.get_later = {};
    functions.store = {};
  });
}

void ServedObject::on_get_later(std::string_view property, Function<void(Reply)> function) const {
  need().change(property_of(*skeleton_, property), [&](MemberFunctions& functions) {
    functions.get = {};
    functions.get_later = function;
    functions.store = {};
  });
}

void ServedObject::on_set(std::string_view property, Function<void(const Value&)> function) const {
  need().change(property_of(*skeleton_, property), [&](MemberFunctions& functions) {
    functions.set = function;
    functions.set_later = {};
  });
}

void ServedObject::on_set_later(std::string_view property,
                                Function<void(const Value&, Reply)> function) const {
  need().change(property_of(*skeleton_, property), [&](MemberFunctions& functions) {
    functions.set = {};
    functions.set_later = function;
  });
}

void ServedObject::on_call(std::string_view function, Function<Value(const List&)> handler) const {
  need().change(need_function(skeleton_->table(), function, false),
                [&](MemberFunctions& functions) {
                  functions.call = handler;
                  functions.call_later = {};
                });
}

void ServedObject::on_call_later(std::string_view function,
                                 Function<void(const List&, Reply)> handler) const {
  need().change(need_function(skeleton_->table(), function, false),
                [&](MemberFunctions& functions) {
                  functions.call = {};
                  functions.call_later = handler;
                });
}

void ServedObject::on_generate(std::string_view function,
                               Function<Steps(const List&)> handler) const {
  need().change(need_function(skeleton_->table(), function, true),
                [&](MemberFunctions& functions) { functions.generate = handler; });
}

void ServedObject::on_object(
    std::string_view objref,
    Function<std::shared_ptr<Skeleton>(const Value& index)> handler) const {
  need().change(need_member(skeleton_->table(), objref, MemberKind::objref),
                [&](MemberFunctions& functions) { functions.object = handler; });
}

void ServedObject::fire(std::string_view event, const List& arguments) const {
  const MemberTable& member = need_member(need().table(), event, MemberKind::event);
  skeleton_->rr_fire(skeleton_->wire(member), ConvertedArguments(member, arguments).places());
}

Value ServedObject::call_back(std::string_view callback, std::uint32_t client,
                              const List& arguments) const {
  const MemberTable& member = need_member(need().table(), callback, MemberKind::callback);
  const ConvertedArguments converted(member, arguments);
  Value result;
  skeleton_->rr_ask_client(skeleton_->wire(member), client, converted.places(), &result);
  return result;
}

void ServedObject::async_call_back(std::string_view callback, std::uint32_t client,
                                   const List& arguments, Done<Value> done) const {
  const MemberTable& member = need_member(need().table(), callback, MemberKind::callback);
  const ConvertedArguments converted(member, arguments);
  skeleton_->rr_start_asking(skeleton_->wire(member), client, converted.places(),
                             complete_with(std::move(done)));
}

void ServedObject::on_attached(
    Function<void(ServiceContext&, const std::string& path)> function) const {
  need().change([&](ObjectFunctions& functions) { functions.attached = function; });
}

void ServedObject::on_released(Function<void(const std::string& path)> function) const {
  need().change([&](ObjectFunctions& functions) { functions.released = function; });
}

void ServedObject::set_monitor(Function<bool(std::chrono::milliseconds)> enter,
                               Function<void()> exit) const {
  if (!enter || !exit) throw Error(ErrorCode::invalid_argument, "a monitor has two functions");
  need().change([&](ObjectFunctions& functions) {
    functions.enter_monitor = enter;
    functions.exit_monitor = exit;
  });
}

Service register_service(Node& node, std::string name, const ServedObject& root,
                         ServiceOptions options,
                         const std::optional<std::set<std::string>>& extra) {
  const std::shared_ptr<const Tables> tables = root.types().tables();
  std::set<const Definition*> imported;
  add_with_imports(root.skeleton()->rr_object_type().definition, imported);
  for (const auto& [service, definition] : tables->definitions()) {
    node.add_definition(std::shared_ptr<const Definition>(tables, &definition.wire));
    if (imported.contains(&definition.wire)) continue;
    if (!extra || extra->contains(std::string(definition.wire.name))) {
      options.extra_imports.push_back(&definition.wire);
    }
  }
  return node.register_service(std::move(name), root.skeleton(), std::move(options));
}

}  // namespace rr::dynamic
