// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/serial/lines.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "rr/error.hpp"
#include "rr/mutex.hpp"

namespace rr::serial {

// Line

Line::Line(const BoardPlace& place)
    : place_(place),
      space_(std::make_shared<IntraSpace>()),
      node_({.name = "robdef.serial", .intra = space_}),
      board_(node_, place,
             {.met = [this](const std::string& name) { on_met(name); },
              .failed = [this](const Board::Failure& failure) { on_failed(failure); }}) {
  node_.listen("rr+intra://");
}

void Line::on_met(const std::string& name) {
  const MutexLock lock(mutex_);
  name_ = name;
  changed_.notify_all();
}

void Line::on_failed(const Board::Failure& failure) {
  const MutexLock lock(mutex_);
  failure_ = failure;
  ++failures_;
  changed_.notify_all();
}

std::string Line::wait(Deadline deadline) {
  const MutexLock lock(mutex_);
  const std::size_t before = failures_;
  // A board that does not answer may be one that starts.
  (void)changed_.wait_until(mutex_, deadline, [&]() RR_REQUIRES(mutex_) {
    return name_ || (failures_ != before && failure_.kind != Board::Failure::Kind::silent);
  });
  if (name_) return *name_;
  throw Error(ErrorCode::connection_error,
              failures_ != 0 ? failure_.text : "the board at " + place_.path + " does not answer");
}

std::unique_ptr<MessageLink> Line::connect() {
  Url url;
  url.node_id = node_.id();
  return space_->channel({}, {})->connect(url, Deadline::max());
}

// Lines

struct Lines::State {
  Mutex mutex;
  Condition changed;
  std::map<std::string, std::shared_ptr<Line>> lines
      RR_GUARDED_BY(mutex);  // by path; null: it is being closed
  bool has_ended RR_GUARDED_BY(mutex) = false;

  [[nodiscard]] bool is_closing(const std::string& path) const RR_REQUIRES(mutex) {
    const auto found = lines.find(path);
    return found != lines.end() && !found->second;
  }
  void close_unused();
};

Lines::Lines()
    : state_(std::make_shared<State>()), thread_([state = state_] { state->close_unused(); }) {}

Lines::~Lines() {
  {
    const MutexLock lock(state_->mutex);
    state_->has_ended = true;
  }
  state_->changed.notify_all();
  thread_.join();
}

std::shared_ptr<Lines> Lines::of_process() {
  static Mutex mutex;
  static std::weak_ptr<Lines> known RR_GUARDED_BY(mutex);
  const MutexLock lock(mutex);
  std::shared_ptr<Lines> lines = known.lock();
  if (!lines) known = lines = std::make_shared<Lines>();
  return lines;
}

std::unique_ptr<Lines::User> Lines::take(const BoardPlace& place, Deadline deadline) const {
  // As written: a link below /dev/serial names the same board whichever port it is plugged into.
  const std::string key = std::filesystem::path(place.path).lexically_normal().string();
  const MutexLock lock(state_->mutex);
  const auto is_usable = [&]() RR_REQUIRES(state_->mutex) { return !state_->is_closing(key); };
  if (!state_->changed.wait_until(state_->mutex, deadline, is_usable)) {
    throw Error(ErrorCode::connection_error, place.path + " is being closed");
  }
  auto found = state_->lines.find(key);
  if (found == state_->lines.end()) {
    found = state_->lines.emplace(key, std::make_shared<Line>(place)).first;
  }
  Line& line = *found->second;
  if (line.place().baud != place.baud) {
    throw Error(ErrorCode::invalid_argument,
                place.path + " is in use at " + std::to_string(line.place().baud) + " baud");
  }
  auto user = std::make_unique<User>(state_, found->second);
  ++line.users_;
  line.kept_until_ = {};
  return user;
}

void Lines::State::close_unused() {
  MutexLock lock(mutex);
  while (true) {
    const auto now = std::chrono::steady_clock::now();
    Deadline next = Deadline::max();
    const auto unused =
        std::find_if(lines.begin(), lines.end(), [&](const auto& entry) RR_REQUIRES(mutex) {
          const Line& line = *entry.second;
          if (line.users_ != 0) return false;
          if (has_ended || line.kept_until_ <= now) return true;
          next = std::min(next, line.kept_until_);
          return false;
        });
    if (unused != lines.end()) {
      const std::string path = unused->first;
      std::shared_ptr<Line> line = std::exchange(unused->second, nullptr);
      lock.unlock();
      line.reset();
      lock.lock();
      lines.erase(path);
      changed.notify_all();
    } else if (has_ended && lines.empty()) {
      return;
    } else if (next == Deadline::max()) {
      changed.wait(mutex);
    } else {
      changed.wait_until(mutex, next);
    }
  }
}

// Lines::User

Lines::User::User(std::shared_ptr<State> state, std::shared_ptr<Line> line)
    : state_(std::move(state)), line_(std::move(line)) {}

Lines::User::~User() {
  const MutexLock lock(state_->mutex);
  line_->kept_until_ = std::max(line_->kept_until_, kept_until_);
  --line_->users_;
  // The line goes on the thread that closes it, never here.
  line_.reset();
  state_->changed.notify_all();
}

}  // namespace rr::serial
