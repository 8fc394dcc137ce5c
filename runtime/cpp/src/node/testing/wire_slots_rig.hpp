// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/cpp/src/node/testing/mappings.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {

/// Memories of wires that this process has mapped: to publish, or to read.
inline std::size_t slots(bool is_writable) {
  const std::vector<Mapping> all = mappings();
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [&](const Mapping& mapping) {
        return mapping.kind == 2 && mapping.is_writable == is_writable;
      }));
}
inline std::size_t published() { return slots(true); }
inline std::size_t read_here() { return slots(false); }
inline std::vector<std::uint64_t> published_ids() {
  std::vector<std::uint64_t> ids;
  for (const Mapping& mapping : mappings()) {
    if (mapping.kind == 2 && mapping.is_writable) ids.push_back(mapping.id);
  }
  return ids;
}

/// So that the first one is the number, and the size says the same.
inline Array<double> trace_of(std::size_t size, double number) {
  Array<double> trace(size);
  std::ranges::fill(trace.mutate(), number);
  return trace;
}

/// A service with wires, and clients with nodes of their own, which share memory.
class WireSlots : public ::testing::Test {
 protected:
  WireSlots() {
    static int count = 0;
    run_ = test_folder() + "/slots" + std::to_string(count++);
  }
  ~WireSlots() override {
    clients_.clear();
    server_.reset();
    EXPECT_TRUE(eventually([] { return mappings().empty(); })) << mappings().size();
  }
  [[nodiscard]] NodeOptions options(bool shares = true) const {
    NodeOptions options;
    options.local.user_run_dir = run_;
    options.local.shared_memory = shares;
    return options;
  }
  void serve(NodeOptions options, ServiceOptions service = {}) {
    server_ = std::make_unique<Node>(std::move(options));
    service_ = server_->register_service("wired", object_, std::move(service));
    server_->listen("rr+local://");
  }
  [[nodiscard]] std::string url() const {
    return "rr+local:///?nodeid=" + server_->id().text() + "&service=wired";
  }
  // A client of a node of its own.
  Client<WiredStub>& connect(NodeOptions options, ConnectOptions connecting = {}) {
    clients_.emplace_back(std::move(options));
    clients_.back().client = clients_.back().node.connect<WiredStub>(url(), std::move(connecting));
    return clients_.back().client;
  }
  [[nodiscard]] std::vector<std::string> words(std::vector<std::string> more) const {
    more.insert(more.begin(), run_);
    return more;
  }

  struct Connected {
    explicit Connected(NodeOptions options) : node(std::move(options)) {}
    Node node;
    Client<WiredStub> client;
  };
  std::string run_;
  std::shared_ptr<Wired> object_ = std::make_shared<Wired>();
  Service service_;
  std::unique_ptr<Node> server_;
  std::list<Connected> clients_;
};

/// Items of an array that is read in its slot.
inline constexpr std::size_t large = 50'000;

}  // namespace rr::testing
