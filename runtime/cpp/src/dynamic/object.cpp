// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/members.hpp"
#include "runtime/cpp/src/dynamic/stub.hpp"

namespace rr::dynamic {
namespace {

void check_index(const MemberTable& table, const Member& member, IndexForm given) {
  if (member.index == given) return;
  const char* const expected = member.index == IndexForm::none    ? "no index"
                               : member.index == IndexForm::int32 ? "an index of type int32"
                                                                  : "an index of type string";
  const char* const got = given == IndexForm::none    ? "none"
                          : given == IndexForm::int32 ? "int32"
                                                      : "string";
  throw Error(ErrorCode::invalid_argument,
              subject_of(table.name) + ": expected " + expected + ", got " + got);
}

class Listener final : public EventHandler {
 public:
  Listener(const Member& member, Function<void(const List&)> function)
      : EventHandler(member), function_(std::move(function)) {}
  void call(const Arguments& arguments) override { function_(read_arguments(arguments, member())); }

 private:
  Function<void(const List&)> function_;
};

}  // namespace

const std::string& Object::path() const { return stub_->rr_path(); }
const std::string& Object::type_name() const { return stub_->table().name; }
const std::string& Object::documentation() const { return stub_->table().documentation; }
Stub& Object::stub() const { return *stub_; }
std::shared_ptr<Stub> Object::shared_stub() const { return stub_; }

Object Object::of(const std::shared_ptr<Stub>& stub) {
  auto own = std::dynamic_pointer_cast<DynamicStub>(stub);
  if (!own) throw Error(ErrorCode::invalid_argument, "the stub is one of generated code");
  return Object(std::move(own));
}

Definitions Object::types() const { return Definitions(stub_->table().tables->shared_from_this()); }

std::vector<MemberDescription> Object::members() const { return describe_members(stub_->table()); }

MemberDescription Object::member(std::string_view name) const {
  return describe_member(stub_->table(), name);
}

const MemberTable& Object::need(std::string_view name, MemberKind kind) const {
  return need_member(stub_->table(), name, kind);
}

const MemberTable& Object::need_function(std::string_view name, bool is_generator) const {
  return dynamic::need_function(stub_->table(), name, is_generator);
}

Value Object::get(std::string_view property) const {
  const MemberTable& member = need(property, MemberKind::property);
  Value value;
  stub_->rr_get(stub_->wire(member), {}, &value);
  return value;
}

void Object::set(std::string_view property, const Value& value) const {
  const MemberTable& member = need(property, MemberKind::property);
  const Value converted = member.type->convert(value, Place(subject_of(member.name)));
  stub_->rr_set(stub_->wire(member), {}, &converted);
}

Value Object::call(std::string_view function, const List& arguments) const {
  const MemberTable& member = need_function(function, false);
  const ConvertedArguments converted(member, arguments);
  Value result;
  stub_->rr_invoke(stub_->wire(member), {}, converted.places(), &result);
  return result;
}

Generator Object::generate(std::string_view function, const List& arguments) const {
  const MemberTable& member = need_function(function, true);
  const ConvertedArguments converted(member, arguments);
  return {stub_->rr_open_generator(stub_->wire(member), converted.places()),
          stub_->describe(member)};
}

Object Object::object(std::string_view objref) const {
  const MemberTable& member = need(objref, MemberKind::objref);
  check_index(member, stub_->wire(member), IndexForm::none);
  return Object::of(stub_->rr_find(stub_->wire(member), {}));
}

Object Object::object(std::string_view objref, std::int32_t index) const {
  const MemberTable& member = need(objref, MemberKind::objref);
  check_index(member, stub_->wire(member), IndexForm::int32);
  return Object::of(stub_->rr_find(stub_->wire(member), {}, index));
}

Object Object::object(std::string_view objref, std::string_view index) const {
  const MemberTable& member = need(objref, MemberKind::objref);
  check_index(member, stub_->wire(member), IndexForm::string);
  return Object::of(stub_->rr_find(stub_->wire(member), {}, index));
}

Subscription Object::on_event(std::string_view event, Function<void(const List&)> function) const {
  const Member& member = stub_->wire(need(event, MemberKind::event));
  return stub_->rr_connect(member, std::make_unique<Listener>(member, std::move(function)));
}

Wire Object::wire(std::string_view name) const { return {stub_, need(name, MemberKind::wire)}; }
Pipe Object::pipe(std::string_view name) const { return {stub_, need(name, MemberKind::pipe)}; }
Memory Object::memory(std::string_view name) const {
  return {stub_, need(name, MemberKind::memory)};
}
Callback Object::callback(std::string_view name) const {
  return {stub_, need(name, MemberKind::callback)};
}

void Object::async_get(std::string_view property, Done<Value> done) const {
  const MemberTable& member = need(property, MemberKind::property);
  stub_->rr_start(stub_->wire(member), false, nullptr, complete_with(std::move(done)));
}

void Object::async_set(std::string_view property, const Value& value, Done<> done) const {
  const MemberTable& member = need(property, MemberKind::property);
  const Value converted = member.type->convert(value, Place(subject_of(member.name)));
  const void* const place = &converted;
  stub_->rr_start(stub_->wire(member), true, &place, complete_with(std::move(done)));
}

void Object::async_call(std::string_view function, const List& arguments, Done<Value> done) const {
  const MemberTable& member = need_function(function, false);
  const ConvertedArguments converted(member, arguments);
  stub_->rr_start(stub_->wire(member), false, converted.places(), complete_with(std::move(done)));
}

void Object::async_generate(std::string_view function, const List& arguments,
                            Done<Generator> done) const {
  using Opened = DoneCompletion<std::shared_ptr<GeneratorState>, Generator>;
  const MemberTable& member = need_function(function, true);
  const ConvertedArguments converted(member, arguments);
  stub_->rr_start_generator(
      stub_->wire(member), converted.places(),
      std::make_unique<Opened>(
          std::move(done), [description = stub_->describe(member)](
                               std::shared_ptr<GeneratorState>& state, const Done<Generator>& end) {
            end(nullptr, Generator(std::move(state), description));
          }));
}

void Object::async_object(std::string_view objref, const Value& index, Done<Object> done) const {
  using Found = DoneCompletion<std::shared_ptr<Stub>, Object>;
  const MemberTable& table = need(objref, MemberKind::objref);
  const Member& member = stub_->wire(table);
  const IndexForm given = index.is_null()              ? IndexForm::none
                          : index.kind() == Kind::text ? IndexForm::string
                                                       : IndexForm::int32;
  check_index(table, member, given);
  auto completion = std::make_unique<Found>(
      std::move(done),
      [](std::shared_ptr<Stub>& stub, const Done<Object>& end) { end(nullptr, Object::of(stub)); });
  if (given == IndexForm::none) {
    stub_->rr_start_find(member, std::move(completion));
  } else if (given == IndexForm::int32) {
    stub_->rr_start_find(member, index.as<std::int32_t>(), std::move(completion));
  } else {
    stub_->rr_start_find(member, std::string_view(index.text()), std::move(completion));
  }
}

}  // namespace rr::dynamic
