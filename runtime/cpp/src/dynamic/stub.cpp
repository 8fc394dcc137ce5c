// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/dynamic/stub.hpp"

#include "rr/error.hpp"

namespace rr::dynamic {
namespace {

std::string parameters_text(const MemberTable& member) {
  std::string text;
  for (const auto& [name, type] : member.parameters) {
    text += (text.empty() ? "" : ", ") + type->text() + " " + name;
  }
  return text;
}

// Of what gives nothing.
class EmptyCompletion final : public Completion {
 public:
  explicit EmptyCompletion(Done<> done) : done_(std::move(done)) {}
  void* result() override { return nullptr; }
  void succeed() override { done_(nullptr); }
  void fail(std::exception_ptr error) override { done_(std::move(error)); }

 private:
  Done<> done_;
};

class ValueCompletion final : public Completion {
 public:
  explicit ValueCompletion(Done<Value> done) : done_(std::move(done)) {}
  void* result() override { return &value_; }
  void succeed() override { done_(nullptr, std::move(value_)); }
  void fail(std::exception_ptr error) override { done_(std::move(error), Value()); }

 private:
  Value value_;
  Done<Value> done_;
};

}  // namespace

std::string subject_of(std::string_view member) { return "member " + std::string(member); }

Value convert_for(const MemberDescription& member, const Value& value) {
  return member.type.convert(value, subject_of(member.name));
}

ConvertedArguments::ConvertedArguments(const MemberTable& member, const List& arguments) {
  const std::size_t count = member.parameters.size();
  if (arguments.size() != count) {
    throw Error(ErrorCode::invalid_argument,
                subject_of(member.name) + ": expected " + std::to_string(count) +
                    (count == 1 ? " argument" : " arguments") +
                    (count == 0 ? "" : " (" + parameters_text(member) + ")") + ", got " +
                    std::to_string(arguments.size()));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [name, type] = member.parameters[i];
    const std::string subject = subject_of(member.name) + ", parameter " + name;
    values_.push_back(type->convert(arguments[i], Place(subject)));
  }
  for (const Value& value : values_) places_.push_back(&value);
  places_.push_back(nullptr);
}

List read_arguments(const Arguments& arguments, const Member& member) {
  return read_parameters(member, [&](void* const* places) { arguments.read(member, places); });
}

std::unique_ptr<Completion> complete_with(Done<Value> done) {
  return std::make_unique<ValueCompletion>(std::move(done));
}

std::unique_ptr<Completion> complete_with(Done<> done) {
  return std::make_unique<EmptyCompletion>(std::move(done));
}

}  // namespace rr::dynamic
