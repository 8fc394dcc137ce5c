// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "rr/definition.hpp"
#include "rr/registry.hpp"
#include "rr/skeleton.hpp"
#include "runtime/cpp/src/service/handler_memory.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr {

/// A request while its handler runs.
struct Request::Source {
  enum class State : std::uint8_t { open, answered, deferred };

  service::ServerEndpoint& endpoint;
  const service::Question& question;
  const TypeRegistry& types;
  const Member& member;
  const std::shared_ptr<const service::ServedObject>& object;
  bool is_set;
  service::HandlerMemory& made;
  State state = State::open;

  /// Answers unless the handler has, or has put it off: nothing for what has no value.
  void complete();
};

/// An answer that is owed. It does not keep the session: an object that never gives it would keep
/// itself.
struct ReplyHandle::State {
  std::shared_ptr<service::OwedAnswers> owed;
  std::uint64_t number;
};

}  // namespace rr
