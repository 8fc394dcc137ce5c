// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/board.hpp"

#include <future>
#include <random>
#include <utility>

#include "rr/printable.hpp"

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
/// Bytes of what a board says about a refusal.
constexpr std::size_t longest_reason = 1000;

const Outcome no_board{.kind = Outcome::Kind::reset};

}  // namespace

Board::Board(const std::string& path, std::uint32_t baud, Functions functions)
    : functions_(std::move(functions)),
      port_(Port::to(path, baud)),
      link_(port_->timing()),
      session_(static_cast<std::uint16_t>(std::random_device{}())) {}

Board::~Board() { stop(); }

void Board::start() {
  thread_ = std::thread([this] { run(); });
}

void Board::stop() {
  stops_ = true;
  port_->wake();
  if (thread_.joinable()) thread_.join();
  fail_jobs();
}

Time Board::now() const {
  return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now().time_since_epoch());
}

void Board::ask(Kind kind, std::vector<std::uint8_t> body, std::chrono::milliseconds patience,
                Done done, std::uint32_t client) {
  {
    const MutexLock lock(mutex_);
    if (is_connected_ && !stops_ && jobs_.size() < most_jobs) {
      jobs_.push_back({kind, std::move(body), patience, std::move(done), false, client});
      port_->wake();
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

void Board::set_wire(std::vector<std::uint8_t> body, Done done) {
  const MutexLock lock(mutex_);
  if (!is_connected_ || stops_) return;
  for (Job& job : jobs_) {
    if (!job.is_wire || job.body[0] != body[0] || job.body[1] != body[1]) continue;
    job.body = std::move(body);
    return;
  }
  jobs_.push_back({Kind::Packet, std::move(body), 2s, std::move(done), true, 0});
  port_->wake();
}

void Board::run() {
  while (!stops_) {
    if (!port_->is_open()) {
      const std::string why = port_->open([this] { return stops_.load(); });
      if (!why.empty()) {
        lose("its port cannot be opened");
        if (!stops_) functions_.failed({Failure::Kind::port, path() + " " + why});
        (void)port_->read(pause);
        continue;
      }
    }
    if (!link_.has_session()) {
      if (had_session_) lose("it has been reset, or does not answer");
      if (!connect()) (void)port_->read(pause);
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
    const MutexLock lock(mutex_);
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
  if (hello.kind != Outcome::Kind::reply) {
    if (port_->is_renewed() && !port_->is_open()) {
      return fail(Failure::Kind::silent, "has closed the connection: it serves one host at a time");
    }
    if (port_->is_renewed()) port_->close();
    return fail(Failure::Kind::silent, "does not answer");
  }
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

std::optional<std::string> Board::read_text(std::uint8_t number, std::size_t longest) {
  std::string text;
  for (;;) {
    const std::size_t at = text.size();
    const Outcome outcome =
        exchange(Kind::Text,
                 {number, static_cast<std::uint8_t>(at & 0xFF), static_cast<std::uint8_t>(at >> 8)},
                 text_patience);
    if (outcome.kind != Outcome::Kind::reply || outcome.body.size() < 3) return std::nullopt;
    if (outcome.body.size() == 3) return text;
    text.append(outcome.body.begin() + 3, outcome.body.end());
    if (text.size() > longest) return std::nullopt;
  }
}

bool Board::read_texts() {
  BoardTexts read{.hash = link_.facts().hash, .texts = {}};
  for (std::uint8_t number = 0; number < link_.facts().texts; ++number) {
    std::optional<std::string> text = read_text(number, 0xFFFF);
    if (!text) return false;
    read.texts.push_back(std::move(*text));
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

Outcome Board::exchange(Kind kind, std::vector<std::uint8_t> body, Time patience) {
  link_.request(kind, std::move(body), now(), patience);
  clients_[link_.sequence()] = client_;
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
  if (!out.empty() && !port_->write(out)) {
    link_.lose_session();
    return;
  }
  const auto in = port_->read(limit);
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
  if (holds_unasked_) return;
  for (const Unasked& one : link_.take_unasked()) functions_.unasked(one);
}

Outcome Board::serve(Job& job) {
  const std::size_t longest = link_.facts().longest_request;
  if (job.body.size() > longest) {
    // The board would drop it without a word.
    return {.kind = Outcome::Kind::too_long,
            .reason = "the request has " + std::to_string(job.body.size()) +
                      " bytes, and the board takes " + std::to_string(longest) + " at most"};
  }
  if (job.client != 0) client_ = job.client;
  Outcome outcome = exchange(job.kind, std::move(job.body), job.patience);
  if (!outcome.has_reason) return outcome;
  // What the board says by itself meanwhile comes behind the answer.
  holds_unasked_ = true;
  outcome.reason = printable(read_text(reasonText, longest_reason).value_or(""), longest_reason);
  holds_unasked_ = false;
  return outcome;
}

void Board::serve_one() {
  Job job;
  bool has_job = false;
  {
    const MutexLock lock(mutex_);
    if (!jobs_.empty()) {
      job = std::move(jobs_.front());
      jobs_.pop_front();
      has_job = true;
    }
  }
  if (has_job) {
    job.done(serve(job));
    tell_unasked();
  } else if (now() - link_.heard() > silence) {
    (void)exchange(Kind::Ping, {}, port_->timing().silence);
  } else {
    pass(silence);
  }
  // What was sent meanwhile has to be acknowledged.
  const std::vector<std::uint8_t> out = link_.take_output();
  if (!out.empty() && !port_->write(out)) link_.lose_session();
}

}  // namespace rr::serial
