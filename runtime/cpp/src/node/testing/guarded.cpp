// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/testing/guarded.hpp"

#include <string_view>

namespace rr::testing {
namespace {

constexpr std::string_view definition_text =
    "service test.guarded\n"
    "stdver 0.10\n"
    "object Guarded\n"
    "  property double value\n"
    "  function double run(string what)\n"
    "  function int32{generator} count()\n"
    "  event noticed(double value)\n"
    "  pipe double samples\n"
    "  wire double level\n"
    "  memory double[] store\n"
    "  callback double ask()\n"
    "  objref Guarded{string} child\n"
    "  objref Guarded own\n"
    "  property double free [nolock]\n"
    "end\n";

constexpr Parameter run_parameters[] = {parameter<std::string>("what")};
constexpr Parameter noticed_parameters[] = {parameter<double>("value")};
constexpr Member members[] = {
    property<double>("value"),
    function<double>("run", run_parameters),
    generator<std::int32_t, void>("count"),
    event("noticed", noticed_parameters),
    pipe<double>("samples"),
    wire<double>("level"),
    memory<Array<double>>("store"),
    callback<double>("ask"),
    objref("child", "test.guarded.Guarded", IndexForm::string),
    objref("own", "test.guarded.Guarded"),
    property<double>("free", nolock),
};
constexpr const ObjectType* objects[] = {&rr_Guarded};
constinit const Definition definition{"test.guarded", definition_text, {0, 10, 0, 0}, {}, {}, {},
                                      objects};

Sequence<std::int32_t> count() {
  for (std::int32_t value = 1;; ++value) co_yield value;
}

}  // namespace

constinit const ObjectType rr_Guarded{
    "test.guarded.Guarded", definition, {}, members, []() -> std::shared_ptr<Stub> {
      return std::make_shared<GuardedStub>();
    }};

Guarded::Guarded() {
  level().set_in(0.5);
  level().on_peek_out([] { return 2.5; });
  level().on_out([this](double, const TimeSpec&, std::uint32_t) { ++values; });
  samples().on_connect(
      [this](PipeEndpoint<double> end) { end.on_packet([this](double) { ++packets; }).detach(); });
}

void Guarded::rr_dispatch(std::size_t member, Request& request) {
  switch (member) {
    case guarded_value:
    case guarded_free:
      if (!request.is_set()) return request.answer(&value_);
      request.read_value(&value_);
      return request.answer(nullptr);
    case guarded_run: {
      std::string what;
      request.read(what);
      const double result = on_run ? on_run(what) : 1;
      return request.answer(&result);
    }
    case guarded_count:
      return request.answer(count());
    default:
      return;
  }
}

std::shared_ptr<Skeleton> Guarded::rr_child(std::size_t member, const ObjectIndex& /*index*/) {
  ++children;
  auto child = std::make_shared<Guarded>();
  last_child = child;
  return member == guarded_own ? per_client(child) : child;
}

User KnownUsers::authenticate(const std::string& name,
                              const std::map<std::string, VarValue>& credentials,
                              const NodeId& /*node*/) const {
  const auto password = credentials.find("password");
  const bool is_right = password != credentials.end() &&
                        password->second.get_if<std::string>() != nullptr &&
                        *password->second.get_if<std::string>() == name;
  if (!is_right) throw Error(ErrorCode::authentication_error, "Invalid username or password");
  if (name == "chief") return {name, {"operator", "objectlockoverride"}};
  if (name == "guest") return {name, {}};
  return {name, {"objectlock"}};
}

}  // namespace rr::testing
