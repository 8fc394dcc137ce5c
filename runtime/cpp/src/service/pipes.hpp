// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "rr/mutex.hpp"
#include "rr/pipes.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"
#include "runtime/cpp/src/endpoint/pipe_table.hpp"
#include "runtime/cpp/src/service/pipe_place.hpp"

namespace rr::service {

struct Question;
struct ServedObject;
class ServerEndpoint;

/// The pipe endpoints of a client, on the service's side.
class Pipes final : public endpoint::PipeSide {
 public:
  explicit Pipes(ServerEndpoint& endpoint) : endpoint_(endpoint) {}

  // Requests and packets of the client. Throw rr::Error.
  void connect(const Question& question);
  void disconnect(const Question& question);
  void take_packets(const Question& question);
  void take_acknowledgements(const Question& question);

  /// Ends those for which `is_over(path, member)` holds, and tells the client. Returns how many.
  using Choice = std::function<bool(std::string_view, std::string_view)>;
  std::size_t end_if(const Choice& is_over);
  /// The object at a path is released, and those below it.
  void release(std::string_view path);
  /// Rings may not be for all any more.
  void renew_rings();
  /// The session is over.
  void end();
  [[nodiscard]] std::size_t count() const {
    const MutexLock lock(mutex_);
    return ends_.size();
  }

  // From the ends
  [[nodiscard]] channel::Connection& connection() const override;
  void stream(Writer& writer, const EntryHeader& header, std::string_view metadata) override;
  void close(PipeEnd::State& end, bool may_wait) override;

 private:
  struct Served;
  using End = std::shared_ptr<Served>;

  [[nodiscard]] bool wants_ring(const Question& question, std::string_view element) const;
  bool answer_ring_again(const Question& question, const ServedObject& object,
                         const Member& member);
  [[nodiscard]] bool may_join_ring(const Served& end) const;
  channel::PipeRingStart join_ring(const End& end);
  End open(const Question& question, const ServedObject& object, const Member& member);
  void finish(const End& end, bool is_told);
  void send_closed(const Served& end);

  ServerEndpoint& endpoint_;
  mutable Mutex mutex_;
  endpoint::PipeTable ends_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::service
