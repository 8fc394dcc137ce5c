// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/execution_context.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <cstddef>
#include <deque>
#include <memory>
#include <utility>

#include "runtime/cpp/src/channel/layer.hpp"

namespace rr::channel {

/// Work of any type, to be done once.
class Work {
 public:
  virtual ~Work() = default;
  virtual void run() = 0;
};

template <class Function>
std::unique_ptr<Work> make_work(Function&& function) {
  class Kept final : public Work {
   public:
    explicit Kept(Function&& kept) : function_(std::forward<Function>(kept)) {}
    void run() override { std::move(function_)(); }

   private:
    std::decay_t<Function> function_;
  };
  return std::make_unique<Kept>(std::forward<Function>(function));
}

/// The two ends of a stream in memory, and what is to be done with them: no socket, no thread.
struct MemoryEnds {
  Bytes in;
  std::size_t in_at = 0;
  Bytes out;
  std::deque<std::unique_ptr<Work>> work;
  std::unique_ptr<Work> reading;  // waits for bytes

  /// Does all that can be done with the bytes that are there.
  void run() {
    while (true) {
      if (reading && in_at != in.size()) {
        const std::unique_ptr<Work> next = std::move(reading);
        next->run();
      } else if (!work.empty()) {
        const std::unique_ptr<Work> next = std::move(work.front());
        work.pop_front();
        next->run();
      } else {
        return;
      }
    }
  }
};

/// Runs handlers when MemoryEnds::run() is called.
class MemoryExecutor {
 public:
  MemoryExecutor(boost::asio::execution_context& context, MemoryEnds& ends)
      : context_(&context), ends_(&ends) {}

  [[nodiscard]] boost::asio::execution_context& context() const noexcept { return *context_; }
  void on_work_started() const noexcept {}
  void on_work_finished() const noexcept {}
  template <class Function, class Allocator>
  void dispatch(Function&& function, const Allocator&) const {
    add(std::forward<Function>(function));
  }
  template <class Function, class Allocator>
  void post(Function&& function, const Allocator&) const {
    add(std::forward<Function>(function));
  }
  template <class Function, class Allocator>
  void defer(Function&& function, const Allocator&) const {
    add(std::forward<Function>(function));
  }
  friend bool operator==(const MemoryExecutor& a, const MemoryExecutor& b) noexcept {
    return a.ends_ == b.ends_;
  }
  friend bool operator!=(const MemoryExecutor& a, const MemoryExecutor& b) noexcept {
    return !(a == b);
  }

 private:
  template <class Function>
  void add(Function&& function) const {
    ends_->work.push_back(make_work([kept = std::decay_t<Function>(std::forward<Function>(
                                         function))]() mutable { std::move(kept)(); }));
  }

  boost::asio::execution_context* context_;
  MemoryEnds* ends_;
};

/// A stream of Asio over such ends.
class MemoryStream {
 public:
  /// What the library's own timers, which are never started, belong to; handlers are bound to a
  /// MemoryExecutor.
  using executor_type = boost::asio::io_context::executor_type;
  MemoryStream(boost::asio::io_context& context, MemoryEnds& ends)
      : context_(&context), ends_(&ends) {}

  [[nodiscard]] executor_type get_executor() const noexcept { return context_->get_executor(); }

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    ends_->reading =
        make_work([ends = ends_, buffers,
                   kept = std::decay_t<Handler>(std::forward<Handler>(handler))]() mutable {
          const std::size_t size = boost::asio::buffer_copy(
              buffers,
              boost::asio::buffer(ends->in.data() + ends->in_at, ends->in.size() - ends->in_at));
          ends->in_at += size;
          if (ends->in_at == ends->in.size()) {
            ends->in.clear();
            ends->in_at = 0;
          }
          std::move(kept)(boost::beast::error_code(), size);
        });
  }

  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    const std::size_t before = ends_->out.size();
    for (auto it = boost::asio::buffer_sequence_begin(buffers);
         it != boost::asio::buffer_sequence_end(buffers); ++it) {
      const boost::asio::const_buffer part = *it;
      append(ends_->out, {static_cast<const std::byte*>(part.data()), part.size()});
    }
    const std::size_t size = ends_->out.size() - before;
    add([size, kept = std::decay_t<Handler>(std::forward<Handler>(handler))]() mutable {
      std::move(kept)(boost::beast::error_code(), size);
    });
  }

  template <class Function>
  void add(Function&& function) {
    ends_->work.push_back(make_work(std::forward<Function>(function)));
  }

 private:
  boost::asio::io_context* context_;
  MemoryEnds* ends_;
};

// The socket below is closed by whoever owns it.
inline void teardown(boost::beast::role_type /*role*/, MemoryStream& /*stream*/,
                     boost::beast::error_code& error) {
  error = {};
}
template <class Handler>
void async_teardown(boost::beast::role_type /*role*/, MemoryStream& stream, Handler&& handler) {
  stream.add([kept = std::decay_t<Handler>(std::forward<Handler>(handler))]() mutable {
    std::move(kept)(boost::beast::error_code());
  });
}
inline void beast_close_socket(MemoryStream& /*stream*/) {}

}  // namespace rr::channel
