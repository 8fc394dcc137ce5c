// SPDX-License-Identifier: Apache-2.0
// Events, pipes and wires of a session, and the callback that the service calls.
#include <array>
#include <cstddef>
#include <utility>

#include "runtime/cpp/stress/bench.hpp"
#include "runtime/cpp/stress/session.hpp"

namespace rr::stress {

void Session::connect_streams() {
  const std::shared_ptr<SessionState> state = state_;
  bench_->question().set([](std::uint64_t value) { return answered(value); });
  if (draw(2) == 0) {
    has_ticks_ = true;
    subscriptions_.push_back(bench_->ticked().connect([state](std::uint64_t number) {
      state->ticks.take(number);
      ++state->context.events;
    }));
  }
  if (draw(2) == 0) {
    attempt("connect a pipe", [&] {
      broadcast_ = bench_->broadcast().connect();
      has_broadcast_ = true;
    });
  }
  if (has_broadcast_) {
    if (draw(2) == 0) broadcast_.ask_for_acknowledgements();
    subscriptions_.push_back(broadcast_.on_packet([state](const std::optional<Stamp>& packet) {
      state->broadcast.take(packet->number);
      ++state->context.packets;
    }));
  }
  if (draw(2) == 0) {
    attempt("connect a pipe", [&] {
      echo_ = bench_->echo().connect();
      has_echo_ = true;
    });
  }
  if (has_echo_) {
    if (draw(2) == 0) echo_.ask_for_acknowledgements();
    subscriptions_.push_back(
        echo_.on_packet([state, client = client_number_](const std::optional<Stamp>& packet) {
          state->echo.take(packet->number);
          if (packet->writer != client) state->context.lines.fault("a packet of another client");
          ++state->context.packets;
        }));
  }
  if (draw(4) == 0) {
    attempt("connect a pipe", [&] {
      lossy_ = bench_->lossy().connect();
      lossy_.set_queue_limit(8, WhenFull::drop_oldest);
    });
  }
  connect_wires();
  attempt("numbers of streams", [&] {
    broadcast_from_ = bench_->broadcast_number();
    ticks_from_ = bench_->tick_number();
  });
}

void Session::connect_wires() {
  const std::shared_ptr<SessionState> state = state_;
  if (draw(2) == 0) {
    attempt("connect a wire", [&] {
      level_ = bench_->level().connect();
      has_level_ = true;
    });
  }
  if (has_level_) {
    subscriptions_.push_back(
        level_.on_in([state](const std::optional<Stamp>& value, const TimeSpec&) {
          state->level.take(value->number, "function");
          ++state->context.values;
        }));
  }
  if (draw(2) == 0) {
    attempt("connect a wire", [&] {
      mirror_ = bench_->mirror().connect();
      has_mirror_ = true;
    });
  }
  if (has_mirror_) {
    subscriptions_.push_back(
        mirror_.on_in([state](const std::optional<Stamp>& value, const TimeSpec&) {
          state->mirror.take(value->number, "function");
          ++state->context.values;
        }));
  }
  if (draw(2) == 0) {
    attempt("connect a wire", [&] {
      target_ = bench_->target().connect();
      has_target_ = true;
    });
  }
}

void Session::send_packets() {
  if (!has_echo_) return;
  for (std::uint64_t burst = 1 + draw(20); burst != 0; --burst) {
    attempt("send a packet", [&] {
      const rr::Array<double> filling(draw(10) == 0 ? 3000 : draw(10));
      echo_.send(Stamp{client_number_, sent_echo_ + 1, filling});
      ++sent_echo_;
    });
  }
}

void Session::send_values() {
  for (std::uint64_t burst = 1 + draw(10); burst != 0; --burst) {
    const rr::Array<double> filling(draw(10));
    if (has_mirror_) {
      attempt("send a value", [&] {
        mirror_.set_out(Stamp{client_number_, sent_mirror_ + 1, filling});
        ++sent_mirror_;
      });
    }
    if (has_target_) {
      attempt("send a value", [&] {
        target_.set_out(Stamp{client_number_, sent_target_ + 1, filling});
        ++sent_target_;
      });
    }
  }
}

// What the service has set before it answers is there when the call returns.
void Session::compare_level() {
  if (!has_level_) return;
  attempt("level_number", [&] {
    const std::uint64_t number = bench_->level_number();
    const auto value = level_.try_in();
    const std::uint64_t seen = value ? value->value->number : 0;
    state_->level_polled.take(seen, "polled");
    check(seen >= number, "the age of a wire's value");
    const auto peeked = bench_->level().peek_in();
    check(peeked.value->number >= seen, "the age of a peeked value");
  });
}

// All that was sent arrives.
void Session::settle() {
  if (has_echo_) {
    wait_for("the last packet of an echo", [&] { return state_->echo.last() == sent_echo_; });
  }
  if (has_mirror_) {
    wait_for("the newest value of a mirror", [&] {
      const auto value = mirror_.try_in();
      return (value ? value->value->number : 0) == sent_mirror_;
    });
  }
  if (has_echo_) {
    wait_for("acknowledgements", [&] { return echo_.unacknowledged() == 0; });
  }
  if (has_broadcast_) {
    attempt("broadcast_number", [&] {
      settle_stream("packets for all", state_->broadcast, broadcast_from_,
                    bench_->broadcast_number());
    });
  }
  if (has_ticks_) {
    attempt("tick_number",
            [&] { settle_stream("events", state_->ticks, ticks_from_, bench_->tick_number()); });
  }
}

// All numbers behind `from` but one, up to `to` at least, have come or will.
void Session::settle_stream(const char* what, const Consecutive& stream, std::uint64_t from,
                            std::uint64_t to) {
  // The one behind it may have been on its way to the others while this client connected.
  if (from == 0 || to <= from + 1) return;
  wait_for(what, [&] { return stream.last() >= to; });
  check(stream.first() <= from + 2, what);
}

}  // namespace rr::stress
