// SPDX-License-Identifier: Apache-2.0
// What the robot's service closes while the gateway is connected: it is connected again, and far
// clients are told.
#include <algorithm>
#include <array>
#include <utility>

#include "gateway/service_exporter.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds attach_delay{200};

/// Whether an object is at a path or below.
bool is_at_or_below(const std::string& path, const std::string& above) {
  return path == above || path.starts_with(above + ".");
}

/// Whether an answer to a request came from a service that goes on.
bool is_answered(const std::exception_ptr& error) {
  if (!error) return true;
  try {
    std::rethrow_exception(error);
  } catch (const Error& found) {
    constexpr std::array without_answer{
        ErrorCode::connection_error,  ErrorCode::service_not_found, ErrorCode::invalid_endpoint,
        ErrorCode::operation_aborted, ErrorCode::request_timeout,   ErrorCode::operation_timeout,
        ErrorCode::invalid_operation};  // of a session that has ended
    return std::ranges::find(without_answer, found.code()) == without_answer.end();
  } catch (...) {
    return false;
  }
}

}  // namespace

// Called on a thread of the node: with an error for a member that could not be connected.
Function<void(std::exception_ptr)> ServiceExporter::when_closed(const std::string& path,
                                                                const std::string& member) {
  return [weak = Weak(shared_from_this()), path, member,
          connection = connection_](const std::exception_ptr& error) {
    const Self self = weak.lock();
    if (!self) return;
    self->shared_.worker.post([weak, path, member, connection, error] {
      const Self exporter = weak.lock();
      if (!exporter || exporter->connection_ != connection) return;
      exporter->attached_topics_.erase(member_topic(exporter->address_, path, member));
      if (!error) exporter->member_closed(path, member);
    });
  };
}

void ServiceExporter::member_closed(const std::string& path, const std::string& member) {
  ClosedMembers& closed = attach_later(path);
  closed.members.insert(member);
  if (closed.is_released) return;
  const auto attached = attached_.find(path);
  if (attached == attached_.end()) return;
  // The end of a pipe's endpoint is told in its stream.
  if (attached->second.member(member).kind == MemberKind::wire) ask_for(path, member);
}

// Members are closed before it is known that the connection was lost. An answer says that it was
// not: the robot has closed this one.
void ServiceExporter::ask_for(const std::string& path, const std::string& wire) {
  unsure_.insert({path, wire});
  attached_.at(path).wire(wire).async_peek_in(
      [weak = Weak(shared_from_this()), path, wire, connection = connection_](
          const std::exception_ptr& error, const Timed<dynamic::Value>&) {
        const Self self = weak.lock();
        if (!self || !is_answered(error)) return;
        self->shared_.worker.post([weak, path, wire, connection] {
          const Self exporter = weak.lock();
          if (!exporter || exporter->connection_ != connection) return;
          if (exporter->unsure_.erase({path, wire}) != 0) exporter->tell_closed({path, wire});
        });
      });
}

void ServiceExporter::object_released(const std::string& released) {
  tell_closed({released, {}});
  // Far clients are told of the object.
  std::erase_if(unsure_, [&](const auto& wire) { return is_at_or_below(wire.first, released); });
  for (const std::string& path : attached_paths()) {
    const auto attached = attached_.find(path);
    if (attached == attached_.end() || !is_at_or_below(path, released)) continue;
    ClosedMembers& again = attach_later(path);
    again.is_released = true;
    for (const dynamic::MemberDescription& member : attached->second.members()) {
      // Wires and pipes end by themselves.
      if (member.kind == MemberKind::event) {
        attached_topics_.erase(member_topic(address_, path, member.name));
      }
      again.members.insert(member.name);
    }
  }
}

void ServiceExporter::tell_closed(Closed closed) {
  closed_.add(std::move(closed));
  closed_is_told_ = false;
}

// Far clients are told first, and a service that closes whatever is connected is not asked all the
// time.
ServiceExporter::ClosedMembers& ServiceExporter::attach_later(const std::string& path) {
  const auto [closed, is_new] = closed_members_.try_emplace(path);
  if (is_new) closed->second.due = Clock::now() + attach_delay;
  return closed->second;
}

void ServiceExporter::attach_closed(Clock::time_point now) {
  if (!std::exchange(closed_is_told_, true)) {
    retain(closed_.message(service_topic(address_) + "/$closed"));
  }
  for (auto at = closed_members_.begin(); at != closed_members_.end();) {
    if (now < at->second.due) {
      ++at;
      continue;
    }
    const auto [path, closed] = *at;
    at = closed_members_.erase(at);
    if (trouble_.empty()) attach_path(path, {nullptr, closed.members});
  }
}

}  // namespace rr::gateway
