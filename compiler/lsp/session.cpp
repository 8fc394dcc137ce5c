// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/session.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>

#include "compiler/lsp/framing.hpp"
#include "compiler/lsp/server.hpp"

namespace robdef::lsp {
namespace {

/// A message that waits, or what was wrong where one should have been.
struct Waiting {
  Json message{};
  std::size_t size = 0;
  bool is_cancelled = false;
  bool is_end = false;
  ErrorCode code{};     ///< of a fault
  std::string fault{};  ///< empty: there is a message
};

/// Holds as much as one largest message, whoever is slower.
class Queue {
 public:
  void push(Waiting waiting) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return size_ == 0 || size_ + waiting.size <= largest_body; });
    size_ += waiting.size;
    waiting_.push_back(std::move(waiting));
    changed_.notify_all();
  }

  Waiting pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !waiting_.empty(); });
    Waiting first = std::move(waiting_.front());
    waiting_.pop_front();
    size_ -= first.size;
    changed_.notify_all();
    return first;
  }

  void cancel(const Json& id) {
    const std::lock_guard lock(mutex_);
    for (Waiting& one : waiting_) {
      const bool is_meant = one.message.is_object() && one.message.contains("method") &&
                            at_path(one.message, {"id"}) == id && !id.is_null();
      if (is_meant) one.is_cancelled = true;
    }
  }

  [[nodiscard]] bool is_empty() const {
    const std::lock_guard lock(mutex_);
    return waiting_.empty();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::size_t size_ = 0;
};

// Until the client says `exit`, or nothing more can come.
void read_all(std::istream& in, Queue& queue) {
  for (;;) {
    Framed framed = read_message(in);
    if (framed.kind == Framed::Kind::unfit) {
      queue.push({.code = ErrorCode::invalid_request, .fault = framed.fault});
      continue;
    }
    if (framed.kind == Framed::Kind::lost) {
      queue.push({.code = ErrorCode::parse_error, .fault = framed.fault});
    }
    if (framed.kind != Framed::Kind::body) {
      queue.push({.is_end = true});
      return;
    }
    const std::size_t size = framed.body.size();
    Json message = Json::parse(framed.body, nullptr, false);
    framed.body.clear();
    if (message.is_discarded()) {
      queue.push({.code = ErrorCode::parse_error, .fault = "the message is no JSON in UTF-8"});
      continue;
    }
    const Json& method = at_path(message, {"method"});
    if (method == Json("$/cancelRequest")) {
      queue.cancel(at_path(message, {"params", "id"}));
      continue;
    }
    const bool is_exit = method == Json("exit");
    queue.push({.message = std::move(message), .size = size});
    if (is_exit) return;
  }
}

}  // namespace

int serve(WorkspaceOptions options, std::istream& in, std::ostream& out) {
  Server server(std::move(options), [&out](const Json& message) {
    write_message(out, message.dump(-1, ' ', false, Json::error_handler_t::replace));
  });
  Queue queue;
  std::jthread reader([&] { read_all(in, queue); });
  while (!server.is_ended()) {
    Waiting next = queue.pop();
    if (next.is_end) {
      server.publish();
      break;
    }
    if (!next.fault.empty()) {
      server.report_unreadable(next.code, next.fault);
    } else if (next.is_cancelled) {
      server.refuse_cancelled(next.message);
    } else {
      server.take(next.message);
    }
    if (server.has_to_publish() && queue.is_empty()) server.publish();
  }
  return server.exit_code();
}

}  // namespace robdef::lsp
