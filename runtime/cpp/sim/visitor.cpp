// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/sim/visitor.hpp"

#include <algorithm>
#include <array>
#include <thread>
#include <utility>

#include "rr/async.hpp"
#include "rr/locks.hpp"
#include "runtime/cpp/sim/faults.hpp"
#include "runtime/cpp/sim/host.hpp"
#include "runtime/cpp/sim/scheduler.hpp"
#include "runtime/cpp/stress/everybody.hpp"

namespace rr::sim {
namespace {

using std::chrono::milliseconds;
using test::stress::Stamp;
using Clock = std::chrono::steady_clock;

constexpr milliseconds call_limit{3'000};

// Beyond its time a call may take what threads are held up in a run, and a round of a watch.
milliseconds slack() { return longest_delay() + milliseconds(600); }

// What calls may end with when a link breaks, a host goes or is not there yet.
constexpr std::array excused{
    ErrorCode::connection_error,       ErrorCode::request_timeout,     ErrorCode::invalid_operation,
    ErrorCode::service_not_found,      ErrorCode::operation_aborted,   ErrorCode::invalid_endpoint,
    ErrorCode::operation_timeout,      ErrorCode::object_locked_error, ErrorCode::object_not_found,
    ErrorCode::out_of_system_resource,
};

}  // namespace

NodeOptions impatient_options() {
  NodeOptions options;
  options.request_timeout = call_limit;
  options.connect_timeout = milliseconds(2'000);
  options.first_message_timeout = milliseconds(2'000);
  options.heartbeat_period = milliseconds(1'000);
  options.receive_timeout = milliseconds(4'000);
  options.keep_alive_period = milliseconds(2'000);
  options.client_timeout = milliseconds(8'000);
  options.generator_timeout = milliseconds(8'000);
  return options;
}

/// What functions of streams share with the visitor; one for each connection.
struct Visitor::Streams {
  explicit Streams(stress::Lines& lines, const std::string& name)
      : echo(lines, name + " echo"),
        broadcast(lines, name + " broadcast"),
        ticks(lines, name + " events"),
        level(lines, name + " level") {}
  stress::Consecutive echo;
  stress::Consecutive broadcast;
  stress::Consecutive ticks;
  stress::Rising level;
  std::atomic<int> ends{0};
  std::atomic<int> open_calls{0};
};

Visitor::Visitor(stress::Lines& lines, std::string url, std::string user, std::uint64_t seed,
                 Terms terms)
    : lines_(lines),
      url_(std::move(url)),
      user_(std::move(user)),
      random_(seed),
      terms_(terms),
      node_(impatient_options()) {}

void Visitor::fault(const std::string& what) { lines_.fault(user_ + ": " + what); }

void Visitor::attempt(const char* what, const std::function<void()>& action, milliseconds limit) {
  const auto begin = Clock::now();
  std::string failure;
  try {
    action();
  } catch (const Error& error) {
    // A member without memory may answer with anything.
    const bool is_excused =
        !holds_ && (terms_.is_scarce ||
                    std::find(excused.begin(), excused.end(), error.code()) != excused.end());
    if (!is_excused) failure = error.what();
    Scheduler::current()->note(user_ + ": " + what + " fails: " + error.what());
  }
  const auto took = std::chrono::duration_cast<milliseconds>(Clock::now() - begin);
  if (!failure.empty()) fault(std::string(what) + ": " + failure);
  if (took > limit + slack()) {
    fault(std::string(what) + " took " + std::to_string(took.count()) + " ms of " +
          std::to_string(limit.count()));
  }
}

bool Visitor::connect() {
  streams_ = std::make_shared<Streams>(lines_, user_);
  bool is_connected = false;
  attempt(
      "connect",
      [&] {
        client_ = node_.connect<Bench>(
            url_, {.username = user_,
                   .credentials = {{"password", stress::Everybody::password_of(user_)}},
                   .on_closed = [streams = streams_](const Error&) {
                     expect_no_lock("on_closed");
                     ++streams->ends;
                   }});
        is_connected = true;
      },
      milliseconds(2'000) + 4 * call_limit);
  sent_ = 0;
  return is_connected;
}

void Visitor::connect_streams() {
  const auto streams = streams_;
  const auto bench = client_.stub();
  bench->question().set(
      [pause = milliseconds(random_.below(4) == 0 ? 800 : 0)](std::uint64_t value) {
        expect_no_lock("a callback");
        if (pause.count() != 0) std::this_thread::sleep_for(pause);
        return stress::answered(value);
      });
  subscriptions_.clear();
  // One that takes long keeps what comes after it waiting.
  const milliseconds pause(!holds_ && random_.once_in(3) ? random_.below(60) : 0);
  subscriptions_.push_back(bench->ticked().connect([streams, pause](std::uint64_t number) {
    expect_no_lock("an event");
    streams->ticks.take(number);
    if (pause.count() != 0) std::this_thread::sleep_for(pause);
  }));
  attempt(
      "connect a pipe", [&] { echo_ = bench->echo().connect(); }, call_limit);
  attempt(
      "connect a pipe", [&] { broadcast_ = bench->broadcast().connect(); }, call_limit);
  attempt(
      "connect a wire", [&] { level_ = bench->level().connect(); }, call_limit);
  // A service that is refused memory for what it sends back leaves a packet out.
  if (echo_.is_open() && !terms_.is_scarce) {
    subscriptions_.push_back(echo_.on_packet([streams](const Packet& packet) {
      expect_no_lock("a packet");
      streams->echo.take(packet->number);
    }));
  }
  if (broadcast_.is_open()) {
    subscriptions_.push_back(broadcast_.on_packet([streams](const Packet& packet) {
      expect_no_lock("a packet");
      streams->broadcast.take(packet->number);
    }));
  }
  if (level_.is_open()) {
    subscriptions_.push_back(level_.on_in([streams](const Packet& value, const TimeSpec&) {
      expect_no_lock("a value");
      streams->level.take(value->number, "function");
    }));
  }
}

void Visitor::visit(const std::function<bool()>& is_over) {
  Faults::spare_this_thread();
  while (!is_over()) {
    if (!connect()) {
      std::this_thread::sleep_for(milliseconds(random_.below(300)));
      continue;
    }
    Scheduler::current()->note(user_ + " is connected");
    connect_streams();
    for (std::uint64_t left = random_.below(25); left != 0 && !is_over(); --left) {
      act();
      if (!client_.is_open() && random_.once_in(3)) break;
    }
    attempt(
        "close", [&] { client_.close(); }, milliseconds(500));
    settle_calls();
    echo_ = {};
    broadcast_ = {};
    level_ = {};
  }
}

// Each asynchronous call has ended, and the session once.
void Visitor::settle_calls() {
  const auto deadline = Clock::now() + call_limit + slack();
  while (streams_->open_calls != 0 || streams_->ends == 0) {
    if (Clock::now() > deadline) {
      fault(streams_->ends == 0 ? "on_closed is not called" : "a call does not end");
    }
    std::this_thread::sleep_for(milliseconds(5));
  }
  if (streams_->ends != 1) fault("on_closed is called twice");
}

void Visitor::act() {
  const auto bench = client_.stub();
  switch (random_.below(17)) {
    case 16:
      return connect_while_released();
    case 14:
      return replace_part();
    case 15:
      return send_much();
    case 13:
      return keep_generator();
    case 10:
      return be_asked();
    case 11:
      return reach_part_twice();
    case 12:
      return wait_in_two_threads();
    case 0:
      return use_generator();
    case 1:
      return use_part();
    case 2:
      return call_aside();
    case 3:
      return attempt(
          "a function that asks back",
          [&] {
            const std::uint64_t value = random_.next();
            if (bench->asked(value) != stress::answered(value)) fault("a callback is wrong");
          },
          call_limit);
    case 4:
    case 5:
      for (std::uint64_t burst = 1 + random_.below(10); burst != 0; --burst) {
        attempt(
            "send a packet",
            [&] {
              if (!echo_.is_open()) return;
              echo_.send(Stamp{1, sent_ + 1,
                               Array<double>(!terms_.is_scarce && random_.once_in(8) ? 2'000 : 3)});
              ++sent_;
            },
            milliseconds(0));
      }
      return;
    case 6:
      std::this_thread::sleep_for(milliseconds(random_.below(random_.once_in(10) ? 20'000 : 400)));
      return;
    default:
      return attempt(
          "a function",
          [&] {
            const std::uint64_t value = random_.next();
            if (bench->mix(value, 3) != stress::mixed(value, 3)) fault("a result is wrong");
          },
          call_limit);
  }
}

void Visitor::use_generator() {
  attempt(
      "a generator",
      [&] {
        auto generator = client_.stub()->count(5, 4);
        for (std::uint64_t i = 0; i < 4; ++i) {
          if (generator.next() != 5 + i) fault("a generator's value is wrong");
        }
        if (random_.once_in(2)) generator.close();
      },
      6 * call_limit);
}

// One that nobody uses for a while is there still.
void Visitor::keep_generator() {
  if (!terms_.generators_stay) return;
  attempt(
      "a generator that waits",
      [&] {
        auto generator = client_.stub()->count(7, 4);
        if (generator.next() != 7) fault("a generator's value is wrong");
        std::this_thread::sleep_for(std::chrono::seconds(20));
        try {
          if (generator.next() != 8) fault("a generator's value is wrong");
        } catch (const Error& error) {
          if (client_.is_open() && error.code() == ErrorCode::invalid_operation) {
            fault(std::string("a generator is dropped: ") + error.what());
          }
          throw;
        }
      },
      milliseconds(20'000) + 3 * call_limit);
}

// What the service says of the ends of a released object is not meant for those of the next one.
void Visitor::replace_part() {
  attempt(
      "an object in the place of another",
      [&] {
        const auto bench = client_.stub();
        const auto first = bench->get_parts(terms_.own_part);
        const auto old_end = first->samples().connect();
        auto old_wire = first->level().connect();
        old_wire.close();
        bench->release(terms_.own_part);
        const auto second = bench->get_parts(terms_.own_part);
        auto end = second->samples().connect();
        auto wire = second->level().connect();
        second->set_value(1);
        std::this_thread::sleep_for(milliseconds(100));
        if (client_.is_open() && (!end.is_open() || !wire.is_open())) {
          fault("the end of an object that was released ends those of the next one");
        }
        end.close();
        wire.close();
      },
      8 * call_limit);
}

// A wire that is connected while its object is released belongs to the object that is there then.
void Visitor::connect_while_released() {
  attempt(
      "a wire of an object that is released",
      [&] {
        const auto bench = client_.stub();
        const auto part = bench->get_parts(terms_.own_part);
        std::thread other([this, bench] {
          Faults::spare_this_thread();
          attempt(
              "a release", [&] { bench->release(terms_.own_part); }, call_limit);
        });
        WireConnection<std::uint64_t> wire;
        attempt(
            "connect a wire", [&] { wire = part->level().connect(); }, call_limit);
        other.join();
        const std::uint64_t value = random_.next() | 1U;
        bench->get_parts(terms_.own_part)->set_value(value);
        std::this_thread::sleep_for(milliseconds(500));
        if (!wire.is_open()) return;
        const auto received = wire.try_in();
        if (terms_.links_hold && longest_delay().count() == 0 &&
            (!received || received->value != value)) {
          fault("a wire is connected to an object that is gone");
        }
        wire.close();
      },
      8 * call_limit);
}

// A message that does not fit into what is kept for small ones.
void Visitor::send_much() {
  attempt(
      "a function with many numbers",
      [&] {
        Array<double> values(1'000 + random_.below(3'000));
        values.mutate()[0] = 1;
        const Array<double> back = client_.stub()->reversed(values);
        if (back.size() != values.size() || back.data()[back.size() - 1] != 1) {
          fault("a result is wrong");
        }
      },
      call_limit);
}

// The service looks at the time of its callback, while another member of this client keeps a
// thread.
void Visitor::be_asked() {
  for (const bool rests : {false, true}) {
    ++streams_->open_calls;
    const auto done = [streams = streams_](const std::exception_ptr&, auto... /*result*/) {
      if (--streams->open_calls < 0) Scheduler::current()->fail("a call ends twice");
    };
    attempt(
        "starting a call",
        [&] {
          if (rests) {
            client_.stub()->async_rest(2'000, done);
          } else {
            client_.stub()->async_asked_within(random_.next(), 100, done);
          }
        },
        milliseconds(0));
  }
}

// Two threads use an object that has to be found anew, whose getter asks this client first.
void Visitor::reach_part_twice() {
  const auto index = static_cast<std::int32_t>(4 + random_.below(8));
  std::shared_ptr<test::stress::PartStub> part;
  attempt(
      "an object that asks back",
      [&] {
        part = client_.stub()->get_asking(index);
        try {
          client_.stub()->release_asking(index);
        } catch (const Error& error) {
          if (error.code() != ErrorCode::service_error) throw;  // another visitor was faster
        }
      },
      3 * call_limit);
  if (!part) return;
  const auto reach = [this, part] {
    attempt(
        "a member of an object that asks back", [&] { part->get_value(); },
        terms_.links_hold ? milliseconds(2'000) : call_limit);
  };
  std::thread other([reach] {
    Faults::spare_this_thread();
    reach();
  });
  reach();
  other.join();
}

// One packet is there for both threads that wait for it.
void Visitor::wait_in_two_threads() {
  PipeEndpoint<Packet> end;
  attempt(
      "connect a pipe", [&] { end = client_.stub()->echo().connect(); }, call_limit);
  if (!end.is_open()) return;
  std::atomic<int> received{0};
  std::vector<std::thread> threads;
  const auto begin = Clock::now();
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&received, end] {
      Faults::spare_this_thread();
      if (end.wait(call_limit)) ++received;
    });
  }
  std::this_thread::sleep_for(milliseconds(random_.below(10)));
  attempt(
      "send a packet",
      [&] {
        end.send(Stamp{1, 1, {}});
      },
      milliseconds(0));
  for (std::thread& each : threads) each.join();
  const auto took = Clock::now() - begin;
  const bool is_slow = took >= call_limit && longest_delay().count() == 0;
  if (received == 1 || (received == 2 && is_slow)) fault("a packet wakes one of two threads");
  attempt(
      "close a pipe", [&] { end.close(); }, milliseconds(500));
}

void Visitor::use_part() {
  attempt(
      "a lock",
      [&] {
        const auto part = client_.stub()->get_parts(static_cast<std::int32_t>(random_.below(2)));
        const bool is_of_session = random_.once_in(2);
        lock(*part, is_of_session ? LockOwner::session : LockOwner::user);
        Scheduler::current()->note(user_ + (is_of_session ? " locks for its session" : " locks"));
        part->get_value();
        if (!random_.once_in(3)) unlock(*part);
      },
      4 * call_limit);
  attempt(
      "a monitor",
      [&] {
        const auto part = client_.stub()->get_parts(3);
        const bool has_limit = !random_.once_in(4);
        try {
          const MonitorLock inside(*part,
                                   has_limit ? milliseconds(random_.below(500)) : wait_forever);
          part->enter_and_leave();
        } catch (const Error& error) {
          if (!has_limit && error.code() == ErrorCode::operation_timeout) {
            fault("a monitor without a limit runs out of time");
          }
          throw;
        }
      },
      milliseconds(60'000));
}

void Visitor::call_aside() {
  for (std::uint64_t burst = 1 + random_.below(8); burst != 0; --burst) {
    const std::uint64_t value = random_.next();
    ++streams_->open_calls;
    attempt(
        "starting a call",
        [&] {
          client_.stub()->async_mix(value, 9,
                                    [streams = streams_, value, this, begin = Clock::now()](
                                        const std::exception_ptr& error, std::uint64_t result) {
                                      expect_no_lock("a completion");
                                      if (!error && result != stress::mixed(value, 9))
                                        fault("a result is wrong");
                                      if (Clock::now() - begin > call_limit + slack())
                                        fault("a call ends late");
                                      if (--streams->open_calls < 0) fault("a call ends twice");
                                    });
        },
        milliseconds(0));
  }
}

void Visitor::expect_all_well() {
  const auto deadline = Clock::now() + std::chrono::seconds(30);
  while (!connect()) {
    if (Clock::now() > deadline) fault("cannot connect, though all links hold");
    std::this_thread::sleep_for(milliseconds(100));
  }
  holds_ = true;
  connect_streams();
  const auto bench = client_.stub();
  // What others have locked goes with their sessions.
  for (std::int32_t i = 0; i < 2; ++i) {
    const auto part = bench->get_parts(i);
    while (true) {
      try {
        lock(*part);
        unlock(*part);
        break;
      } catch (const Error& error) {
        if (Clock::now() > deadline) fault(std::string("a lock stays: ") + error.what());
        std::this_thread::sleep_for(milliseconds(100));
      }
    }
  }
  attempt(
      "a monitor",
      [&] {
        const auto part = bench->get_parts(3);
        const MonitorLock inside(*part, milliseconds(35'000));
        part->enter_and_leave();
      },
      milliseconds(35'000));
  echo_.send(Stamp{1, 1, {}});
  call_aside();
  use_generator();
  const auto soon = Clock::now() + std::chrono::seconds(20);
  while (streams_->echo.last() != 1 || streams_->level.last() == 0 ||
         streams_->broadcast.last() == 0 || streams_->ticks.last() == 0) {
    if (Clock::now() > soon) fault("a stream brings nothing, though all links hold");
    std::this_thread::sleep_for(milliseconds(20));
  }
  client_.close();
  settle_calls();
}

}  // namespace rr::sim
