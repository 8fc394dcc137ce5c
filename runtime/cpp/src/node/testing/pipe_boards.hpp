// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"

namespace rr::testing {

/// A board with pipes in one node, and a node for its clients.
struct PipeBoards {
  explicit PipeBoards(NodeOptions server_options = {}, NodeOptions client_options = {})
      : server(std::move(server_options)), client(std::move(client_options)) {
    service = server.register_service("board", board);
    port = server.listen_tcp(0, "127.0.0.1");
  }
  Client<PipeBoardStub> connect() {
    return client.connect<PipeBoardStub>("rr+tcp://127.0.0.1:" + std::to_string(port) +
                                         "/?service=board");
  }

  // Kept by the test: what functions refer to must outlive the nodes.
  std::shared_ptr<PipeBoard> board = std::make_shared<PipeBoard>();
  Node server;
  Node client;
  Service service;
  std::uint16_t port = 0;
};

/// What a function has got, from any thread.
template <class T>
class Log {
 public:
  void add(T item) {
    const std::lock_guard lock(mutex_);
    items_.push_back(std::move(item));
  }
  [[nodiscard]] std::vector<T> items() const {
    const std::lock_guard lock(mutex_);
    return items_;
  }
  [[nodiscard]] std::size_t size() const { return items().size(); }

 private:
  mutable std::mutex mutex_;
  std::vector<T> items_;
};

}  // namespace rr::testing
