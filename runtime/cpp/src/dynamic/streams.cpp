// SPDX-License-Identifier: Apache-2.0
// Wires, pipes, callbacks and generators.
#include "rr/error.hpp"
#include "runtime/cpp/src/dynamic/stub.hpp"

namespace rr::dynamic {
namespace {

// The runtime's own member, of which the parts that start requests are for classes like this.
class WireRequests final : public rr::Wire<Value> {
 public:
  using rr::Wire<Value>::Wire;
  using WireMember::start_connect;
  using WireMember::start_peek;
  using WireMember::start_poke;
};

class PipeRequests final : public rr::Pipe<Value> {
 public:
  using rr::Pipe<Value>::Pipe;
  using PipeMember::start_connect;
  using PipeMember::start_lock_check;
};

WireRequests requests(const std::shared_ptr<DynamicStub>& stub, const MemberTable& member) {
  return {*stub, stub->wire(member)};
}

void start_peek(const std::shared_ptr<DynamicStub>& stub, const MemberTable& member, bool of_out,
                Done<Timed<Value>> done) {
  using Peeked = DoneCompletion<Timed<Value>, Timed<Value>>;
  auto completion = std::make_unique<Peeked>(
      std::move(done),
      [](Timed<Value>& value, const Done<Timed<Value>>& end) { end(nullptr, std::move(value)); });
  Timed<Value>& place = completion->raw();
  requests(stub, member).start_peek(of_out, &place.value, &place.time, std::move(completion));
}

// The program's function behind a callback.
class CalledBack final : public CallbackFunction {
 public:
  CalledBack(const Member& member, ValueType type, Function<Value(const List&)> function)
      : CallbackFunction(member), type_(std::move(type)), function_(std::move(function)) {}
  std::shared_ptr<const void> call(const Arguments& arguments) override {
    Value result = function_(read_arguments(arguments, member()));
    if (type_.kind() == Kind::null) return nullptr;
    return std::make_shared<const Value>(
        type_.convert(result, subject_of(member().name) + ", result"));
  }

 private:
  const ValueType type_;
  const Function<Value(const List&)> function_;
};

class CallbackRequests final : public CallbackMember {
 public:
  CallbackRequests(Stub& stub, const Member& member) : CallbackMember(stub, member) {}
  using CallbackMember::set_function;
};

class Step final : public GeneratorStep {
 public:
  explicit Step(bool gives, Done<std::optional<Value>> done)
      : gives_(gives), done_(std::move(done)) {}
  void* result() override { return gives_ ? &value_ : nullptr; }
  void succeed() override { done_(nullptr, std::optional<Value>(std::move(value_))); }
  void stop() override { done_(nullptr, std::nullopt); }
  void fail(std::exception_ptr error) override { done_(std::move(error), std::nullopt); }

 private:
  const bool gives_;
  Value value_;
  Done<std::optional<Value>> done_;
};

bool takes(const MemberDescription& member) { return member.generator != GeneratorForm::returns; }
bool gives(const MemberDescription& member) { return member.generator != GeneratorForm::takes; }

}  // namespace

Wire::Wire(std::shared_ptr<DynamicStub> stub, const MemberTable& member)
    : stub_(std::move(stub)), member_(&member) {}

WireConnection Wire::connect() const {
  return {requests(stub_, *member_).connect(), stub_->describe(*member_)};
}
Timed<Value> Wire::peek_in() const { return requests(stub_, *member_).peek_in(); }
Timed<Value> Wire::peek_out() const { return requests(stub_, *member_).peek_out(); }

void Wire::poke_out(const Value& value) const {
  requests(stub_, *member_).poke_out(convert_for(stub_->describe(*member_), value));
}

void Wire::async_connect(Done<WireConnection> done) const {
  using Connected = DoneCompletion<WireEnd, WireConnection>;
  auto completion = std::make_unique<Connected>(
      std::move(done),
      [member = stub_->describe(*member_)](WireEnd& end, const Done<WireConnection>& finish) {
        finish(nullptr, WireConnection(rr::WireConnection<Value>(std::move(end)), member));
      });
  WireEnd& end = completion->raw();
  requests(stub_, *member_).start_connect(&end, std::move(completion));
}

void Wire::async_peek_in(Done<Timed<Value>> done) const {
  start_peek(stub_, *member_, false, std::move(done));
}

void Wire::async_peek_out(Done<Timed<Value>> done) const {
  start_peek(stub_, *member_, true, std::move(done));
}

void Wire::async_poke_out(const Value& value, Done<> done) const {
  const Value converted = convert_for(stub_->describe(*member_), value);
  requests(stub_, *member_).start_poke(&converted, complete_with(std::move(done)));
}

WireConnection::WireConnection(rr::WireConnection<Value> end, MemberDescription member)
    : rr::WireConnection<Value>(std::move(end)), member_(std::move(member)) {}

void WireConnection::set_out(const Value& value) {
  rr::WireConnection<Value>::set_out(convert_for(member_, value));
}

Pipe::Pipe(std::shared_ptr<DynamicStub> stub, const MemberTable& member)
    : stub_(std::move(stub)), member_(&member) {}

PipeEndpoint Pipe::connect(const PipeOptions& options) const {
  return {PipeRequests(*stub_, stub_->wire(*member_)).connect(options), stub_->describe(*member_)};
}

void Pipe::async_connect(Done<PipeEndpoint> done, const PipeOptions& options) const {
  using Connected = DoneCompletion<PipeEnd, PipeEndpoint>;
  PipeRequests(*stub_, stub_->wire(*member_))
      .start_connect(
          options,
          std::make_unique<Connected>(
              std::move(done),
              [member = stub_->describe(*member_)](PipeEnd& end, const Done<PipeEndpoint>& finish) {
                finish(nullptr, PipeEndpoint(rr::PipeEndpoint<Value>(std::move(end)), member));
              }));
}

void Pipe::async_check_lock(Done<> done) const {
  PipeRequests(*stub_, stub_->wire(*member_)).start_lock_check(complete_with(std::move(done)));
}

PipeEndpoint::PipeEndpoint(rr::PipeEndpoint<Value> end, MemberDescription member)
    : rr::PipeEndpoint<Value>(std::move(end)), member_(std::move(member)) {}

std::uint32_t PipeEndpoint::send(const Value& packet) {
  return rr::PipeEndpoint<Value>::send(convert_for(member_, packet));
}

Callback::Callback(std::shared_ptr<DynamicStub> stub, const MemberTable& member)
    : stub_(std::move(stub)), member_(&member) {}

void Callback::set(Function<Value(const List&)> function) const {
  const Member& wire = stub_->wire(*member_);
  CallbackRequests(*stub_, wire)
      .set_function(
          std::make_unique<CalledBack>(wire, stub_->describe(*member_).type, std::move(function)));
}

void Callback::clear() const { CallbackRequests(*stub_, stub_->wire(*member_)).clear(); }

Generator::Generator(std::shared_ptr<GeneratorState> state, MemberDescription member)
    : GeneratorHandle(std::move(state)), member_(std::move(member)) {}

Value Generator::convert(const Value& parameter) const {
  if (takes(member_)) {
    return member_.generator_parameter.convert(parameter, subject_of(member_.name));
  }
  if (parameter.is_null()) return parameter;
  throw Error(ErrorCode::invalid_argument, subject_of(member_.name) + ": its steps take no value");
}

std::optional<Value> Generator::next(const Value& parameter) {
  const Value given = convert(parameter);
  Value result;
  if (!step(takes(member_) ? &given : nullptr, gives(member_) ? &result : nullptr)) {
    return std::nullopt;
  }
  return result;
}

void Generator::async_next(const Value& parameter, Done<std::optional<Value>> done) {
  const Value given = convert(parameter);
  start_step(state_, takes(member_) ? &given : nullptr,
             std::make_unique<Step>(gives(member_), std::move(done)));
}

void Generator::async_close(Done<> done) {
  start_end(state_, false, complete_with(std::move(done)));
}
void Generator::async_abort(Done<> done) {
  start_end(state_, true, complete_with(std::move(done)));
}

}  // namespace rr::dynamic
