// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "rr/node.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "rr/wires.hpp"

/// An object with wires, as the compiler would generate it.
namespace rr::testing {

/// For what has to happen, on a machine however busy.
inline constexpr std::chrono::seconds plenty{20};

extern const ObjectType rr_Wired;

class WiredStub : public virtual Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override;
  Wire<double> level();
  Wire<std::string> note();
  Wire<Array<double>> trace();
  Wire<double> reading();  ///< readonly
  Wire<double> target();   ///< writeonly
  void set_level(double value);
  void close_level();
  std::shared_ptr<WiredStub> get_child(const std::string& index);
};

class Wired : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override;
  void rr_dispatch(std::size_t member, Request& request) override;
  std::shared_ptr<Skeleton> rr_child(std::size_t member, const ObjectIndex& index) override;

  [[nodiscard]] WireServer<double> level() const;
  [[nodiscard]] WireServer<std::string> note() const;
  [[nodiscard]] WireServer<Array<double>> trace() const;
  [[nodiscard]] WireServer<double> reading() const;
  [[nodiscard]] WireServer<double> target() const;

  /// What the function set_level does besides.
  std::function<void()> on_set_level;
  std::shared_ptr<Wired> child;
};

/// A node that offers a Wired, and another that can connect to it, on the loopback interface.
struct WiredPair {
  explicit WiredPair(NodeOptions server_options = {}, NodeOptions client_options = {})
      : server(std::move(server_options)), client(std::move(client_options)) {
    service = server.register_service("wired", object);
    port = server.listen_tcp(0, "127.0.0.1");
  }
  Client<WiredStub> connect(ConnectOptions options = {}) {
    return client.connect<WiredStub>(
        "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=wired", std::move(options));
  }

  std::shared_ptr<Wired> object = std::make_shared<Wired>();
  Node server;
  Node client;
  Service service;
  std::uint16_t port = 0;
};

}  // namespace rr::testing
