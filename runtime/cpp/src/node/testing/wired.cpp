// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/testing/wired.hpp"

#include <cstddef>
#include <string_view>

namespace rr::testing {
namespace {

constexpr std::string_view definition_text =
    "service test.wired\n"
    "stdver 0.10\n"
    "object Wired\n"
    "  wire double level\n"
    "  wire string note\n"
    "  wire double[] trace\n"
    "  wire double reading [readonly]\n"
    "  wire double target [writeonly]\n"
    "  function void set_level(double value)\n"
    "  function void close_level()\n"
    "  objref Wired{string} child\n"
    "end\n";

enum Place : std::size_t {
  level_place,
  note_place,
  trace_place,
  reading_place,
  target_place,
  set_level_place,
  close_level_place,
  child_place,
};

constexpr Parameter set_level_parameters[] = {parameter<double>("value")};
constexpr Member members[] = {
    wire<double>("level"),
    wire<std::string>("note"),
    wire<Array<double>>("trace"),
    wire<double>("reading", readonly),
    wire<double>("target", writeonly),
    function<void>("set_level", set_level_parameters),
    function<void>("close_level"),
    objref("child", "test.wired.Wired", IndexForm::string),
};
constexpr const ObjectType* objects[] = {&rr_Wired};
constinit const Definition definition{"test.wired", definition_text, {0, 10, 0, 0}, {}, {},
                                      {},           objects};

std::shared_ptr<Stub> make() { return std::make_shared<WiredStub>(); }

}  // namespace

constinit const ObjectType rr_Wired{"test.wired.Wired", definition, {}, members, &make};

const ObjectType& WiredStub::rr_object_type() const { return rr_Wired; }
Wire<double> WiredStub::level() { return {*this, members[level_place]}; }
Wire<std::string> WiredStub::note() { return {*this, members[note_place]}; }
Wire<Array<double>> WiredStub::trace() { return {*this, members[trace_place]}; }
Wire<double> WiredStub::reading() { return {*this, members[reading_place]}; }
Wire<double> WiredStub::target() { return {*this, members[target_place]}; }
void WiredStub::set_level(double value) { rr_call<void>(members[set_level_place], {}, value); }
void WiredStub::close_level() { rr_call<void>(members[close_level_place], {}); }
std::shared_ptr<WiredStub> WiredStub::get_child(const std::string& index) {
  return rr_find_as<WiredStub>(members[child_place], {}, index);
}

const ObjectType& Wired::rr_object_type() const { return rr_Wired; }
WireServer<double> Wired::level() const { return {*this, members[level_place]}; }
WireServer<std::string> Wired::note() const { return {*this, members[note_place]}; }
WireServer<Array<double>> Wired::trace() const { return {*this, members[trace_place]}; }
WireServer<double> Wired::reading() const { return {*this, members[reading_place]}; }
WireServer<double> Wired::target() const { return {*this, members[target_place]}; }

void Wired::rr_dispatch(std::size_t member, Request& request) {
  if (member == close_level_place) {
    for (ServedWire<double>& connection : level().connections()) connection.close();
    return;
  }
  double value = 0;
  request.read(value);
  level().set_in(value);
  if (on_set_level) on_set_level();
}

std::shared_ptr<Skeleton> Wired::rr_child(std::size_t /*member*/, const ObjectIndex& /*index*/) {
  if (!child) child = std::make_shared<Wired>();
  return child;
}

}  // namespace rr::testing
