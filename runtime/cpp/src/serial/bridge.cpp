// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <vector>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/serial.hpp"
#include "runtime/cpp/src/serial/bridged_board.hpp"
#include "runtime/cpp/src/serial/port.hpp"
#include "runtime/cpp/src/serial/tcp_port.hpp"

namespace rr {
struct BoardBridge::State {
  Node& node;
  Log log;
  mutable Mutex mutex{};
  mutable Condition changed{};
  std::size_t met RR_GUARDED_BY(mutex) = 0;
  std::vector<std::unique_ptr<serial::BridgedBoard>> boards RR_GUARDED_BY(mutex){};
};

BoardPlace BoardPlace::parse(const std::string& text) {
  constexpr std::string_view scheme = "rr+serial://";
  BoardPlace place;
  const bool is_url = text.starts_with(scheme);
  std::string rest = is_url ? text.substr(scheme.size()) : text;
  const std::size_t question = rest.find('?');
  place.path = rest.substr(0, question);
  // A URL with a host, and nothing behind it, leads there; the path of a port begins with `/`.
  if (is_url && !place.path.empty() && place.path.front() != '/') place.path.insert(0, "tcp://");
  const bool is_tcp = serial::is_tcp_place(place.path);
  if (is_tcp && place.path.ends_with('/') && !place.path.ends_with("//")) place.path.pop_back();
  rest = question == std::string::npos ? "" : rest.substr(question + 1);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('&'), rest.size());
    const std::string part = rest.substr(0, end);
    rest.erase(0, end + 1);
    if (part.starts_with("baud=") && !is_tcp) {
      const char* const last = part.data() + part.size();
      const auto [at, error] = std::from_chars(part.data() + 5, last, place.baud);
      if (error == std::errc() && at == last) continue;
    } else if (part.starts_with("name=") || part.starts_with("service=")) {
      place.name = part.substr(part.find('=') + 1);
      continue;
    } else if (part.starts_with("nodeid=") || part.starts_with("nodename=")) {
      continue;  // whom a client expects there
    }
    throw Error(ErrorCode::invalid_argument, "`" + text + "`: `" + part + "` is not understood");
  }
  if (place.path.empty()) throw Error(ErrorCode::invalid_argument, "`" + text + "` has no path");
  place.path = serial::Port::to(place.path, place.baud)->path();
  return place;
}

BoardBridge::BoardBridge(Node& node, Log log)
    : state_(new State{.node = node, .log = std::move(log)}) {}

BoardBridge::~BoardBridge() = default;

void BoardBridge::add(const BoardPlace& place) {
  State* const state = state_.get();
  const auto is_met = std::make_shared<bool>(false);
  auto board = std::make_unique<serial::BridgedBoard>(
      state->node, place,
      serial::BridgedBoard::Functions{.log = state->log, .met = [state, is_met](const auto&) {
                                        const MutexLock lock(state->mutex);
                                        if (!std::exchange(*is_met, true)) ++state->met;
                                        state->changed.notify_all();
                                      }});
  const MutexLock lock(state->mutex);
  state->boards.push_back(std::move(board));
  state->changed.notify_all();  // it may have been met by now
}

bool BoardBridge::wait(std::chrono::milliseconds limit) const {
  const MutexLock lock(state_->mutex);
  return state_->changed.wait_until(
      state_->mutex, std::chrono::steady_clock::now() + limit,
      [&]() RR_REQUIRES(state_->mutex) { return state_->met == state_->boards.size(); });
}

}  // namespace rr
