// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rr/dynamic.hpp"
#include "rr/stub.hpp"
#include "runtime/cpp/src/dynamic/definition_tables.hpp"

namespace rr::dynamic {

/// The stub of an object of any type: what generated stubs use of their base, in the open.
class DynamicStub final : public Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return *type_; }
  void rr_take_object_type(const ObjectType& type) override {
    type_ = static_cast<const OwnedObjectType*>(&type);
  }
  [[nodiscard]] const ObjectTable& table() const { return *type_->table; }
  [[nodiscard]] const Member& wire(const MemberTable& member) const { return table().wire(member); }
  [[nodiscard]] MemberDescription describe(const MemberTable& member) const {
    return table().tables->describe(table(), member);
  }

  using Stub::rr_connect;
  using Stub::rr_find;
  using Stub::rr_get;
  using Stub::rr_invoke;
  using Stub::rr_open_generator;
  using Stub::rr_set;
  using Stub::rr_start;
  using Stub::rr_start_find;
  using Stub::rr_start_generator;

 private:
  const OwnedObjectType* type_ = nullptr;
};

/// `member pose`: what an error's text begins with.
std::string subject_of(std::string_view member);

/// A value as one of the member's type.
Value convert_for(const MemberDescription& member, const Value& value);

/// Arguments as the member's parameters are declared, in the form that stubs take.
class ConvertedArguments {
 public:
  ConvertedArguments(const MemberTable& member, const List& arguments);
  [[nodiscard]] const void* const* places() const { return places_.data(); }

 private:
  List values_;
  std::vector<const void*> places_;
};

/// The values of a member's parameters, which `read(places)` reads.
template <class Read>
List read_parameters(const Member& member, const Read& read) {
  List values(member.parameters.size());
  std::vector<void*> places;
  for (Value& value : values) places.push_back(&value);
  places.push_back(nullptr);
  read(places.data());
  return values;
}
/// Those of an event or callback.
List read_arguments(const Arguments& arguments, const Member& member);

/// Ends at a function of the program. The result is made to what the program gets by `finish`.
template <class Raw, class... Result>
class DoneCompletion final : public Completion {
 public:
  using Finish = Function<void(Raw&, const Done<Result...>&)>;
  DoneCompletion(Done<Result...> done, Finish finish)
      : done_(std::move(done)), finish_(std::move(finish)) {}
  [[nodiscard]] Raw& raw() { return raw_; }
  void* result() override { return &raw_; }
  void succeed() override {
    try {
      finish_(raw_, done_);
    } catch (...) {
      fail(std::current_exception());
    }
  }
  void fail(std::exception_ptr error) override { done_(std::move(error), Result{}...); }

 private:
  Raw raw_{};
  Done<Result...> done_;
  Finish finish_;
};

/// Of a call whose result is what the program gets.
std::unique_ptr<Completion> complete_with(Done<Value> done);
/// Of a call without a result.
std::unique_ptr<Completion> complete_with(Done<> done);

}  // namespace rr::dynamic
