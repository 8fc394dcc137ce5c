// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gateway/closed_list.hpp"
#include "gateway/far_calls.hpp"
#include "gateway/far_packets.hpp"
#include "gateway/far_sessions.hpp"
#include "gateway/far_stream.hpp"
#include "gateway/server.hpp"
#include "gateway/value_order.hpp"
#include "rr/dynamic_service.hpp"

namespace rr::gateway {

/// A robot's service as it is offered here. On the worker's thread but for requests of clients.
class FarService : public std::enable_shared_from_this<FarService> {
 public:
  /// What services of one gateway share; outlives them.
  struct Shared {
    Node& node;
    Worker& worker;
    Outbox& outbox;
    Carrier& carrier;  ///< for messages
    Carrier& values;
    std::shared_ptr<FarCalls> calls;
    FarStream::Reader reader;
    Log log;
    Function<void()> pump;
    std::chrono::milliseconds session_alive;  ///< as ServerOptions has it
  };

  /// Throws rr::Error (invalid_configuration) for files of users and rights.
  FarService(ServedService served, Shared shared);

  /// Subscribes to what tells of the service.
  void start();
  /// The sessions of clients at the robot end; the service stays.
  void end_sessions() { sessions_->end_all(); }
  /// Ends the service here.
  void close();
  /// A message that is no answer to a request. False when it is none of this service.
  bool take(const Message& message);
  /// A message of the connection for values.
  void take_value(const Message& message);
  /// The connection to the broker was made.
  void reconnected();
  /// To be called often.
  void tick();
  /// Which service it is.
  [[nodiscard]] const ServiceAddress& address() const { return served_.address; }
  /// Why the robot may not answer; empty when it seems to be there.
  [[nodiscard]] std::string trouble() const;

 private:
  using Self = std::shared_ptr<FarService>;
  using Weak = std::weak_ptr<FarService>;
  struct FarWire {
    dynamic::ServedObject object;
    dynamic::MemberDescription member;
    ValueOrder order{};
  };

  bool take_reply(const Message& message);
  void take_gateway_life(const Message& message);
  void note_lives();
  void take_life(const Message& message);
  void take_definition(const Message& message, std::string_view rest);
  void take_attributes(const Message& message);
  void offer_when_complete();
  void offer(const std::vector<std::string>& texts);
  [[nodiscard]] ServiceOptions service_options() const;
  void drop(std::uint32_t client, const std::string& reason);
  // far_members.cpp
  dynamic::ServedObject make_object(const std::string& path, const std::string& type);
  void serve_property(const dynamic::ServedObject& object, const std::string& path,
                      const dynamic::MemberDescription& member);
  void serve_function(const dynamic::ServedObject& object, const std::string& path,
                      const dynamic::MemberDescription& member);
  void serve_generator(const dynamic::ServedObject& object, const std::string& path,
                       const dynamic::MemberDescription& member);
  void serve_memory(const dynamic::ServedObject& object, const std::string& path,
                    const dynamic::MemberDescription& member);
  void serve_objref(const dynamic::ServedObject& object, const std::string& path,
                    const dynamic::MemberDescription& member);
  void serve_peeks(const dynamic::ServedObject& object, const std::string& path,
                   const dynamic::MemberDescription& member);
  void serve_wire(const dynamic::ServedObject& object, const std::string& path,
                  const dynamic::MemberDescription& member);
  void serve_pipe(const dynamic::ServedObject& object, const std::string& path,
                  const dynamic::MemberDescription& member);
  void take_packets(const dynamic::PipeServer& pipe, const std::string& path,
                    const dynamic::MemberDescription& member);
  void serve_event(const dynamic::ServedObject& object, const std::string& path,
                   const dynamic::MemberDescription& member);
  // far_closings.cpp
  void take_closed(const Closed& closed);
  void release(const std::string& path);
  void release_all();
  // far_callbacks.cpp
  [[nodiscard]] bool has_callbacks() const;
  bool take_callback(const Message& message, std::string_view id);
  void call_back(const Message& message, std::uint32_t client, const FarCalls::Done& done);
  void add_stream(const std::string& path, const std::string& member, StreamReader::Sink sink,
                  Function<bool()> has_room);
  void report_gap(const std::string& member, const StreamGap& gap);

  const ServedService served_;
  const ServiceAddress& address_;
  const std::string topic_;
  Shared shared_;
  const std::shared_ptr<const Users> users_;         // of this gateway; null: clients do not log in
  std::shared_ptr<FarSessions> sessions_;            // from start() on
  std::optional<Message> definition_;                // `$def` itself
  std::chrono::steady_clock::time_point defined_{};  // when it came
  std::optional<std::map<std::string, VarValue>> attributes_;
  ClosedListReader closed_;
  std::map<std::string, std::string> texts_;  // of definitions, by name
  std::string offered_;                       // the texts that the service was made of
  std::optional<dynamic::Definitions> definitions_;
  dynamic::ServedObject root_;
  std::optional<Service> service_;
  std::string robot_life_;
  std::string gateway_life_;
  const std::shared_ptr<std::atomic<bool>> is_robot_there_;    // as far as is known
  std::map<std::string, std::unique_ptr<FarStream>> streams_;  // by topic
  std::map<std::string, FarWire> wires_;                       // by topic
  std::map<std::string, dynamic::WeakServedObject> objects_;   // by path
  std::set<std::string> called_;                               // callbacks, by id
  std::deque<std::string> called_order_;                       // oldest first
};

}  // namespace rr::gateway
