// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>

#include "runtime/c/test/handles.hpp"

namespace rr::testing::c {

/// A service that keeps its requests unanswered until the test takes them, and its only client.
class SilentService {
 public:
  explicit SilentService(const rr_connect_options* connecting = nullptr,
                         const rr_service_options* options = nullptr) {
    rr_definition* definition = nullptr;
    rr_definition_new(view(text), nullptr, 0, &definition, nullptr);
    const DefinitionHandle definition_owner(definition);
    rr_member members[5] = {};
    members[0].name = view("ask");
    members[0].kind = RR_FUNCTION;
    members[0].returns_value = 1;
    members[1].name = view("noted");
    members[1].kind = RR_EVENT;
    members[2].name = view("numbers");
    members[2].kind = RR_PIPE;
    members[3].name = view("level");
    members[3].kind = RR_WIRE;
    members[4].name = view("sum");
    members[4].kind = RR_CALLBACK;
    members[4].returns_value = 1;
    rr_object_type* type = nullptr;
    rr_object_type_new(definition, view("Silent"), members, 5, sizeof(rr_member), &type, nullptr);
    const TypeHandle type_owner(type);
    rr_object_handler handler{};
    handler.size = sizeof handler;
    handler.context = this;
    handler.on_request = [](void* context, rr_request* request, const rr_request_info*) {
      static_cast<SilentService*>(context)->keep(request);
    };
    rr_served_object* made = nullptr;
    rr_served_object_new(type, &handler, &made, nullptr);
    object.reset(made);
    rr_service* offered = nullptr;
    rr_service_register(server.get(), view("silent"), made, options, &offered, nullptr);
    service.reset(offered);
    port = listen(server);
    client = connect(node, port, "silent", connecting);
    if (client) root = root_of(client);
  }
  ~SilentService() {
    while (rr_request* const request = take()) rr_request_release(request);
  }
  SilentService(const SilentService&) = delete;
  SilentService& operator=(const SilentService&) = delete;

  void wait_for_requests(std::size_t count) {
    std::unique_lock lock(mutex_);
    came_.wait(lock, [&] { return requests_.size() >= count; });
  }
  /// The oldest, which is the caller's; null when there is none.
  rr_request* take() {
    const std::lock_guard lock(mutex_);
    if (requests_.empty()) return nullptr;
    rr_request* const request = requests_.front();
    requests_.pop_front();
    return request;
  }

 private:
  static constexpr std::string_view text =
      "service test.silent\n"
      "stdver 0.10\n"
      "object Silent\n"
      "  function double ask()\n"
      "  event noted(double value)\n"
      "  pipe double numbers\n"
      "  wire double level\n"
      "  callback int32 sum(int32 a, int32 b)\n"
      "end\n";

  void keep(rr_request* request) {
    {
      const std::lock_guard lock(mutex_);
      requests_.push_back(request);
    }
    came_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable came_;
  std::deque<rr_request*> requests_;

 public:
  ServedHandle object;
  ServiceHandle service;
  std::uint16_t port = 0;
  NodeHandle server = make_node();
  NodeHandle node = make_node();
  ClientHandle client;
  ObjectHandle root;
};

}  // namespace rr::testing::c
