// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/peer_watch.hpp"

#include <utility>

#include "rr/error.hpp"

namespace rr::channel {

PeerWatch::PeerWatch(std::shared_ptr<TlsFiles> files, const TlsRules& rules,
                     std::shared_ptr<Reactor> reactor, Milliseconds period, Log log)
    : files_(std::move(files)),
      rules_(rules),
      reactor_(std::move(reactor)),
      period_(period),
      log_(std::move(log)) {}

PeerWatch::~PeerWatch() {
  if (reactor_) reactor_->cancel(*this);
}

void PeerWatch::start() {
  if (!reactor_ || period_ <= Milliseconds(0)) return;
  if (!is_started_.load(std::memory_order_relaxed) && !is_started_.exchange(true)) schedule();
}

void PeerWatch::add(const std::shared_ptr<Connection>& connection,
                    std::shared_ptr<const PeerProof> proof) {
  {
    const MutexLock lock(mutex_);
    peers_.push_back({connection, std::move(proof)});
  }
  start();
}

void PeerWatch::schedule() {
  reactor_->schedule(*this, weak_from_this(), after(Clock::now(), period_));
}

// Reading files takes time, and logging is the program's.
void PeerWatch::on_timer() {
  reactor_->post([weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->look();
  });
}

void PeerWatch::look() {
  files_->look_again(true);
  log_reports();
  look_at_peers();
  schedule();
}

void PeerWatch::log_reports() const {
  for (const Report& report : files_->take_reports()) {
    if (log_) log_(report.level, report.text);
  }
}

void PeerWatch::look_at_peers() {
  const auto trust = files_->trust();
  std::vector<Peer> peers;
  {
    const MutexLock lock(mutex_);
    peers = std::exchange(peers_, {});
  }
  std::erase_if(peers, [&](Peer& peer) { return !is_right(peer, *trust); });
  const MutexLock lock(mutex_);
  peers_.insert(peers_.end(), std::make_move_iterator(peers.begin()),
                std::make_move_iterator(peers.end()));
}

// False when the connection is not to be looked at again.
bool PeerWatch::is_right(Peer& peer, const Trust& trust) {
  const auto connection = peer.connection.lock();
  if (!connection || connection->is_closed()) return false;
  const bool is_known = peer.generation == trust.generation;
  if (is_known && std::chrono::system_clock::now() < peer.valid_until) return true;
  const Judgement judgement = judged(peer, trust);
  peer.generation = trust.generation;
  peer.valid_until = judgement.valid_until;
  if (judgement.refusal.empty()) return true;
  connection->close(Error(ErrorCode::connection_error, judgement.refusal));
  if (log_) {
    const auto node = node_of(*peer.proof->certificate);
    log_(LogLevel::warning,
         "the connection with " +
             (node ? "node " + node->text() : "`" + peer.proof->peer.host + "`") +
             " was closed: " + judgement.refusal);
  }
  return false;
}

Judgement PeerWatch::judged(const Peer& peer, const Trust& trust) const {
  if (peer.proof->peer.role != TlsPeer::Role::host) {
    return judge_again(*peer.proof, rules_, *trust.nodes);
  }
  const StorePtr web = files_->web_store();
  return judge_again(*peer.proof, rules_, *web);
}

}  // namespace rr::channel
