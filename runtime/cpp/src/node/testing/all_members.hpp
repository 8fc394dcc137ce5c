// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "rr/memories.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

/// Five services, which together have members of all kinds, and a client that uses each of them in
/// the same way each time.
namespace rr::testing {

extern const Definition rr_store_definition;
extern const ObjectType rr_Store;

class StoreStub : public virtual Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Store; }
  ArrayMemory<double> numbers();
};

class AllMembers {
 public:
  /// Registers the services `counter`, `board`, `pipes`, `wired` and `store`, and listens.
  explicit AllMembers(Node& server);

  /// What a client does: one connection for each service, all of them closed at the end, when
  /// nothing is on its way any more. Throws rr::Error, or std::runtime_error when something is not
  /// as it should be.
  static void use(Node& client, std::uint16_t port);

  [[nodiscard]] std::uint16_t port() const { return port_; }
  static constexpr std::size_t connections = 5;

 private:
  std::uint16_t port_ = 0;
};

}  // namespace rr::testing
