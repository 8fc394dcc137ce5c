// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gateway/call_window.hpp"
#include "gateway/closed_list.hpp"
#include "gateway/exported_callbacks.hpp"
#include "gateway/exported_endpoints.hpp"
#include "gateway/exported_generators.hpp"
#include "gateway/exported_sessions.hpp"
#include "gateway/exported_wires.hpp"
#include "gateway/exporter.hpp"
#include "gateway/outbox.hpp"
#include "gateway/properties.hpp"
#include "gateway/robot_session.hpp"
#include "gateway/stream_writer.hpp"
#include "gateway/topics.hpp"
#include "gateway/worker.hpp"

namespace rr::gateway {

/// One service of an export file. Everything happens on the worker's thread, but for what the
/// robot's node calls, which posts to it.
class ServiceExporter : public std::enable_shared_from_this<ServiceExporter> {
 public:
  /// What services of one gateway share; outlives them.
  struct Shared {
    Worker& worker;
    Outbox& outbox;
    ExportedWires& wires;
    Log log;
    Function<void()> pump;         ///< something can be published; on the worker's thread
    Function<void()> pump_values;  ///< the same of `wires`
  };

  /// Throws as CallWindow.
  ServiceExporter(ServiceAddress address, ExportedServiceOptions options, std::string folder,
                  Shared shared);
  ~ServiceExporter() { callbacks_->abort(); }
  ServiceExporter(const ServiceExporter&) = delete;
  ServiceExporter& operator=(const ServiceExporter&) = delete;

  /// Begins to connect to the robot.
  void connect(Node& node);
  /// What the carrier has to subscribe to.
  [[nodiscard]] std::vector<std::string> filters() const;
  /// A message of one of these. False when it is none of this service.
  bool take(const Message& message);
  /// The broker is there, perhaps without what was retained: all of it is published anew.
  void broker_connected();
  /// What is retained and streams have their turn. False when the carrier takes no more for now.
  bool pump(Carrier& carrier);
  /// To be called often.
  void tick();
  /// The system's clock was set, by so many nanoseconds.
  void clock_was_set(std::int64_t by);

 private:
  struct StreamExport {
    std::unique_ptr<StreamWriter> writer;
    std::chrono::steady_clock::time_point ticked{};
  };
  using Self = std::shared_ptr<ServiceExporter>;
  using Weak = std::weak_ptr<ServiceExporter>;

  /// How members of an object are connected.
  struct Attaching {
    /// Kept by whatever connects members for the first time; the service is announced when the last
    /// has dropped it.
    std::shared_ptr<void> all{};
    std::set<std::string> members{};  // only these; all for none
  };
  /// Members of an object that were closed, to be connected again.
  struct ClosedMembers {
    std::set<std::string> members{};
    std::chrono::steady_clock::time_point due{};
    bool is_released = false;  // the object: its wires end by that
  };

  // service_streams.cpp
  void robot_connected(const dynamic::Object& root);
  void robot_disconnected(const std::string& reason);
  void publish_definitions(const dynamic::Object& root);
  void publish_life(std::string_view life, const std::string& reason);
  void publish_status();
  void retain(Message message);
  std::shared_ptr<void> announce_when_attached();
  [[nodiscard]] std::set<std::string> attached_paths() const;
  void attach_path(const std::string& path, const Attaching& attaching);
  void attach_members(const std::string& path, const dynamic::Object& object,
                      const Attaching& attaching);
  void attach_wire(const std::string& path, const dynamic::Object& object,
                   const dynamic::MemberDescription& member, const ExportRule& rule,
                   const Attaching& attaching);
  void attach_pipe(const std::string& path, const dynamic::Object& object,
                   const dynamic::MemberDescription& member, const Attaching& attaching);
  void attach_event(const std::string& path, const dynamic::Object& object,
                    const dynamic::MemberDescription& member);
  void take_value(ExportedWires::Wire& wire, const dynamic::Value& value, const TimeSpec& time);
  bool pump_retained(Carrier& carrier);
  StreamExport* stream(const std::string& path, const std::string& member, bool makes);
  StreamExport* begin_stream(const std::string& path, const std::string& member);
  void take_record(StreamExport* stream,
                   const std::vector<dynamic::ParameterDescription>& parameters,
                   const dynamic::List& values);
  void append(StreamExport& stream, const std::vector<dynamic::ParameterDescription>& parameters,
              const dynamic::List& values);
  void append_broken(StreamExport& stream);

  // service_closings.cpp
  Function<void(std::exception_ptr)> when_closed(const std::string& path,
                                                 const std::string& member);
  void member_closed(const std::string& path, const std::string& member);
  void ask_for(const std::string& path, const std::string& wire);
  void object_released(const std::string& released);
  void tell_closed(Closed closed);
  ClosedMembers& attach_later(const std::string& path);
  void attach_closed(std::chrono::steady_clock::time_point now);

  // service_requests.cpp
  void handle(const RequestTopic& request, const Message& message);
  bool is_reachable(const RequestTopic& request, const Message& message);
  void handle_stream(const RequestTopic& request, const Message& message);
  void execute_once(const RequestTopic& request, const Message& message);
  void answer(const RequestTopic& request, const Message& message, Message result);
  void answer_error(const RequestTopic& request, const Message& message,
                    const std::exception_ptr& error, std::string_view at);
  std::shared_ptr<RobotSession> session_of(const std::string& user);

  // service_sessions.cpp
  void handle_session(const RequestTopic& request, const Message& message);
  void open_session(const RequestTopic& request, const Message& message);
  void serve_callbacks(const RequestTopic& request, const Message& message,
                       ExportedSession& session, const dynamic::Object& object);
  void tell_ended(const std::string& session, const std::string& reply_topic);
  void answer_ended(const RequestTopic& request, const Message& message);
  void keep_lock(const RequestTopic& request, const Message& message,
                 const std::shared_ptr<ExportedSession>& session, const dynamic::Object& object,
                 const Function<void(std::exception_ptr, Message)>& done);

  // service_execution.cpp
  using Executed = Function<void(std::exception_ptr, Message)>;
  void execute(const RequestTopic& request, const Message& message);
  void find_object_for(const RequestTopic& request, const Message& message,
                       const RobotSession::Found& found);
  void perform(const RequestTopic& request, const Message& message, const dynamic::Object& object,
               const Executed& done);
  void send_packets(const RequestTopic& request, const Message& message,
                    const dynamic::Object& object, const Executed& done);
  void open_generator(const RequestTopic& request, const dynamic::Object& object,
                      const dynamic::List& arguments, const Executed& done);
  void step(const RequestTopic& request, const Message& message, const Executed& done);

  ServiceAddress address_;
  ExportedServiceOptions options_;
  std::string folder_;
  Shared shared_;
  Node* node_ = nullptr;
  CallWindow window_;
  std::shared_ptr<RobotSession> session_;
  std::map<std::string, std::shared_ptr<RobotSession>> user_sessions_;  // by user of the broker
  std::map<std::string, Message> retained_;                             // by topic
  std::set<std::string> unpublished_;                                   // topics of retained_
  std::map<std::string, StreamExport> streams_;                         // by topic
  std::chrono::steady_clock::time_point status_told_{};
  std::shared_ptr<ExportedCallbacks> callbacks_;
  ExportedSessions sessions_;
  ExportedGenerators generators_;
  ExportedEndpoints endpoints_;
  std::string trouble_;           // why the robot is not connected, as was reported
  std::uint64_t connection_ = 0;  // counts connections to the robot
  dynamic::Object root_;          // of this connection
  // By path. Their handlers last as long. Kept until the robot is connected again: what it had sent
  // before is still on its way.
  std::map<std::string, dynamic::Object> attached_;
  std::set<std::string> attached_topics_;                // of members that are or will be connected
  std::map<std::string, ClosedMembers> closed_members_;  // by path
  std::set<std::pair<std::string, std::string>> unsure_;  // wires that have ended: path, member
  ClosedList closed_;
  bool closed_is_told_ = true;
};

/// Nanoseconds since 1970, UTC.
std::int64_t wall_time();

}  // namespace rr::gateway
