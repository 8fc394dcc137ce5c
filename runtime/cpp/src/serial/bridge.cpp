// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <condition_variable>
#include <vector>

#include "rr/error.hpp"
#include "rr/serial.hpp"
#include "runtime/cpp/src/serial/served_board.hpp"

namespace rr {
namespace serial {
namespace {

/// A board and the service that is made of it.
class BridgedBoard {
 public:
  BridgedBoard(Node& node, const BoardPlace& place, BoardBridge::Log log, std::function<void()> met)
      : node_(node),
        place_(place),
        log_(std::move(log)),
        met_(std::move(met)),
        board_(std::make_shared<Board>(
            place.path, place.baud,
            Board::Functions{.connected = [this](const BoardTexts& texts,
                                                 bool is_new) { on_connected(texts, is_new); },
                             .lost = [this](const std::string& why) { say("lost: " + why); },
                             .unasked =
                                 [this](const Unasked& one) {
                                   if (service_) service_->handle(one);
                                 }})) {
    board_->start();
  }
  ~BridgedBoard() {
    board_->stop();
    withdraw();
  }
  BridgedBoard(const BridgedBoard&) = delete;
  BridgedBoard& operator=(const BridgedBoard&) = delete;

 private:
  void say(const std::string& what) const {
    if (log_) log_((name_.empty() ? place_.path : name_) + ": " + what);
  }

  void on_connected(const BoardTexts& texts, bool is_new) {
    if (is_new || !service_) {
      try {
        offer(texts);
      } catch (const Error& error) {
        say(error.message());
      }
    }
    if (!service_) return;
    service_->open_again();
    say("connected");
    met_();
  }

  void offer(const BoardTexts& texts) {
    withdraw();
    const auto service = std::make_shared<BoardService>(board_, texts, node_);
    name_ = place_.name.empty() ? service->name() : place_.name;
    offered_ = node_.register_service(name_, service->root());
    service_ = service;
  }

  void withdraw() {
    if (!service_) return;
    offered_->close();
    service_->detach();
    service_.reset();
  }

  Node& node_;
  const BoardPlace place_;
  const BoardBridge::Log log_;
  const std::function<void()> met_;
  std::string name_;
  Service offered_;
  std::shared_ptr<BoardService> service_;
  const std::shared_ptr<Board> board_;  // its thread alone uses service_, until it has ended
};

}  // namespace
}  // namespace serial

struct BoardBridge::State {
  Node& node;
  Log log;
  mutable std::mutex mutex{};
  mutable std::condition_variable changed{};
  std::size_t met = 0;
  std::vector<std::unique_ptr<serial::BridgedBoard>> boards{};
};

BoardPlace BoardPlace::parse(const std::string& text) {
  constexpr std::string_view scheme = "rr+serial://";
  BoardPlace place;
  std::string rest = text.starts_with(scheme) ? text.substr(scheme.size()) : text;
  const std::size_t question = rest.find('?');
  place.path = rest.substr(0, question);
  rest = question == std::string::npos ? "" : rest.substr(question + 1);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('&'), rest.size());
    const std::string part = rest.substr(0, end);
    rest.erase(0, end + 1);
    if (part.starts_with("baud=")) {
      const char* const last = part.data() + part.size();
      const auto [at, error] = std::from_chars(part.data() + 5, last, place.baud);
      if (error == std::errc() && at == last) continue;
    } else if (part.starts_with("name=") || part.starts_with("service=")) {
      place.name = part.substr(part.find('=') + 1);
      continue;
    }
    throw Error(ErrorCode::invalid_argument, "`" + text + "`: `" + part + "` is not understood");
  }
  if (place.path.empty()) throw Error(ErrorCode::invalid_argument, "`" + text + "` has no path");
  serial::Port::check_rate(place.baud);
  return place;
}

BoardBridge::BoardBridge(Node& node, Log log)
    : state_(new State{.node = node, .log = std::move(log)}) {}

BoardBridge::~BoardBridge() = default;

void BoardBridge::add(const BoardPlace& place) {
  serial::Port::check_rate(place.baud);
  State* const state = state_.get();
  const auto is_met = std::make_shared<bool>(false);
  state->boards.push_back(
      std::make_unique<serial::BridgedBoard>(state->node, place, state->log, [state, is_met] {
        const std::lock_guard lock(state->mutex);
        if (!std::exchange(*is_met, true)) ++state->met;
        state->changed.notify_all();
      }));
}

bool BoardBridge::wait(std::chrono::milliseconds limit) const {
  std::unique_lock lock(state_->mutex);
  return state_->changed.wait_for(lock, limit,
                                  [&] { return state_->met == state_->boards.size(); });
}

}  // namespace rr
