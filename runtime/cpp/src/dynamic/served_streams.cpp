// SPDX-License-Identifier: Apache-2.0
// Wires and pipes of objects that services offer. What they are told is kept by the object, so it
// must not keep that.
#include <utility>

#include "runtime/cpp/src/dynamic/members.hpp"
#include "runtime/cpp/src/dynamic/skeleton.hpp"
#include "runtime/cpp/src/dynamic/stub.hpp"

namespace rr::dynamic {
namespace {

rr::WireServer<Value> wire_of(const DynamicSkeleton& object, const MemberTable& member) {
  return {object, object.wire(member)};
}

rr::PipeServer<Value> pipe_of(const DynamicSkeleton& object, const MemberTable& member) {
  return {object, object.wire(member)};
}

// What a function gives, as the member's type.
Function<Value()> converting(Function<Value()> function, MemberDescription member) {
  return [function = std::move(function), member = std::move(member)] {
    return convert_for(member, function());
  };
}

}  // namespace

WireServer ServedObject::wire(std::string_view name) const {
  const MemberTable& member = need_member(need().table(), name, MemberKind::wire);
  return {skeleton_, member};
}

PipeServer ServedObject::pipe(std::string_view name) const {
  const MemberTable& member = need_member(need().table(), name, MemberKind::pipe);
  return {skeleton_, member};
}

ServedWire::ServedWire(rr::ServedWire<Value> end, MemberDescription member)
    : rr::ServedWire<Value>(std::move(end)), member_(std::move(member)) {}

void ServedWire::set_in(const Value& value) {
  rr::ServedWire<Value>::set_in(convert_for(member_, value));
}

WireServer::WireServer(std::shared_ptr<const DynamicSkeleton> object, const MemberTable& member)
    : object_(std::move(object)), member_(&member) {}

void WireServer::set_in(const Value& value) const {
  wire_of(*object_, *member_).set_in(convert_for(object_->describe(*member_), value));
}

std::optional<Timed<Value>> WireServer::out() const { return wire_of(*object_, *member_).out(); }

std::vector<ServedWire> WireServer::connections() const {
  std::vector<ServedWire> ends;
  for (rr::ServedWire<Value>& end : wire_of(*object_, *member_).connections()) {
    ends.emplace_back(std::move(end), object_->describe(*member_));
  }
  return ends;
}

std::size_t WireServer::connection_count() const {
  return wire_of(*object_, *member_).connection_count();
}

void WireServer::set_lifespan(std::chrono::milliseconds lifespan) const {
  wire_of(*object_, *member_).set_lifespan(lifespan);
}

void WireServer::on_connect(Function<void(ServedWire)> function) const {
  wire_of(*object_, *member_)
      .on_connect([function = std::move(function), member = object_->describe(*member_)](
                      rr::ServedWire<Value> end) { function(ServedWire(std::move(end), member)); });
}

void WireServer::on_out(
    Function<void(const Value&, const TimeSpec&, std::uint32_t)> function) const {
  wire_of(*object_, *member_).on_out(std::move(function));
}

void WireServer::on_peek_in(Function<Value()> function) const {
  wire_of(*object_, *member_)
      .on_peek_in(converting(std::move(function), object_->describe(*member_)));
}

void WireServer::on_peek_out(Function<Value()> function) const {
  wire_of(*object_, *member_)
      .on_peek_out(converting(std::move(function), object_->describe(*member_)));
}

PipeServer::PipeServer(std::shared_ptr<const DynamicSkeleton> object, const MemberTable& member)
    : object_(std::move(object)), member_(&member) {}

void PipeServer::send(const Value& packet) const {
  pipe_of(*object_, *member_).send(convert_for(object_->describe(*member_), packet));
}

std::vector<PipeEndpoint> PipeServer::endpoints() const {
  std::vector<PipeEndpoint> ends;
  for (rr::PipeEndpoint<Value>& end : pipe_of(*object_, *member_).endpoints()) {
    ends.emplace_back(std::move(end), object_->describe(*member_));
  }
  return ends;
}

std::size_t PipeServer::endpoint_count() const {
  return pipe_of(*object_, *member_).endpoint_count();
}

void PipeServer::set_backlog_limit(std::size_t packets) const {
  pipe_of(*object_, *member_).set_backlog_limit(packets);
}

void PipeServer::on_connect(Function<void(PipeEndpoint)> function) const {
  pipe_of(*object_, *member_)
      .on_connect([function = std::move(function),
                   member = object_->describe(*member_)](rr::PipeEndpoint<Value> end) {
        function(PipeEndpoint(std::move(end), member));
      });
}

}  // namespace rr::dynamic
