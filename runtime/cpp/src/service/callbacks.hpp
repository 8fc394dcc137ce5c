// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
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

  /// An answer that nobody waits for is dropped, and so is one to something else.
  void take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                   channel::DeferredCallbacks& deferred);
  /// Those for which `is_over(path, member)` holds fail with `why`. Returns how many.
  using Choice = std::function<bool(std::string_view, std::string_view)>;
  std::size_t end_if(const Choice& is_over, const Error& why, channel::DeferredCallbacks& deferred);
  /// The client has gone: all that is open fails with connection_error, and so does what follows.
  void end(std::string_view why, channel::DeferredCallbacks& deferred);

  [[nodiscard]] channel::Connection& connection() const override;
  [[nodiscard]] const std::shared_ptr<endpoint::Core>& core() const override;
  [[nodiscard]] const std::shared_ptr<const TypeRegistry>& types() const override;
  bool take(endpoint::Pending& call) override;
  std::shared_ptr<endpoint::Caller> share() override;

 private:
  [[nodiscard]] Writer& write(const CallbackRequest& request) const;
  void send(const CallbackRequest& request, Writer& writer, endpoint::Pending& call);

  ServerEndpoint& endpoint_;  // owns this
  Mutex mutex_;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  bool has_told_foreign_ RR_GUARDED_BY(mutex_) =
      false;  // answers to something else are logged once
  endpoint::PendingTable pending_ RR_GUARDED_BY(mutex_);
  // What was asked, of those that are pending.
  struct Asked {
    std::string path;
    const Member* member;
  };
  std::map<endpoint::Pending*, Asked> asked_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::service
