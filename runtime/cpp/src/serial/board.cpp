// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/board.hpp"

#include <future>
#include <random>
#include <utility>

namespace rr::serial {

using namespace std::chrono_literals;

namespace {

/// More requests than this do not wait: the board is too slow for what is asked of it.
constexpr std::size_t most_jobs = 256;
constexpr Time hello_patience = 2s;
constexpr Time text_patience = 2s;
/// Between attempts to open a port, or to find a board at one.
constexpr Time pause = 200ms;
constexpr Time silence = 1s;

const Outcome no_board{.kind = Outcome::Kind::reset};

}  // namespace

Board::Board(std::string path, std::uint32_t baud, Functions functions)
    : functions_(std::move(functions)),
      port_(std::move(path), baud),
      link_(baud),
      session_(static_cast<std::uint16_t>(std::random_device{}())) {
  Port::check_rate(baud);
}

Board::~Board() { stop(); }

void Board::start() {
  thread_ = std::thread([this] { run(); });
}

void Board::stop() {
  stops_ = true;
  port_.wake();
  if (thread_.joinable()) thread_.join();
  fail_jobs();
}

Time Board::now() const {
  return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now().time_since_epoch());
}

void Board::ask(Kind kind, std::vector<std::uint8_t> body, std::chrono::milliseconds patience,
                Done done, std::uint32_t client) {
  {
    const std::lock_guard lock(mutex_);
    if (is_connected_ && !stops_ && jobs_.size() < most_jobs) {
      jobs_.push_back({kind, std::move(body), patience, std::move(done), false, client});
      port_.wake();
      return;
    }
  }
  done(no_board);
}

Outcome Board::ask(Kind kind, std::vector<std::uint8_t> body, std::chrono::milliseconds patience) {
  const auto promise = std::make_shared<std::promise<Outcome>>();
  std::future<Outcome> outcome = promise->get_future();
  ask(kind, std::move(body), patience, [promise](const Outcome& one) { promise->set_value(one); });
  return outcome.get();
}

void Board::set_wire(std::vector<std::uint8_t> body) {
  const std::lock_guard lock(mutex_);
  if (!is_connected_ || stops_) return;
  for (Job& job : jobs_) {
    if (!job.is_wire || job.body[0] != body[0] || job.body[1] != body[1]) continue;
    job.body = std::move(body);
    return;
  }
  jobs_.push_back({Kind::Packet, std::move(body), 2s, [](const Outcome&) {}, true, 0});
  port_.wake();
}

void Board::run() {
  while (!stops_) {
    if (!port_.is_open()) {
      const std::string why = port_.open();
      if (!why.empty()) {
        lose("its port cannot be opened");
        functions_.failed({Failure::Kind::port, path() + " " + why});
        (void)port_.read(pause);
        continue;
      }
    }
    if (!link_.has_session()) {
      if (had_session_) lose("it has been reset, or does not answer");
      if (!connect()) (void)port_.read(pause);
      continue;
    }
    serve_one();
  }
  lose("the bridge has ended");
}

void Board::lose(const std::string& why) {
  is_connected_ = false;
  if (std::exchange(had_session_, false)) functions_.lost(why);
  fail_jobs();
}

void Board::fail_jobs() {
  std::deque<Job> jobs;
  {
    const std::lock_guard lock(mutex_);
    jobs.swap(jobs_);
  }
  for (const Job& job : jobs) job.done(no_board);
}

bool Board::connect() {
  if (++session_ == 0) ++session_;
  link_.begin_session(session_, now(), hello_patience);
  const Outcome hello = await();
  if (hello.kind == Outcome::Kind::version) {
    return fail(Failure::Kind::unusable, "speaks version " + std::to_string(hello.code) +
                                             " of the protocol, and not " +
                                             std::to_string(protocolVersion));
  }
  if (hello.kind != Outcome::Kind::reply) return fail(Failure::Kind::silent, "does not answer");
  const bool is_new = texts_.texts.empty() || texts_.hash != link_.facts().hash;
  if (is_new && !read_texts()) return fail(Failure::Kind::silent, "has told no whole definition");
  had_session_ = true;
  is_connected_ = true;
  functions_.connected(texts_, is_new);
  return true;
}

bool Board::fail(Failure::Kind kind, const std::string& what) {
  if (!stops_) functions_.failed({kind, "the board at " + path() + " " + what});
  return false;
}

bool Board::read_texts() {
  BoardTexts read{.hash = link_.facts().hash, .texts = {}};
  for (std::uint8_t number = 0; number < link_.facts().texts; ++number) {
    std::string text;
    for (;;) {
      const std::size_t at = text.size();
      const Outcome outcome = exchange(
          Kind::Text,
          {number, static_cast<std::uint8_t>(at & 0xFF), static_cast<std::uint8_t>(at >> 8)},
          text_patience);
      if (outcome.kind != Outcome::Kind::reply || outcome.body.size() < 3) return false;
      if (outcome.body.size() == 3) break;
      text.append(outcome.body.begin() + 3, outcome.body.end());
      if (text.size() > 0xFFFF) return false;
    }
    read.texts.push_back(std::move(text));
  }
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const std::string& text : read.texts) {
    for (const char byte : text + '\0') {
      hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001B3;
    }
  }
  if (hash != read.hash) return false;
  texts_ = std::move(read);
  return true;
}

Outcome Board::exchange(Kind kind, std::vector<std::uint8_t> body, Time patience,
                        std::uint32_t client) {
  link_.request(kind, std::move(body), now(), patience);
  clients_[link_.sequence()] = client;
  return await();
}

Outcome Board::await() {
  for (;;) {
    if (std::optional<Outcome> outcome = link_.take_outcome()) return *outcome;
    if (stops_) return no_board;
    pass(std::max<Time>(link_.wake_up().value_or(now()) - now(), 0us));
  }
}

void Board::pass(Time limit) {
  const std::vector<std::uint8_t> out = link_.take_output();
  if (!out.empty() && !port_.write(out)) {
    link_.lose_session();
    return;
  }
  const auto in = port_.read(limit);
  if (!in) {
    link_.lose_session();
    return;
  }
  link_.receive(*in, now());
  link_.tick(now());
  tell_unasked();
}

// What comes behind an answer waits until that has been passed on.
void Board::tell_unasked() {
  for (const Unasked& one : link_.take_unasked()) functions_.unasked(one);
}

void Board::serve_one() {
  Job job;
  bool has_job = false;
  {
    const std::lock_guard lock(mutex_);
    if (!jobs_.empty()) {
      job = std::move(jobs_.front());
      jobs_.pop_front();
      has_job = true;
    }
  }
  if (has_job) {
    const Outcome outcome = exchange(job.kind, std::move(job.body), job.patience, job.client);
    job.done(outcome);
    tell_unasked();
  } else if (now() - link_.heard() > silence) {
    (void)exchange(Kind::Ping, {}, silence);
  } else {
    pass(silence);
  }
  // What was sent meanwhile has to be acknowledged.
  const std::vector<std::uint8_t> out = link_.take_output();
  if (!out.empty() && !port_.write(out)) link_.lose_session();
}

}  // namespace rr::serial
