// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/objects.hpp"

#include <algorithm>

#include "rr/error.hpp"

namespace rr::matlab {

using dynamic::Value;

Connection::Connection(Runtime& runtime, dynamic::Client client,
                       std::shared_ptr<Listeners> listeners)
    : session_listeners(std::move(listeners)), runtime_(runtime), client_(std::move(client)) {}

Connection::~Connection() { close(); }

dynamic::Definitions Connection::types() const {
  if (client_.rr_session()) return client_.types();
  return any_object ? any_object->types() : dynamic::Definitions();
}

// The session's end waits for functions that run: they must not wait for this thread.
void Connection::close() {
  *has_events = false;
  const std::vector<std::uint64_t> functions = std::exchange(functions_, {});
  for (const std::uint64_t function : functions) end(function);
  callbacks.clear();
  if (client_.rr_session()) client_.close();
}

std::uint64_t Connection::add(UserFunction function) {
  functions_.push_back(runtime_.functions().add(std::move(function)));
  return functions_.back();
}

void Connection::remove(std::uint64_t function) {
  std::erase(functions_, function);
  end(function);
}

void Connection::end(std::uint64_t function) {
  runtime_.functions().close(function);
  runtime_.queue()->abort_calls(function);
  runtime_.functions().remove(function);
}

namespace {

Use use_of(const dynamic::MemberDescription& member) {
  switch (member.kind) {
    case MemberKind::property:
      return Use::get;
    case MemberKind::function:
      return member.generator == GeneratorForm::none ? Use::call : Use::generate;
    case MemberKind::event:
      return Use::event;
    case MemberKind::objref:
      return Use::object;
    case MemberKind::pipe:
      return Use::pipe;
    case MemberKind::callback:
      return Use::callback;
    case MemberKind::wire:
      return Use::wire;
    case MemberKind::memory:
      break;
  }
  return Use::memory;
}

}  // namespace

Resolved ObjectHandle::look_up(const std::string& name) const {
  const auto find = [&](const std::string& wanted, Resolved& found) {
    try {
      found.member = object_.member(wanted);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::member_not_found) return false;
      throw;
    }
    found.use = use_of(found.member);
    return true;
  };
  Resolved found;
  if (find(name, found)) return found;
  const std::string rest = name.size() > 4 ? name.substr(4) : "";
  if (name.starts_with("get_") && find(rest, found) && found.use != Use::call &&
      found.use != Use::generate) {
    return found;
  }
  if (name.starts_with("set_") && find(rest, found) && found.use == Use::get) {
    found.use = Use::set;
    return found;
  }
  found.member = object_.member(name);  // throws, with the name that the user has written
  return found;
}

const Resolved& ObjectHandle::resolve(const std::string& name) {
  const auto known = resolved_.find(name);
  if (known != resolved_.end()) return known->second;
  Resolved found = look_up(name);
  found.subject = "member " + found.member.name;
  found.plan = connection_->plans.plan(found.member.type);
  for (const auto& parameter : found.member.parameters) {
    found.parameters.push_back(connection_->plans.plan(parameter.type));
  }
  return resolved_.emplace(name, std::move(found)).first->second;
}

std::shared_ptr<ObjectHandle> object_of(Runtime& runtime, Call& call, std::size_t index) {
  auto object = runtime.handles().get<ObjectHandle>(call.handle(index));
  runtime.current = object->connection();
  return object;
}

Value read_value(const ObjectHandle& object, const mxArray* given, const TypePlan* plan,
                 const std::string& subject) {
  if (plan == nullptr) return {};
  return as_subject(
      subject, [&] { return from_mex(given, *plan, object.context(object.object().types())); });
}

dynamic::List read_arguments(const ObjectHandle& object, const Resolved& member,
                             const std::vector<const mxArray*>& given) {
  dynamic::List arguments;
  for (std::size_t i = 0; i < given.size(); ++i) {
    // What is too much is refused by the runtime, which says what the parameters are.
    if (i >= member.parameters.size()) {
      arguments.emplace_back();
      continue;
    }
    arguments.push_back(
        read_value(object, given[i], member.parameters[i],
                   member.subject + ", parameter " + member.member.parameters[i].name));
  }
  return arguments;
}

mxArray* varvalue_to_mex(const Value& value, Connection& connection) {
  const dynamic::ValueType type = connection.types().type("varvalue");
  return to_mex(value, *connection.plans.plan(type), connection.plans);
}

const mxArray* need_function(const mxArray* given, const std::string& subject) {
  if (mxIsClass(given, "function_handle") || mxIsChar(given)) return given;
  throw Error(ErrorCode::data_type_mismatch,
              subject + ": expected a function handle, got " + described(given));
}

mxArray* give_handle(Runtime& runtime, std::shared_ptr<Handled> handled) {
  return make_number<std::uint64_t>(runtime.handles().add(std::move(handled)));
}

mxArray* give_object(Runtime& runtime, std::shared_ptr<Connection> connection,
                     dynamic::Object object) {
  return give_handle(runtime,
                     std::make_shared<ObjectHandle>(std::move(connection), std::move(object)));
}

mxArray* wrap_object(mxArray* number) { return call_function("RobotRaconteurObject", {number}); }

std::vector<mxArray*> write_arguments(const dynamic::MemberDescription& member,
                                      const dynamic::List& arguments, Connection& connection) {
  std::vector<mxArray*> given;
  for (std::size_t i = 0; i < arguments.size() && i < member.parameters.size(); ++i) {
    given.push_back(
        to_mex(arguments[i], *connection.plans.plan(member.parameters[i].type), connection.plans));
  }
  return given;
}

Value run_callback(Runtime& runtime, const PendingCall& call) {
  const UserFunction* const function = runtime.functions().find(call.slot());
  const auto connection = function != nullptr ? function->connection.lock() : nullptr;
  if (!connection) throw Error(ErrorCode::operation_aborted, "the client's function is gone");
  const dynamic::MemberDescription member = function->member;
  const TypePlan* const plan = connection->plans.plan(member.type);
  const auto outcome = UserFunctions::run(
      function->function, write_arguments(member, call.arguments(), *connection), plan != nullptr);
  if (outcome.failure) throw runtime.error_of_failure(*outcome.failure);
  if (plan == nullptr) return {};
  const std::string subject = "member " + member.name + ", result";
  if (outcome.result == nullptr) {
    throw Error(ErrorCode::data_type_mismatch, subject + ": the function gave none");
  }
  return as_subject(subject, [&] {
    return from_mex(outcome.result, *plan, {connection->plans, connection->types()});
  });
}

}  // namespace rr::matlab
