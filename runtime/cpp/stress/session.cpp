// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/session.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "runtime/cpp/stress/bench.hpp"
#include "runtime/cpp/stress/everybody.hpp"
#include "runtime/cpp/stress/roles.hpp"

namespace rr::stress {

SessionState::SessionState(ChannelContext& its_ground, const std::string& name)
    : context(its_ground),
      ticks(its_ground.lines, name + " events"),
      broadcast(its_ground.lines, name + " broadcast"),
      echo(its_ground.lines, name + " echo"),
      level(its_ground.lines, name + " level"),
      level_polled(its_ground.lines, name + " level"),
      mirror(its_ground.lines, name + " mirror") {}

Session::Session(ChannelContext& context, Watchdog::Watched& watched, std::uint32_t client,
                 std::uint32_t serial, std::uint32_t seed)
    : context_(context),
      watched_(watched),
      client_number_(client),
      place_(client * places_of_a_client + serial % places_of_a_client),
      name_("client " + std::to_string(client) + " session " + std::to_string(serial)),
      random_(seed),
      state_(std::make_shared<SessionState>(context, name_)) {}

Session::~Session() {
  is_companion_ending_ = true;
  if (companion_.joinable()) companion_.join();
}

std::uint64_t Session::draw(std::uint64_t below) { return random_() % below; }

void Session::check(bool holds, const char* what) {
  if (!holds) context_.lines.fault(name_ + ": " + what + " is wrong");
}

void Session::attempt(const char* what, const std::function<void()>& action, Codes allowed) {
  const Doing doing(watched_, what);
  ++context_.calls;
  try {
    action();
  } catch (const Error& error) {
    if (std::find(allowed.begin(), allowed.end(), error.code()) != allowed.end()) return;
    if (state_->excuses(error)) return;
    context_.lines.fault(name_ + ": " + what + ": " + error.what());
  }
}

void Session::wait_for(const char* what, const std::function<bool()>& holds) {
  const Doing doing(watched_, what);
  const auto deadline = std::chrono::steady_clock::now() + patience();
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) {
      context_.lines.fault(name_ + ": waited in vain for " + what);
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

bool Session::connect(Node& node) {
  const std::string user = "user" + std::to_string(client_number_ % 8);
  bool is_connected = false;
  const auto connecting = [&] {
    attempt("connect", [&] {
      client_ = node.connect<BenchStub>(
          context_.url,
          {.username = user,
           .credentials = {{"password", Everybody::password_of(user)}},
           .on_closed = [state = state_](const Error& why) {
             state->has_ended = true;
             ++state->ends_told;
             if (state->may_end) return;
             state->context.lines.fault(std::string("a session ended: ") + why.what());
           }});
      is_connected = true;
    });
  };
  if (draw(2) == 0) {
    socket_ = context_.cutter.connect_and_find(connecting);
  } else {
    context_.cutter.connect(connecting);
  }
  if (is_connected) bench_ = client_.stub();
  return is_connected;
}

void Session::use(Node& shared, const std::function<bool()>& is_over) {
  std::optional<Node> own;
  if (draw(4) == 0) {
    own.emplace(NodeOptions{.client_offer = {.message_v4 = draw(2) == 0},
                            .request_timeout = hang_limit(),
                            .connect_timeout = hang_limit(),
                            .receive_timeout = hang_limit()});
  }
  if (!connect(own ? *own : shared)) return;
  ++context_.sessions;
  connect_streams();
  if (draw(4) == 0) companion_ = std::thread([this] { run_companion(); });
  const std::uint64_t actions = draw(8) == 0 ? 1000 : draw(150);
  for (std::uint64_t i = 0; i < actions && !is_over(); ++i) act();
  if (draw(3) != 0) settle();

  End end = End::close;
  const std::uint64_t chosen = draw(10);
  if (!socket_.empty() && chosen < 6) {
    end = chosen < 3 ? End::cut : End::reset;
  } else if (chosen == 9) {
    end = End::sent_away;
  } else if (own && chosen > 4) {
    end = End::node;
  }
  if (end == End::node) {
    state_->may_end = true;
    const Doing doing(watched_, "~Node");
    own.reset();
  }
  finish(end);
  const Doing doing(watched_, "the end of a session and its node");
  client_ = {};
  own.reset();
}

void Session::finish(End end) {
  state_->may_end = true;
  switch (end) {
    case End::close: {
      const Doing doing(watched_, "close");
      client_.close();
      break;
    }
    case End::cut:
    case End::reset:
      context_.cutter.cut(socket_, end == End::reset);
      break;
    case End::sent_away:
      attempt("send_away", [&] { bench_->send_away(); });
      break;
    case End::node:
      break;
  }
  const bool is_lost = end == End::cut || end == End::reset;
  expect_the_end(is_lost ? ErrorCode::connection_error : ErrorCode::invalid_operation);
  is_companion_ending_ = true;
  if (companion_.joinable()) {
    const Doing doing(watched_, "waiting for the second thread");
    companion_.join();
  }
  wait_for("on_closed", [&] { return state_->ends_told != 0; });
  wait_for("the completions of open calls", [&] { return state_->open_calls == 0; });
  check(state_->ends_told == 1, "the number of calls of on_closed");
}

void Session::expect_the_end(ErrorCode why) {
  // What is done now fails, and soon: the first few may still find the connection.
  wait_for("the end of a session", [&] { return !client_.is_open(); });
  const Doing doing(watched_, "a call after the end");
  try {
    bench_->mix(1, 2);
    context_.lines.fault(name_ + ": a call is answered after the end");
  } catch (const Error& error) {
    // What one side ends, the other may have lost a moment before.
    if (error.code() != why && error.code() != ErrorCode::connection_error) {
      context_.lines.fault(name_ + ": a call after the end: " + error.what());
    }
  }
  if (has_broadcast_) wait_for("a pipe's end", [&] { return !broadcast_.is_open(); });
  if (has_echo_) wait_for("a pipe's end", [&] { return !echo_.is_open(); });
  if (has_level_) wait_for("a wire's end", [&] { return !level_.is_open(); });
  if (has_mirror_) wait_for("a wire's end", [&] { return !mirror_.is_open(); });
}

}  // namespace rr::stress
