// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/host_link.hpp"

#include <algorithm>
#include <utility>

namespace rr::serial {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t hello_body = 14;

/// Whether the body of a reply begins with the member of the request.
bool has_member(Kind kind) { return kind >= Kind::Get && kind <= Kind::Answer; }

std::uint8_t low_byte(std::uint64_t number) { return static_cast<std::uint8_t>(number & 0xFF); }

}  // namespace

Time HostLink::on_wire(std::size_t bytes) const {
  return Time(static_cast<std::int64_t>(bytes) * 10'000'000 / timing_.baud);
}

void HostLink::begin_session(std::uint16_t session, Time now, Time patience) {
  has_session_ = false;
  session_ = session;
  sequence_ = 0;
  // A board waits until a frame of the largest size could be there and acknowledged.
  const auto board = 2 * (on_wire(80) + timing_.allowances[0]) / 1ms;
  const auto milliseconds = static_cast<std::uint64_t>(std::min<std::int64_t>(board, 0xFFFF));
  start({Kind::Hello,
         0,
         {'R', 'D', protocolVersion, low_byte(session), low_byte(session >> 8U),
          low_byte(milliseconds), low_byte(milliseconds >> 8U)}},
        now, patience);
}

void HostLink::request(Kind kind, std::vector<std::uint8_t> body, Time now, Time patience) {
  ++sequence_;
  start({kind, sequence_, std::move(body)}, now, patience);
}

void HostLink::start(Frame frame, Time now, Time patience) {
  under_way_ = std::move(frame);
  outcome_.reset();
  is_busy_ = true;
  attempts_ = 0;
  give_up_ = now + patience;
  send(now);
}

void HostLink::send(Time now) {
  const std::vector<std::uint8_t> bytes = stuff(under_way_);
  output_.insert(output_.end(), bytes.begin(), bytes.end());
  const std::size_t answer = std::max<std::size_t>(facts_.longest_reply, bodyMinimum) + 8U;
  again_ = now + on_wire(bytes.size() + answer) +
           timing_.allowances[std::min<std::size_t>(attempts_, timing_.allowances.size() - 1)];
  if (attempts_ != 0) ++repeated_;
  ++attempts_;
}

void HostLink::finish(Outcome outcome) {
  is_busy_ = false;
  outcome_ = std::move(outcome);
  before_outcome_ = unasked_.size();
}

void HostLink::lose_session() {
  finder_.reset();
  output_.clear();
  has_session_ = false;
  if (is_busy_) finish({.kind = Outcome::Kind::reset});
}

void HostLink::tick(Time now) {
  if (!is_busy_) return;
  if (now >= give_up_) {
    // What became of it is not known, so what comes next begins anew.
    has_session_ = false;
    finish({.kind = Outcome::Kind::timeout});
  } else if (now >= again_) {
    send(now);
  }
}

std::optional<Time> HostLink::wake_up() const {
  if (!is_busy_) return std::nullopt;
  return std::min(again_, give_up_);
}

std::vector<std::uint8_t> HostLink::take_output() { return std::exchange(output_, {}); }
std::optional<Outcome> HostLink::take_outcome() { return std::exchange(outcome_, std::nullopt); }
std::vector<Unasked> HostLink::take_unasked() {
  if (!outcome_) return std::exchange(unasked_, {});
  std::vector<Unasked> later(unasked_.begin() + static_cast<std::ptrdiff_t>(before_outcome_),
                             unasked_.end());
  unasked_.resize(before_outcome_);
  before_outcome_ = 0;
  return std::exchange(unasked_, std::move(later));
}

void HostLink::receive(std::span<const std::uint8_t> bytes, Time now) {
  finder_.take(bytes, [&](const Frame& frame) {
    heard_ = now;
    handle(frame);
  });
}

void HostLink::handle(const Frame& frame) {
  switch (frame.kind) {
    case Kind::Reply:
    case Kind::Error:
      if (is_busy_ && frame.sequence == under_way_.sequence) handle_answer(frame);
      break;
    case Kind::NoSession:
      if (!is_busy_ || frame.sequence != under_way_.sequence) break;
      if (under_way_.kind == Kind::Hello) break;
      has_session_ = false;
      finish({.kind = Outcome::Kind::reset});
      break;
    case Kind::Started:
      // To a Hello that was sent before, the board will have no answer: it is sent again.
      if (is_busy_ && under_way_.kind == Kind::Hello) break;
      has_session_ = false;
      if (is_busy_) finish({.kind = Outcome::Kind::reset});
      break;
    case Kind::Event:
    case Kind::OutPacket:
    case Kind::Ask:
    case Kind::WireValue:
      handle_unasked(frame);
      break;
    default:
      break;
  }
}

void HostLink::handle_answer(const Frame& frame) {
  if (under_way_.kind == Kind::Hello) {
    handle_hello(frame);
    return;
  }
  const bool is_error = frame.kind == Kind::Error;
  if (is_error ? frame.body.size() < 2 : has_member(under_way_.kind) && frame.body.empty()) return;
  if (has_member(under_way_.kind) && under_way_.body.size() >= 2 &&
      frame.body.front() != under_way_.body[1]) {
    return;
  }
  if (is_error) {
    finish({.kind = Outcome::Kind::error,
            .code = frame.body[1],
            .has_reason = frame.body.size() > 2 && frame.body[2] != 0});
  } else {
    finish({.kind = Outcome::Kind::reply, .body = frame.body});
  }
}

void HostLink::handle_hello(const Frame& frame) {
  const std::vector<std::uint8_t>& body = frame.body;
  if (frame.kind != Kind::Reply || body.empty()) return;
  if (body[0] != protocolVersion) {
    finish({.kind = Outcome::Kind::version, .code = body[0]});
    return;
  }
  if (body.size() != hello_body || body[1] != low_byte(session_) ||
      body[2] != low_byte(session_ >> 8U)) {
    return;
  }
  facts_ = {.longest_request = body[3], .longest_reply = body[4], .texts = body[5]};
  for (std::size_t at = 0; at < 8; ++at) {
    facts_.hash |= std::uint64_t{body[6 + at]} << (8 * at);
  }
  has_session_ = true;
  unasked_sequence_.reset();
  finish({.kind = Outcome::Kind::reply, .body = body});
}

void HostLink::handle_unasked(const Frame& frame) {
  if (!has_session_) return;
  if (frame.kind != Kind::WireValue) {
    const std::vector<std::uint8_t> bytes = stuff({Kind::Ack, frame.sequence, {}});
    output_.insert(output_.end(), bytes.begin(), bytes.end());
    if (unasked_sequence_ == frame.sequence) return;
    unasked_sequence_ = frame.sequence;
  }
  unasked_.push_back({frame.kind, frame.body});
}

}  // namespace rr::serial
