// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/options.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/peer_judge.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/tls_files.hpp"

namespace rr::channel {

/// Looks at the files of TLS again and again, and ends connections with peers that would not be let
/// in any more. Any thread may use it.
class PeerWatch final : public Timer, public std::enable_shared_from_this<PeerWatch> {
 public:
  using Log = std::function<void(LogLevel, std::string_view)>;

  /// A period of 0: nothing is done by itself.
  PeerWatch(std::shared_ptr<TlsFiles> files, const TlsRules& rules,
            std::shared_ptr<Reactor> reactor, Milliseconds period, Log log);
  ~PeerWatch();

  /// From now on there is something to look at.
  void start();
  void add(const std::shared_ptr<Connection>& connection, std::shared_ptr<const PeerProof> proof);

 private:
  struct Peer {
    std::weak_ptr<Connection> connection;
    std::shared_ptr<const PeerProof> proof;
    std::uint64_t generation = 0;  // of the trust that it was judged by; 0: of none
    std::chrono::system_clock::time_point valid_until{};
  };

  void on_timer() override;
  void schedule();
  void look();
  void look_at_peers();
  bool is_right(Peer& peer, const Trust& trust);
  [[nodiscard]] Judgement judged(const Peer& peer, const Trust& trust) const;
  void log_reports() const;

  const std::shared_ptr<TlsFiles> files_;
  const TlsRules rules_;
  const std::shared_ptr<Reactor> reactor_;
  const Milliseconds period_;
  const Log log_;
  std::atomic<bool> is_started_{false};
  Mutex mutex_;
  std::vector<Peer> peers_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::channel
