// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/bridged_board.hpp"

#include <utility>

#include "rr/error.hpp"

namespace rr::serial {

BridgedBoard::BridgedBoard(Node& node, const BoardPlace& place, Functions functions)
    : node_(node),
      place_(place),
      functions_(std::move(functions)),
      board_(std::make_shared<Board>(
          place.path, place.baud,
          Board::Functions{.connected = [this](const BoardTexts& texts,
                                               bool is_new) { on_connected(texts, is_new); },
                           .lost = [this](const std::string& why) { say("lost: " + why); },
                           .failed = [this](const Board::Failure& failure) { on_failed(failure); },
                           .unasked =
                               [this](const Unasked& one) {
                                 if (service_) service_->handle(one);
                               }})) {
  board_->start();
}

BridgedBoard::~BridgedBoard() {
  board_->stop();
  withdraw();
}

void BridgedBoard::say(const std::string& what) const {
  if (functions_.log) functions_.log((name_.empty() ? place_.path : name_) + ": " + what);
}

void BridgedBoard::on_connected(const BoardTexts& texts, bool is_new) {
  if (is_new || !service_) {
    try {
      offer(texts);
    } catch (const Error& error) {
      on_failed({Board::Failure::Kind::unusable, error.message()});
    }
  }
  if (!service_) return;
  last_failure_.clear();
  service_->open_again();
  say("connected");
  if (functions_.met) functions_.met(name_);
}

void BridgedBoard::on_failed(const Board::Failure& failure) {
  // Attempts go on for ever, and what is said once is known.
  if (std::exchange(last_failure_, failure.text) != failure.text) say(failure.text);
  if (functions_.failed) functions_.failed(failure);
}

void BridgedBoard::offer(const BoardTexts& texts) {
  withdraw();
  const auto service = std::make_shared<BoardService>(
      board_, texts, node_, [this](const std::string& what) { say(what); });
  name_ = place_.name.empty() ? service->name() : place_.name;
  offered_ = node_.register_service(name_, service->root());
  service_ = service;
}

void BridgedBoard::withdraw() {
  if (!service_) return;
  offered_->close();
  service_->detach();
  service_.reset();
}

}  // namespace rr::serial
