// SPDX-License-Identifier: Apache-2.0
#include "runtime/arduino/bench/simulated_line.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace rr::serial::testing {

using namespace std::chrono_literals;

namespace {
constexpr std::size_t frames_remembered = 64;
}

// All that a frame has become is there at the same time as the frame, and both finders go on.
void ForgeryWatch::take(const std::vector<std::uint8_t>& sent,
                        const std::vector<std::uint8_t>& received) {
  sent_finder_.take(sent, [&](const Frame& frame) {
    sent_.push_back(frame);
    if (sent_.size() > frames_remembered) sent_.pop_front();
  });
  received_finder_.take(received, [&](const Frame& frame) {
    if (std::ranges::find(sent_, frame) == sent_.end()) ++count_;
  });
}

SimulatedLine::SimulatedLine(const std::string& elf, std::uint32_t baud,
                             const BadLine::Rates& rates, unsigned seed)
    : board(elf, baud), host(baud), there_(rates, seed), back_(rates, seed + 1000) {
  run(50ms);  // until the program has begun
}

void SimulatedLine::step(Time until) {
  const std::vector<std::uint8_t> out = host.take_output();
  if (!out.empty()) {
    bytes += out.size();
    const std::vector<std::uint8_t> received = there_.pass(out);
    there_watch_.take(out, received);
    board.send(received);
  }
  board.run_until(std::min(until, board.now() + 500us));
  const std::vector<std::uint8_t> in = board.receive();
  if (!in.empty()) {
    bytes += in.size();
    const std::vector<std::uint8_t> received = back_.pass(in);
    back_watch_.take(in, received);
    host.receive(received, board.now());
  }
  host.tick(board.now());
  for (Unasked& one : host.take_unasked()) unasked.push_back(std::move(one));
  if (meanwhile) meanwhile();
}

void SimulatedLine::run(Time time) {
  const Time end = board.now() + time;
  while (board.now() < end) step(end);
}

Outcome SimulatedLine::wait() {
  for (;;) {
    if (std::optional<Outcome> outcome = host.take_outcome()) return *outcome;
    step(host.wake_up().value_or(board.now() + 1ms));
  }
}

Outcome SimulatedLine::hello() {
  host.begin_session(++session_, board.now(), 1s);
  return wait();
}

Outcome SimulatedLine::ask(Kind kind, std::vector<std::uint8_t> body, Time patience) {
  host.request(kind, std::move(body), board.now(), patience);
  return wait();
}

std::string SimulatedLine::text(std::uint8_t number) {
  std::string text;
  for (;;) {
    const std::size_t at = text.size();
    const Outcome outcome = ask(Kind::Text, {number, static_cast<std::uint8_t>(at & 0xFF),
                                             static_cast<std::uint8_t>(at >> 8)});
    if (outcome.kind != Outcome::Kind::reply) throw std::runtime_error("no text");
    if (outcome.body.size() <= 3) return text;
    text.append(outcome.body.begin() + 3, outcome.body.end());
  }
}

void SimulatedLine::end_noise() {
  there_.end_noise();
  back_.end_noise();
}

std::vector<std::uint8_t> bytes_of_double(double value) {
  std::vector<std::uint8_t> bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

double double_in(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  double value = 0;
  if (bytes.size() >= at + sizeof value) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace rr::serial::testing
