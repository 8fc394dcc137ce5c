// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "rr/stub.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/endpoint/calls.hpp"
#include "runtime/cpp/src/endpoint/pending.hpp"

namespace rr::service {

class ServerEndpoint;

/// A callback of an object and what is passed to it.
struct CallbackRequest {
  std::string_view path;
  const Member& member;
  const void* const* arguments;
};

/// What a service asks one of its clients, and has no answer to yet (07, section 12).
class Callbacks final : public endpoint::Caller {
 public:
  explicit Callbacks(ServerEndpoint& endpoint) : endpoint_(endpoint) {}

  /// Asks and waits. A member of this service that calls this lets the next requests of its own
  /// client be handled meanwhile. Throws rr::Error, or what the client has thrown.
  void call(const CallbackRequest& request, void* result);
  /// Asks now; the completion gets the answer.
  void start(const CallbackRequest& request, std::shared_ptr<Completion> completion);

  /// An answer to a callback that nobody waits for is dropped.
  void take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                   channel::Laters& laters);
  /// The client has gone: all that is open fails with connection_error, and so does what follows.
  void end(std::string_view why, channel::Laters& laters);

  [[nodiscard]] channel::Connection& connection() const override;
  [[nodiscard]] const std::shared_ptr<endpoint::Core>& core() const override;
  [[nodiscard]] const std::shared_ptr<const TypeRegistry>& types() const override;
  bool take(endpoint::Pending& call) override;
  std::shared_ptr<endpoint::Caller> share() override;

 private:
  [[nodiscard]] Writer& write(const CallbackRequest& request) const;
  void send(const CallbackRequest& request, Writer& writer, endpoint::Pending& call);

  ServerEndpoint& endpoint_;  // owns this
  std::mutex mutex_;
  bool has_ended_ = false;
  endpoint::PendingTable pending_;
};

}  // namespace rr::service
