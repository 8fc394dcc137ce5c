// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/pipes.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"
#include "runtime/cpp/src/endpoint/pipe_table.hpp"

namespace rr::service {

struct Question;
struct ServedObject;
class ServerEndpoint;

/// One pipe of an object: what is set up for it, and its endpoints of all clients.
class PipePlace {
 public:
  using End = std::shared_ptr<PipeEnd::State>;
  using Ends = std::vector<End>;

  void set_connected(Function<void(PipeEnd)> function);
  [[nodiscard]] Function<void(PipeEnd)> connected() const;
  void set_backlog_limit(std::size_t packets);

  void add(const End& end);
  void remove(const PipeEnd::State& end);
  [[nodiscard]] std::shared_ptr<const Ends> ends() const { return audience().ends; }
  /// Who gets a packet that goes to all, and how many may be on their way to each.
  struct Audience {
    std::shared_ptr<const Ends> ends;
    std::size_t backlog_limit = 0;
  };
  [[nodiscard]] Audience audience() const;

 private:
  mutable Mutex mutex_;
  Function<void(PipeEnd)> connected_ RR_GUARDED_BY(mutex_);
  Audience audience_ RR_GUARDED_BY(mutex_){
      std::make_shared<Ends>()};  // the list is replaced, never changed
};

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

  End open(const Question& question, const ServedObject& object, const Member& member);
  void finish(Served& end);
  void send_closed(const Served& end);

  ServerEndpoint& endpoint_;
  mutable Mutex mutex_;
  endpoint::PipeTable ends_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::service
