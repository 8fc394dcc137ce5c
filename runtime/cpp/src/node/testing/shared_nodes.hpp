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

namespace rr::testing {

/// Memories of one kind that this process has mapped: to publish, or to read.
inline std::size_t mapped(std::uint32_t kind, bool is_writable) {
  const std::vector<Mapping> all = mappings();
  return static_cast<std::size_t>(std::ranges::count_if(all, [&](const Mapping& mapping) {
    return mapping.kind == kind && mapping.is_writable == is_writable;
  }));
}
/// Those to publish, by their numbers.
inline std::vector<std::uint64_t> published_ids(std::uint32_t kind) {
  std::vector<std::uint64_t> ids;
  for (const Mapping& mapping : mappings()) {
    if (mapping.kind == kind && mapping.is_writable) ids.push_back(mapping.id);
  }
  return ids;
}

/// A service with one object, and clients with nodes of their own, which share memory.
template <class Object, class ObjectStub>
class SharedNodes : public ::testing::Test {
 protected:
  explicit SharedNodes(std::string service) : name_(std::move(service)) {
    static int count = 0;
    run_ = test_folder() + "/" + name_ + std::to_string(count++);
  }
  ~SharedNodes() override {
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
    service_ = server_->register_service(name_, object_, std::move(service));
    server_->listen("rr+local://");
  }
  [[nodiscard]] std::string url() const {
    return "rr+local:///?nodeid=" + server_->id().text() + "&service=" + name_;
  }
  // A client of a node of its own.
  Client<ObjectStub>& connect(NodeOptions options, ConnectOptions connecting = {}) {
    clients_.emplace_back(std::move(options));
    clients_.back().client =
        clients_.back().node.template connect<ObjectStub>(url(), std::move(connecting));
    return clients_.back().client;
  }
  [[nodiscard]] std::vector<std::string> words(std::vector<std::string> more) const {
    more.insert(more.begin(), run_);
    return more;
  }

  struct Connected {
    explicit Connected(NodeOptions options) : node(std::move(options)) {}
    Node node;
    Client<ObjectStub> client;
  };
  const std::string name_;  // of the service
  std::string run_;
  std::shared_ptr<Object> object_ = std::make_shared<Object>();
  Service service_;
  std::unique_ptr<Node> server_;
  std::list<Connected> clients_;
};

}  // namespace rr::testing
