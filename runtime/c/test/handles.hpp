// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "rr.h"
#include "runtime/c/test/all_members.h"
#include "runtime/c/test/packing.h"

/// Handles of the C interface that release themselves, and a pair of nodes, for tests.
namespace rr::testing::c {

template <auto release>
struct Release {
  template <class T>
  void operator()(T* handle) const {
    release(handle);
  }
};
using NodeHandle = std::unique_ptr<rr_node, Release<rr_node_release>>;
using ClientHandle = std::unique_ptr<rr_client, Release<rr_client_release>>;
using ObjectHandle = std::unique_ptr<rr_object, Release<rr_object_release>>;
using DataHandle = std::unique_ptr<rr_data, Release<rr_data_release>>;
using ErrorHandle = std::unique_ptr<rr_error, Release<rr_error_release>>;
using ServedHandle = std::unique_ptr<rr_served_object, Release<rr_served_object_release>>;
using TypeHandle = std::unique_ptr<rr_object_type, Release<rr_object_type_release>>;
using DefinitionHandle = std::unique_ptr<rr_definition, Release<rr_definition_release>>;
using ServiceHandle = std::unique_ptr<rr_service, Release<rr_service_release>>;
using SubscriptionHandle = std::unique_ptr<rr_subscription, Release<rr_subscription_release>>;
using PipeHandle = std::unique_ptr<rr_pipe, Release<rr_pipe_release>>;
using WireHandle = std::unique_ptr<rr_wire, Release<rr_wire_release>>;
using GeneratorHandle = std::unique_ptr<rr_generator, Release<rr_generator_release>>;
using CancellationHandle = std::unique_ptr<rr_cancellation, Release<rr_cancellation_release>>;

inline rr_str view(std::string_view text) { return {text.data(), text.size()}; }
inline std::string text(rr_str given) { return {given.data, given.size}; }

/// Elements of the test's own.
class Packed {
 public:
  Packed() = default;
  Packed(const Packed&) = delete;
  Packed& operator=(const Packed&) = delete;
  ~Packed() { packer_free(&packer_); }
  Packed& number(const char* name, double value) {
    pack_double(&packer_, name, value);
    return *this;
  }
  Packed& integer(const char* name, std::int32_t value) {
    pack_int32(&packer_, name, value);
    return *this;
  }
  Packed& words(const char* name, const char* value) {
    pack_text(&packer_, name, value);
    return *this;
  }
  Packed& bytes(const char* name, const std::string& value) {
    pack(&packer_, name, PACK_UINT8, value.data(), value.size(),
         static_cast<std::uint32_t>(value.size()));
    return *this;
  }
  const rr_elements* operator&() {  // NOLINT: what C functions take
    elements_ = packed(&packer_);
    return &elements_;
  }
  [[nodiscard]] const packer& content() const { return packer_; }

 private:
  packer packer_{};
  rr_elements elements_{};
};

inline NodeHandle make_node(const rr_node_options* options = nullptr) {
  rr_node* node = nullptr;
  rr_node_new(options, &node, nullptr);
  return NodeHandle(node);
}

inline std::uint16_t listen(const NodeHandle& node) {
  std::uint16_t port = 0;
  rr_node_listen(node.get(), view("rr+tcp://127.0.0.1:0"), &port, nullptr);
  return port;
}

inline ClientHandle connect(const NodeHandle& node, std::uint16_t port, const std::string& service,
                            const rr_connect_options* options = nullptr,
                            rr_error** error = nullptr) {
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=" + service;
  const rr_str urls[] = {view(url)};
  rr_client* client = nullptr;
  rr_client_connect(node.get(), urls, 1, options, &client, error);
  return ClientHandle(client);
}

inline ObjectHandle root_of(const ClientHandle& client) {
  rr_object* root = nullptr;
  rr_client_root(client.get(), &root, nullptr);
  return ObjectHandle(root);
}

/// A node that offers the services of all_members_service.c, and a client of one of them.
struct Pair {
  explicit Pair(const std::string& service = "counter",
                const rr_connect_options* options = nullptr) {
    offered = all_members_offer(server.get());
    port = listen(server);
    client = connect(node, port, service, options);
    root = root_of(client);
  }
  ~Pair() {
    root.reset();
    client.reset();
    node.reset();
    server.reset();
    all_members_release(offered);
  }
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;

  NodeHandle server = make_node();
  NodeHandle node = make_node();
  all_members* offered = nullptr;
  std::uint16_t port = 0;
  ClientHandle client;
  ObjectHandle root;
};

/// What a call fails with, and what it says.
struct Outcome {
  rr_status status = RR_OK;
  std::string message{};
  DataHandle data{};
};

inline Outcome call(const ObjectHandle& object, std::string_view member,
                    const rr_elements* arguments = nullptr,
                    const rr_call_options* options = nullptr,
                    std::uint32_t request = RR_FUNCTION_CALL) {
  rr_data* data = nullptr;
  rr_error* error = nullptr;
  Outcome outcome;
  outcome.status =
      rr_object_call(object.get(), request, view(member), arguments, options, &data, &error);
  outcome.data.reset(data);
  if (error != nullptr) {
    rr_error_info info{};
    info.size = sizeof info;
    rr_error_read(error, &info);
    outcome.message = text(info.message);
    rr_error_release(error);
  }
  return outcome;
}

/// A completion that calls a function of the test, which owns what it is given.
struct Done {
  using Function = std::function<void(rr_status, void*)>;
  explicit Done(Function given) : function(std::move(given)) {}
  [[nodiscard]] rr_completion completion() {
    return {this, [](void* context, rr_error* error, void* result) {
              rr_error_info info{};
              info.size = sizeof info;
              if (error != nullptr) rr_error_read(error, &info);
              const rr_status status = info.code;
              rr_error_release(error);
              static_cast<Done*>(context)->function(status, result);
            }};
  }
  Function function;
};

}  // namespace rr::testing::c
