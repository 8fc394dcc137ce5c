// SPDX-License-Identifier: Apache-2.0
// Requests of clients, which the functions of the program answer.
#include "runtime/cpp/src/dynamic/skeleton.hpp"

#include <algorithm>

#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/stub.hpp"

namespace rr::dynamic {
namespace {

std::string result_of(const MemberTable& member) { return subject_of(member.name) + ", result"; }

List arguments_of(const Request& request, const Member& member) {
  return read_parameters(member, [&](void* const* places) { request.read_arguments(places); });
}

// Starts what is answered later. What has been thrown is the answer, unless there is one.
template <class Start>
void start(const Reply& reply, const Start& start) {
  try {
    start(reply);
  } catch (...) {
    try {
      reply.fail(std::current_exception());
    } catch (const Error&) {
      return;
    }
  }
}

// The steps of a program's generator, in the types that the member is declared with.
class TypedSteps final : public GeneratorSource {
 public:
  TypedSteps(std::shared_ptr<GeneratorSource> steps, const MemberTable& member)
      : steps_(std::move(steps)), member_(member) {}

  bool rr_step(const void* parameter, void* result) override {
    const Value nothing;
    Value given;
    if (!steps_->rr_step(parameter != nullptr ? parameter : &nothing, &given)) return false;
    if (result != nullptr) {
      *static_cast<Value*>(result) = member_.type->convert(given, Place(result_of(member_)));
    }
    return true;
  }
  void rr_close() override { steps_->rr_close(); }
  void rr_abort() override { steps_->rr_abort(); }

 private:
  const std::shared_ptr<GeneratorSource> steps_;
  const MemberTable& member_;  // its object lives as long
};

// A function that is called for each step.
class SteppingFunction final : public GeneratorSource {
 public:
  SteppingFunction(Function<std::optional<Value>(const Value&)> step, Function<void(bool)> end)
      : step_(std::move(step)), end_(std::move(end)) {}

  bool rr_step(const void* parameter, void* result) override {
    std::optional<Value> given = step_(*static_cast<const Value*>(parameter));
    if (!given) return false;
    *static_cast<Value*>(result) = std::move(*given);
    return true;
  }
  void rr_close() override {
    if (end_) end_(false);
  }
  void rr_abort() override {
    if (end_) end_(true);
  }

 private:
  const Function<std::optional<Value>(const Value&)> step_;
  const Function<void(bool)> end_;
};

// Whether an object type is another, or implements it, by way of others too.
bool is_a(const Tables& tables, const ObjectType& type, std::string_view wanted, int depth = 0) {
  if (type.name == wanted) return true;
  if (depth > static_cast<int>(Limits::deepest)) return false;
  return std::any_of(
      type.implements.begin(), type.implements.end(), [&](std::string_view implemented) {
        std::string name(implemented);
        if (name.find('.') == std::string::npos) {
          name = std::string(type.definition.name) + "." + name;
        }
        const ObjectTable* const table = tables.find_object(name);
        return name == wanted ||
               (table != nullptr && is_a(tables, *table->wire_type, wanted, depth + 1));
      });
}

}  // namespace

Reply::Reply(ReplyHandle handle, ValueType type, std::string subject)
    : handle_(std::make_shared<ReplyHandle>(std::move(handle))),
      type_(std::move(type)),
      subject_(std::move(subject)) {}

void Reply::operator()(const Value& value) const {
  if (type_.kind() == Kind::null) {
    rr::Reply<void>(std::move(*handle_))();
    return;
  }
  const Value converted = type_.convert(value, subject_);
  rr::Reply<Value>(std::move(*handle_))(converted);
}

void Reply::fail(std::exception_ptr error) const { handle_->fail(std::move(error)); }

Steps::Steps(Sequence<Value> values)
    : source_(std::move(values).source()), form_(GeneratorForm::returns) {}
Steps::Steps(Sequence<void, Value> values)
    : source_(std::move(values).source()), form_(GeneratorForm::takes) {}
Steps::Steps(Sequence<Value, Value> values)
    : source_(std::move(values).source()), form_(GeneratorForm::both) {}
Steps::Steps(Function<std::optional<Value>(const Value&)> step, Function<void(bool)> end)
    : source_(std::make_shared<SteppingFunction>(std::move(step), std::move(end))) {}

DynamicSkeleton::DynamicSkeleton(std::shared_ptr<const Tables> tables, const ObjectTable& table)
    : tables_(std::move(tables)),
      table_(table),
      functions_(table.members.size(), std::make_shared<const MemberFunctions>()),
      object_functions_(std::make_shared<const ObjectFunctions>()) {}

std::shared_ptr<const MemberFunctions> DynamicSkeleton::functions(const MemberTable& member) const {
  const MutexLock lock(mutex_);
  return functions_[place_of(member)];
}

std::shared_ptr<const ObjectFunctions> DynamicSkeleton::functions() const {
  const MutexLock lock(mutex_);
  return object_functions_;
}

void DynamicSkeleton::rr_attached(ServiceContext& context, const std::string& path) {
  const auto given = functions();
  if (given->attached) given->attached(context, path);
}

void DynamicSkeleton::rr_released(const std::string& path) {
  const auto given = functions();
  if (given->released) given->released(path);
}

void DynamicSkeleton::rr_dispatch(std::size_t place, Request& request) {
  const MemberTable& member = table_.members[place];
  const auto given = functions(member);
  if (wire(member).kind == MemberKind::function) {
    if (wire(member).generator != GeneratorForm::none) {
      answer_generator(member, *given, request);
    } else {
      answer_call(member, *given, request);
    }
  } else if (request.is_set()) {
    answer_set(member, *given, request);
  } else {
    answer_get(member, *given, request);
  }
}

void DynamicSkeleton::answer_get(const MemberTable& member, const MemberFunctions& given,
                                 Request& request) const {
  if (given.get_later) {
    start(Reply(request.defer(), tables_->handle(member.type), subject_of(member.name)),
          given.get_later);
    return;
  }
  if (!given.get) throw_not_implemented(subject_of(member.name));
  const Value value = member.type->convert(given.get(), Place(subject_of(member.name)));
  request.answer(&value);
}

void DynamicSkeleton::answer_set(const MemberTable& member, const MemberFunctions& given,
                                 Request& request) const {
  if (!given.set && !given.set_later) throw_not_implemented(subject_of(member.name));
  Value value;
  request.read_value(&value);
  if (given.set_later) {
    start(Reply(request.defer(), {}, {}),
          [&](const Reply& reply) { given.set_later(value, reply); });
    return;
  }
  given.set(value);
  request.answer(nullptr);
}

void DynamicSkeleton::answer_call(const MemberTable& member, const MemberFunctions& given,
                                  Request& request) const {
  if (!given.call && !given.call_later) throw_not_implemented(subject_of(member.name));
  const List arguments = arguments_of(request, wire(member));
  if (given.call_later) {
    start(Reply(request.defer(), tables_->handle(member.type), result_of(member)),
          [&](const Reply& reply) { given.call_later(arguments, reply); });
    return;
  }
  const Value result = given.call(arguments);
  if (member.type == nullptr) {
    request.answer(nullptr);
    return;
  }
  const Value converted = member.type->convert(result, Place(result_of(member)));
  request.answer(&converted);
}

void DynamicSkeleton::answer_generator(const MemberTable& member, const MemberFunctions& given,
                                       Request& request) const {
  if (!given.generate) throw_not_implemented(subject_of(member.name));
  const Steps steps = given.generate(arguments_of(request, wire(member)));
  if (steps.form() != GeneratorForm::none && steps.form() != wire(member).generator) {
    throw Error(ErrorCode::invalid_operation,
                subject_of(member.name) + ": its steps give or take otherwise than declared");
  }
  request.answer_generator(std::make_shared<TypedSteps>(steps.source(), member),
                           member.type != nullptr ? &holding_of<Value> : nullptr,
                           member.generator_parameter != nullptr ? &holding_of<Value> : nullptr);
}

std::shared_ptr<Skeleton> DynamicSkeleton::rr_child(std::size_t place, const ObjectIndex& index) {
  const MemberTable& member = table_.members[place];
  const auto given = functions(member);
  if (!given->object) throw_no_object(subject_of(member.name));
  Value value;
  if (wire(member).index == IndexForm::int32) value = index.number;
  if (wire(member).index == IndexForm::string) value = index.text;
  std::shared_ptr<Skeleton> child = given->object(value);
  if (!child) return nullptr;
  const ObjectType& type = child->rr_object_type();
  const auto* const own = dynamic_cast<const DynamicSkeleton*>(child.get());
  if (own != nullptr && own->tables() != tables_) {
    throw Error(ErrorCode::invalid_operation,
                subject_of(member.name) + ": the object is one of other definitions");
  }
  if (!member.object_type.empty() && !is_a(*tables_, type, member.object_type)) {
    throw Error(ErrorCode::invalid_operation, subject_of(member.name) + ": expected a `" +
                                                  member.object_type + "`, got a `" +
                                                  std::string(type.name) + "`");
  }
  return child;
}

std::shared_ptr<MemorySource> DynamicSkeleton::rr_memory(std::size_t place) {
  return functions(table_.members[place])->memory;
}

bool DynamicSkeleton::rr_has_monitor() const {
  return static_cast<bool>(functions()->enter_monitor);
}

bool DynamicSkeleton::rr_monitor_enter(std::chrono::milliseconds timeout) {
  return functions()->enter_monitor(timeout);
}

void DynamicSkeleton::rr_monitor_exit() { functions()->exit_monitor(); }

}  // namespace rr::dynamic
