// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/testing/counter.hpp"

#include <chrono>
#include <cstddef>
#include <thread>

namespace rr::testing {
namespace {

constexpr std::string_view definition_text =
    "service test.counter\n"
    "stdver 0.10\n"
    "exception Overrun\n"
    "struct Reading\n"
    "  field double value\n"
    "  field string label\n"
    "  field uint8[] picture\n"
    "end\n"
    "object Named\n"
    "  property string name [readonly]\n"
    "end\n"
    "object Counter\n"
    "  implements Named\n"
    "  property string name [readonly]\n"
    "  property double value\n"
    "  property double fixed [readonly]\n"
    "  property double hidden [writeonly]\n"
    "  function double add(double a, double b)\n"
    "  function void reset()\n"
    "  function string echo(string text)\n"
    "  function Reading read(string label)\n"
    "  function uint8[] blob(uint32 size)\n"
    "  function uint64 take(double[] numbers)\n"
    "  function void raise(int32 code, string text)\n"
    "  function void slow(int32 milliseconds)\n"
    "  function void fire(int32 count)\n"
    "  function varvalue any(varvalue value)\n"
    "  event ticked(int32 count, string text)\n"
    "  objref Counter child\n"
    "  objref Counter{int32} by_number\n"
    "  objref Counter{string} by_name\n"
    "  objref varobject anything\n"
    "end\n";

constexpr Field reading_fields[] = {
    field<double>("value", offsetof(Reading, value)),
    field<std::string>("label", offsetof(Reading, label)),
    field<Array<std::uint8_t>>("picture", offsetof(Reading, picture)),
};

constexpr Parameter add_parameters[] = {parameter<double>("a"), parameter<double>("b")};
constexpr Parameter echo_parameters[] = {parameter<std::string>("text")};
constexpr Parameter read_parameters[] = {parameter<std::string>("label")};
constexpr Parameter blob_parameters[] = {parameter<std::uint32_t>("size")};
constexpr Parameter take_parameters[] = {parameter<Array<double>>("numbers")};
constexpr Parameter raise_parameters[] = {parameter<std::int32_t>("code"),
                                          parameter<std::string>("text")};
constexpr Parameter slow_parameters[] = {parameter<std::int32_t>("milliseconds")};
constexpr Parameter fire_parameters[] = {parameter<std::int32_t>("count")};
constexpr Parameter any_parameters[] = {parameter<VarValue>("value")};
constexpr Parameter ticked_parameters[] = {parameter<std::int32_t>("count"),
                                           parameter<std::string>("text")};

enum Place : std::size_t {
  name_place,
  value_place,
  fixed_place,
  hidden_place,
  add_place,
  reset_place,
  echo_place,
  read_place,
  blob_place,
  take_place,
  raise_place,
  slow_place,
  fire_place,
  any_place,
  ticked_place,
  child_place,
  by_number_place,
  by_name_place,
  anything_place,
};

constexpr Member members[] = {
    property<std::string>("name", readonly),
    property<double>("value"),
    property<double>("fixed", readonly),
    property<double>("hidden", writeonly),
    function<double>("add", add_parameters),
    function<void>("reset"),
    function<std::string>("echo", echo_parameters),
    function<std::optional<Reading>>("read", read_parameters),
    function<Array<std::uint8_t>>("blob", blob_parameters),
    function<std::uint64_t>("take", take_parameters),
    function<void>("raise", raise_parameters),
    function<void>("slow", slow_parameters),
    function<void>("fire", fire_parameters),
    function<VarValue>("any", any_parameters),
    event("ticked", ticked_parameters),
    objref("child", "test.counter.Counter"),
    objref("by_number", "test.counter.Counter", IndexForm::int32),
    objref("by_name", "test.counter.Counter", IndexForm::string),
    objref("anything", ""),
};
constexpr Member named_members[] = {property<std::string>("name", readonly)};

constexpr std::string_view counter_implements[] = {"Named"};
constexpr ExceptionType exceptions[] = {
    {"test.counter.Overrun", [](const Error& error) { throw Overrun(error); }}};
constexpr const RecordType* records[] = {&rr_Reading};
constexpr const ObjectType* objects[] = {&rr_Named, &rr_Counter};

template <class S>
std::shared_ptr<Stub> make() {
  return std::make_shared<S>();
}

}  // namespace

constinit const RecordType rr_Reading{RecordKind::struct_, "test.counter.Reading", reading_fields,
                                      record_operations<Reading>};
constinit const ObjectType rr_Named{
    "test.counter.Named", rr_definition, {}, named_members, &make<NamedStub>};
constinit const ObjectType rr_Counter{"test.counter.Counter", rr_definition, counter_implements,
                                      members, &make<CounterStub>};
constinit const Definition rr_definition{"test.counter", definition_text, {0, 10, 0, 0}, {},
                                         records,        exceptions,      objects};

const ObjectType& NamedStub::rr_object_type() const { return rr_Named; }
std::string NamedStub::get_name() { return rr_get<std::string>(named_members[0], {}); }

CounterStub::CounterStub() : ticked_(*this, members[ticked_place]) {}
const ObjectType& CounterStub::rr_object_type() const { return rr_Counter; }
double CounterStub::get_value() { return rr_get<double>(members[value_place], {}); }
void CounterStub::set_value(double value) { rr_set(members[value_place], {}, &value); }
double CounterStub::get_fixed() { return rr_get<double>(members[fixed_place], {}); }
void CounterStub::set_hidden(double hidden) { rr_set(members[hidden_place], {}, &hidden); }
double CounterStub::add(double a, double b) {
  return rr_call<double>(members[add_place], {}, a, b);
}
void CounterStub::reset() { rr_call<void>(members[reset_place], {}); }
std::string CounterStub::echo(const std::string& text) {
  return rr_call<std::string>(members[echo_place], {}, text);
}
std::optional<Reading> CounterStub::read(const std::string& label) {
  return rr_call<std::optional<Reading>>(members[read_place], {}, label);
}
Array<std::uint8_t> CounterStub::blob(std::uint32_t size) {
  return rr_call<Array<std::uint8_t>>(members[blob_place], {}, size);
}
std::uint64_t CounterStub::take(const Array<double>& numbers) {
  return rr_call<std::uint64_t>(members[take_place], {}, numbers);
}
void CounterStub::raise(std::int32_t code, const std::string& text) {
  rr_call<void>(members[raise_place], {}, code, text);
}
void CounterStub::slow(std::int32_t milliseconds) {
  rr_call<void>(members[slow_place], {}, milliseconds);
}
void CounterStub::fire(std::int32_t count) { rr_call<void>(members[fire_place], {}, count); }
VarValue CounterStub::any(const VarValue& value) {
  return rr_call<VarValue>(members[any_place], {}, value);
}
std::shared_ptr<CounterStub> CounterStub::get_child() {
  return rr_find_as<CounterStub>(members[child_place], {});
}
std::shared_ptr<CounterStub> CounterStub::get_by_number(std::int32_t index) {
  return rr_find_as<CounterStub>(members[by_number_place], {}, index);
}
std::shared_ptr<CounterStub> CounterStub::get_by_name(const std::string& index) {
  return rr_find_as<CounterStub>(members[by_name_place], {}, index);
}
std::shared_ptr<Stub> CounterStub::get_anything() { return rr_find(members[anything_place], {}); }

const ObjectType& CounterSkeleton::rr_object_type() const { return rr_Counter; }

void CounterSkeleton::rr_dispatch(std::size_t member, Request& request) {
  const auto answer = [&](const auto& value) { request.answer(&value); };
  std::string text;
  switch (member) {
    case name_place:
      return answer(get_name());
    case value_place:
      if (request.is_set()) {
        double value = 0;
        request.read_value(&value);
        return set_value(value);
      }
      return answer(get_value());
    case fixed_place:
      return answer(get_fixed());
    case hidden_place: {
      double value = 0;
      request.read_value(&value);
      return set_hidden(value);
    }
    case add_place: {
      double a = 0;
      double b = 0;
      request.read(a, b);
      return answer(add(a, b));
    }
    case reset_place:
      return reset();
    case echo_place:
      request.read(text);
      return answer(echo(text));
    case read_place:
      request.read(text);
      return answer(read(text));
    case blob_place: {
      std::uint32_t size = 0;
      request.read(size);
      return answer(blob(size));
    }
    case take_place: {
      Array<double> numbers;
      request.read(numbers);
      return answer(take(numbers));
    }
    case raise_place: {
      std::int32_t code = 0;
      request.read(code, text);
      return raise(code, text);
    }
    case slow_place: {
      std::int32_t milliseconds = 0;
      request.read(milliseconds);
      return slow(Reply<void>(request.defer()), milliseconds);
    }
    case fire_place: {
      std::int32_t count = 0;
      request.read(count);
      return fire(count);
    }
    case any_place: {
      VarValue value;
      request.read(value);
      return answer(any(value));
    }
    default:
      return;
  }
}

std::shared_ptr<Skeleton> CounterSkeleton::rr_child(std::size_t member, const ObjectIndex& index) {
  switch (member) {
    case child_place:
      return get_child();
    case by_number_place:
      return get_by_number(index.number);
    case by_name_place:
      return get_by_name(std::string(index.text));
    case anything_place:
      return get_anything();
    default:
      return nullptr;
  }
}

void CounterSkeleton::rr_fire_ticked(std::int32_t count, const std::string& text) const {
  rr_fire_event(members[ticked_place], count, text);
}

double Counter::get_value() {
  const std::lock_guard lock(mutex_);
  return value_;
}

void Counter::set_value(double value) {
  const std::lock_guard lock(mutex_);
  value_ = value;
}

std::optional<Reading> Counter::read(const std::string& label) {
  if (label.empty()) return std::nullopt;
  return Reading{get_value(), label, {1, 2, 3}};
}

Array<std::uint8_t> Counter::blob(std::uint32_t size) {
  Array<std::uint8_t> bytes(size);
  const auto items = bytes.mutate();
  for (std::size_t i = 0; i < items.size(); ++i) items[i] = static_cast<std::uint8_t>(i * 31 + 7);
  return bytes;
}

void Counter::raise(std::int32_t code, const std::string& text) {
  if (code == 0) throw Overrun(text, "deep", Array<double>{0.5, -0.25});
  if (code == -1) throw std::runtime_error(text);
  throw Error(static_cast<ErrorCode>(code), text);
}

void Counter::slow(Reply<void> reply, std::int32_t milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  reply();
}

void Counter::fire(std::int32_t count) {
  for (std::int32_t i = 0; i < count; ++i) rr_fire_ticked(i, name_);
}

std::shared_ptr<Skeleton> Counter::get_child() { return std::make_shared<Counter>("child"); }

std::shared_ptr<Skeleton> Counter::get_by_number(std::int32_t index) {
  if (index == 99) throw Error(ErrorCode::invalid_argument, "no object with index 99");
  return std::make_shared<Counter>("number " + std::to_string(index));
}

std::shared_ptr<Skeleton> Counter::get_by_name(const std::string& index) {
  if (index == "null") return nullptr;
  return std::make_shared<Counter>("name " + index);
}

}  // namespace rr::testing
