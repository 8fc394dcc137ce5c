// SPDX-License-Identifier: Apache-2.0
// Properties, functions, memories, generators, objects and locks of a session.
#include <array>
#include <chrono>
#include <cstddef>
#include <span>
#include <utility>

#include "rr/async.hpp"
#include "rr/locks.hpp"
#include "runtime/cpp/stress/bench.hpp"
#include "runtime/cpp/stress/session.hpp"

namespace rr::stress {
namespace {

constexpr std::int32_t locked_parts = 4;    // the first of them: locked and entered
constexpr std::int32_t released_parts = 8;  // the last of them: released at times

/// Where two objects of a session are kept apart from the rest: one thread uses it at a time.
std::uint64_t unique(std::uint32_t client, Random& random) {
  return (std::uint64_t{client} << 40U) + random();
}

}  // namespace

void Session::act() {
  switch (draw(16)) {
    case 0:
      return use_memory();
    case 1:
      return use_grid();
    case 2:
      return use_generator();
    case 3:
      return feed_generator();
    case 4:
      return lock_part();
    case 5:
      return enter_part();
    case 6:
      return release_part();
    case 7:
      return use_part();
    case 8:
    case 9:
      return send_packets();
    case 10:
    case 11:
      return send_values();
    case 12:
      return compare_level();
    case 13:
      return call_aside();
    default:
      return call();
  }
}

void Session::call() {
  const std::uint64_t value = unique(client_number_, random_);
  switch (draw(7)) {
    case 0:
      return attempt("mix", [&] { check(bench_->mix(value, 3) == mixed(value, 3), "mix"); });
    case 1:
      return attempt("kept", [&] {
        bench_->set_kept(value);
        check(bench_->get_kept() == value, "a property of one client");
      });
    case 2:
      return attempt("curve", [&] {
        bench_->set_curve(rr::Array<double>(draw(2000)));
        check(bench_->get_curve().size() < 2000, "a property of all clients");
      });
    case 3:
      return attempt("reversed", [&] {
        rr::Array<double> values(1 + draw(3000));
        for (std::size_t i = 0; i < values.size(); ++i) {
          values.mutate()[i] = static_cast<double>(value + i);
        }
        const rr::Array<double> back = bench_->reversed(values);
        check(back.size() == values.size() && back[0] == values[values.size() - 1], "reversed");
      });
    case 4:
      return attempt("refuse", [&] {
        try {
          bench_->refuse(name_);
          check(false, "a call that is refused");
        } catch (const test::stress::Refused& refused) {
          check(refused.message() == name_, "the text of an exception");
        }
      });
    case 5:
      return attempt("later", [&] { check(bench_->later(value) == mixed(value, 1), "later"); });
    default:
      return attempt("asked",
                     [&] { check(bench_->asked(value) == answered(value), "a callback"); });
  }
}

void Session::call_aside() {
  for (std::uint64_t burst = 1 + draw(30); burst != 0; --burst) {
    const std::uint64_t value = unique(client_number_, random_);
    const std::shared_ptr<SessionState> state = state_;
    ++state->open_calls;
    ++context_.calls;
    const auto done = [state, value, name = name_](const std::exception_ptr& error,
                                                   std::uint64_t result, std::uint64_t key) {
      std::string fault;
      try {
        if (error) std::rethrow_exception(error);
        if (result != mixed(value, key)) fault = "its result is wrong";
      } catch (const Error& caught) {
        if (!state->excuses(caught)) fault = caught.what();
      }
      if (!fault.empty()) state->context.lines.fault(name + ": an asynchronous call: " + fault);
      --state->open_calls;
    };
    const Doing doing(watched_, "starting an asynchronous call");
    if (draw(2) == 0) {
      bench_->async_mix(value, 5, [done](const std::exception_ptr& error, std::uint64_t result) {
        done(error, result, 5);
      });
    } else {
      bench_->async_later(value, [done](const std::exception_ptr& error, std::uint64_t result) {
        done(error, result, 1);
      });
    }
  }
}

void Session::use_memory() {
  const std::uint64_t first = std::uint64_t{place_} * cells_of_a_place;
  const std::size_t count = draw(4) == 0 ? cells_of_a_place : 1 + draw(500);
  rr::Array<std::uint32_t> items(count);
  const auto salt = static_cast<std::uint32_t>(random_());
  for (std::size_t i = 0; i < count; ++i) {
    items.mutate()[i] = salt + static_cast<std::uint32_t>(i);
  }
  attempt("a memory", [&] {
    bench_->cells().write(first, items);
    const rr::Array<std::uint32_t> back = bench_->cells().read(first, count);
    check(std::equal(back.data(), back.data() + count, items.data()), "what a memory holds");
  });
  attempt("a memory's end", [&] {
    try {
      (void)bench_->cells().read(bench_->cells().length(), 1);
      check(false, "a memory's end");
    } catch (const Error& error) {
      if (error.code() != ErrorCode::out_of_range) throw;
    }
  });
}

void Session::use_grid() {
  using test::stress::Cell;
  const std::array<std::uint64_t, 2> position{1, std::uint64_t{place_} * grid_height + 1};
  const std::array<std::uint64_t, 2> count{1 + draw(grid_width - 1), 1 + draw(grid_height - 1)};
  const std::size_t size = static_cast<std::size_t>(count[0] * count[1]);
  std::vector<Cell> cells(size);
  const auto salt = static_cast<std::uint32_t>(random_());
  for (std::size_t i = 0; i < size; ++i) {
    cells[i] = {client_number_, salt + static_cast<std::uint32_t>(i)};
  }
  attempt("a grid", [&] {
    bench_->grid().write(position, count, cells);
    std::vector<Cell> back(size);
    bench_->grid().read(position, count, back);
    check(back == cells, "what a grid holds");
  });
}

void Session::use_generator() {
  const std::uint64_t first = random_();
  const auto steps = static_cast<std::uint32_t>(draw(20));
  attempt("a generator", [&] {
    auto generator = bench_->count(first, steps);
    std::uint64_t taken = 0;
    const std::uint64_t end = draw(2) == 0 ? steps + 1 : draw(steps + 1);
    for (; taken < end; ++taken) {
      const auto value = generator.next();
      if (taken == steps) {
        check(!value, "the end of a generator");
        return;
      }
      check(value == first + taken, "a generator");
    }
    switch (draw(4)) {
      case 0:
        return generator.close();
      case 1:
        return generator.abort();
      case 2:
        open_generators_.push_back(std::move(generator));
        return;
      default:
        return;  // let go
    }
  });
  if (open_generators_.size() > 5) open_generators_.clear();
}

void Session::feed_generator() {
  attempt("a generator that takes", [&] {
    auto generator = bench_->collect(100);
    for (std::uint64_t i = 0, end = draw(10); i < end; ++i) {
      check(generator.next(100 + i), "a generator that takes");
    }
    if (draw(2) == 0) check(!generator.next(0), "the end of a generator that takes");
  });
  attempt("a generator that does both", [&] {
    auto generator = bench_->sum();
    std::uint64_t total = 0;
    for (std::uint64_t i = 0, end = draw(10); i < end; ++i) {
      total += i;
      check(generator.next(i) == total, "a generator that does both");
    }
    if (draw(2) == 0) generator.close();
  });
}

// Parts that nobody locks, but that are released at times, with what is connected to them.
void Session::use_part() {
  const auto index = static_cast<std::int32_t>(part_count - 1 - draw(released_parts));
  const Codes may_be_gone = {ErrorCode::invalid_operation, ErrorCode::operation_aborted,
                             ErrorCode::object_not_found};
  attempt(
      "a part",
      [&] {
        const auto part = bench_->get_parts(index);
        auto end = part->samples().connect();
        auto wire = part->level().connect();
        part->set_value(random_());
        for (const std::uint64_t value : part->count(1, 3)) check(value <= 3, "a part");
        wire.close();
        end.close();
      },
      may_be_gone);
}

void Session::release_part() {
  if (draw(4) != 0) return;
  const auto index = static_cast<std::int32_t>(part_count - 1 - draw(released_parts));
  // Nobody may have reached it since it was released.
  attempt("release", [&] { bench_->release(index); }, {ErrorCode::service_error});
}

void Session::lock_part() {
  const auto index = static_cast<std::int32_t>(draw(locked_parts));
  const Codes busy = {ErrorCode::object_locked_error, ErrorCode::invalid_operation};
  attempt(
      "a lock",
      [&] {
        const auto part = bench_->get_parts(index);
        lock(*part, draw(2) == 0 ? LockOwner::session : LockOwner::user);
        part->get_value();
        unlock(*part);
      },
      busy);
}

void Session::enter_part() {
  const auto index =
      static_cast<std::int32_t>(locked_parts + draw(part_count - released_parts - locked_parts));
  attempt("a monitor",
          [&] {
            const auto part = bench_->get_parts(index);
            const MonitorLock inside(*part, std::chrono::milliseconds(draw(200)));
            const std::uint64_t value = unique(client_number_, random_);
            part->set_value(value);
            part->enter_and_leave();
            check(part->get_value() == value, "a value of whoever is in a monitor");
          },
          {ErrorCode::operation_timeout, ErrorCode::object_locked_error});
}

// Calls from a second thread, until the session ends under it.
void Session::run_companion() {
  const Watchdog::Entry entry(context_.watchdog, name_ + ", second thread");
  Random random(client_number_ + 1);
  while (!is_companion_ending_ && !state_->has_ended) {
    const Doing doing(entry.watched(), "mix");
    ++context_.calls;
    try {
      const std::uint64_t value = random();
      if (bench_->mix(value, 7) != mixed(value, 7)) {
        context_.lines.fault(name_ + ": a call of the second thread is wrong");
      }
    } catch (const Error& error) {
      if (!state_->excuses(error)) {
        context_.lines.fault(name_ + ": a call of the second thread: " + error.what());
      }
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 5000));
  }
}

}  // namespace rr::stress
