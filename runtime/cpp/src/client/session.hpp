// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "rr/client.hpp"
#include "rr/definition.hpp"
#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/stub.hpp"
#include "rr/url.hpp"
#include "rr/wire.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/client/callbacks.hpp"
#include "runtime/cpp/src/client/definition_text.hpp"
#include "runtime/cpp/src/client/notices.hpp"
#include "runtime/cpp/src/client/pipes.hpp"
#include "runtime/cpp/src/client/subscription.hpp"
#include "runtime/cpp/src/endpoint/call_terms.hpp"
#include "runtime/cpp/src/endpoint/calls.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/endpoint/pending.hpp"
#include "runtime/cpp/src/endpoint/wire_table.hpp"

namespace rr {

/// What a request says: the values become its elements.
struct Outgoing {
  EntryType type;
  std::string_view path;
  std::string_view member;
  std::span<const Parameter> parameters{};
  const void* const* values = nullptr;
  ErrorCode error = ErrorCode::none;  ///< tells the requests of a generator apart
  bool is_urgent = false;
};

/// What is read of its answer: one element, or nothing when the type is null.
struct Incoming {
  std::string_view element;
  const Type* type = nullptr;
  void* value = nullptr;
};

/// A client's end of a connection: the session of one client with one service.
class Session final : public channel::Receiver,
                      public endpoint::Attended,
                      public endpoint::Caller,
                      public std::enable_shared_from_this<Session> {
 public:
  using Milliseconds = std::chrono::milliseconds;
  using AnswerReader = endpoint::AnswerReader;

  Session(std::shared_ptr<endpoint::Core> core, const Url& url, ConnectOptions options);
  ~Session() override;

  /// Connects and makes the root's stub, which has the type `wanted` or one that implements it when
  /// that is not null. Throws rr::Error.
  std::shared_ptr<Stub> connect(const Url& url, const ObjectType* wanted);
  /// Connects without asking whether the program knows the root's type. Throws rr::Error.
  void connect(const Url& url);
  /// The root's stub, as above, by all definitions that the node knows now; once connected.
  std::shared_ptr<Stub> root(const ObjectType* wanted);
  /// Knows from now on what has been made known to the node after this was made.
  void learn();
  /// See ClientBase.
  void close();
  /// Tells the service and ends the connection without waiting.
  void drop();
  void cancel_calls();
  [[nodiscard]] bool is_open() const;
  /// Throws what a request fails with once the session has ended.
  [[noreturn]] void refuse_ended() const;

  [[nodiscard]] const std::map<std::string, VarValue>& attributes() const { return attributes_; }
  [[nodiscard]] const NodeId& remote_node() const { return remote_node_; }
  [[nodiscard]] const std::string& remote_name() const { return remote_name_; }
  [[nodiscard]] const std::string& object_type() const { return object_type_; }
  [[nodiscard]] std::map<std::string, std::string> definitions() const;
  [[nodiscard]] const std::string& service() const { return service_; }
  /// The root's type and those that it implements, directly or not.
  [[nodiscard]] std::vector<std::string> root_types() const;

  /// NodeOptions::memory_transfer_limit.
  [[nodiscard]] std::uint32_t memory_transfer_limit() const {
    return core_->options().memory_transfer_limit;
  }

  /// Sends a request and waits for its answer. Throws rr::Error, or what the service has thrown.
  void call(const Outgoing& request, const Incoming& answer, Milliseconds timeout);
  void call(const Outgoing& request, const AnswerReader& read, Milliseconds timeout);
  /// Sends a request now; the completion gets the answer.
  void start(const Outgoing& request, const Incoming& answer, Milliseconds timeout,
             std::shared_ptr<Completion> completion);
  void start(const Outgoing& request, AnswerReader read, Milliseconds timeout,
             std::shared_ptr<Completion> completion);
  /// Sends something whose answer, if it has one, nobody waits for.
  void send(const Outgoing& request, bool has_number);

  /// Exists once a stub does.
  [[nodiscard]] channel::Connection& connection() const override { return *connection_; }
  [[nodiscard]] const std::shared_ptr<endpoint::Core>& core() const override { return core_; }
  [[nodiscard]] const std::shared_ptr<const TypeRegistry>& types() const override {
    return *types_.load(std::memory_order_acquire);
  }
  bool take(endpoint::Pending& call) override;
  std::shared_ptr<endpoint::Caller> share() override { return shared_from_this(); }

  /// The stub of the object at a path, whose type is or implements `wanted` unless that is empty.
  /// The service is asked unless there is a stub already.
  std::shared_ptr<Stub> find(const std::string& path, std::string_view wanted,
                             Milliseconds timeout);
  void start_find(std::string path, std::string wanted, Milliseconds timeout,
                  std::shared_ptr<Completion> completion);
  /// One more stub for the object of another, of a class that the caller knows to fit; find() goes
  /// on giving the other one.
  std::shared_ptr<Stub> make_stub_beside(const Stub& stub, const ObjectType& type);
  std::string ask_object_type(const std::string& path, Milliseconds timeout);
  std::map<std::string, VarValue> ask_attributes();
  /// See ClientBase.
  void authenticate(const std::string& username, const std::map<std::string, VarValue>& credentials,
                    Milliseconds timeout);
  void log_out();

  [[nodiscard]] endpoint::WireTable& wires() { return wires_; }
  /// Sends a packet of which only the newest counts; the writer holds its elements.
  void send_newest(Writer& writer, const EntryHeader& header, std::uint32_t element_count,
                   const channel::Newest& newest);

  void add_handler(const std::shared_ptr<client::EventSubscription>& handler);
  [[nodiscard]] client::Callbacks& callbacks() { return callbacks_; }
  [[nodiscard]] client::Pipes& pipes() { return pipes_; }
  [[nodiscard]] const client::Notices& notices() const { return notices_; }
  /// Sends a message of one entry, whose elements are in the writer, that is not answered: one of a
  /// stream, or a reply to what is handled. Throws rr::Error.
  void stream_packet(Writer& writer, const EntryHeader& header, std::string_view metadata);
  void reply_packet(Writer& writer, const EntryHeader& header, std::uint32_t element_count,
                    std::string_view metadata);

  /// A stub goes away, and with it its handlers and the functions of its callbacks.
  void forget(const Stub& stub);

  // From the connection
  void take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                   channel::Laters& laters) override;
  bool take_packet(const Message& message, const Entry& entry, const MemoryRef& owner,
                   channel::Laters& laters) override;
  void foresee(const Message& message) override { notices_.foresee(message); }
  void handle(const Message& message, const Entry& first, const MemoryRef& owner) override;
  void lost(const Error& why, channel::Laters& laters) override;
  void closed() override;

  void attend(channel::Time now) override;

 private:
  class Search;

  // Requests (session_calls.cpp)
  [[nodiscard]] Milliseconds timeout_for(Milliseconds timeout, const CallTerms& terms) const;
  void perform(const Outgoing& request, endpoint::BlockingCall& call, Milliseconds timeout);
  struct Numbers {
    std::uint32_t request = 0;
    std::uint16_t message = 0;
    bool is_connected = false;
  };
  [[nodiscard]] Writer& write(const Outgoing& request) const;
  Numbers draw(endpoint::Pending* call, bool has_number);
  void number(const Outgoing& request, Writer& writer, const Numbers& numbers) const;
  void write_packet_message(Writer& writer, const EntryHeader& header, std::uint32_t element_count,
                            std::string_view metadata);
  void fail_all(const Error& why, channel::Laters& laters);

  // Connecting (session_connect.cpp)
  void establish(const Url& url, const std::function<void()>& check);
  void connect_combined(Milliseconds timeout);
  void connect_in_steps(Milliseconds timeout);
  void pull_definition(const std::string& name, Milliseconds timeout);
  void pull_imports(Milliseconds timeout);
  void keep_definition(std::string_view text);
  void take_remote(const Message& message, bool is_success);

  // Objects (session_objects.cpp)
  std::shared_ptr<Stub> make_stub(const std::string& told, const std::string& path,
                                  std::string_view wanted,
                                  const std::vector<std::string>& implements,
                                  const ObjectType* preferred = nullptr);
  [[nodiscard]] std::vector<std::string> implemented(const std::string& type) const;
  [[nodiscard]] std::vector<std::string> all_types(
      const std::string& told, const std::vector<std::string>& implements) const;
  void pull_type(const std::string& type, Milliseconds timeout);
  std::shared_ptr<Stub> known_stub(const std::string& path);
  void release_path(std::string_view path, std::uint64_t notice);
  void handle_event(const Message& message, const Entry& entry, const MemoryRef& owner);

  // Requests of the other node
  void handle_entry(const Message& message, const Entry& entry, const MemoryRef& owner);
  void answer_request(const Message& message, const Entry& entry);
  std::shared_ptr<client::CallbackSlot> find_callback(const Entry& entry);
  void answer_callback(const Message& message, const Entry& entry, const MemoryRef& owner);
  void send_callback_error(const Message& message, const Entry& entry, const Error& error,
                           bool is_urgent);
  void send_answer(Writer& writer, const Message& message, const Entry& entry, bool is_reply,
                   bool is_urgent = false);
  void give_up(const Error& why);

  const std::shared_ptr<endpoint::Core> core_;
  std::string service_;  // fixed before anything is sent
  ConnectOptions options_;
  std::shared_ptr<channel::Connection> connection_;

  // Written while connecting, by one thread.
  std::uint32_t endpoint_ = 0;
  std::uint32_t remote_endpoint_ = 0;
  NodeId remote_node_;
  std::string remote_name_;
  std::string object_type_;
  std::vector<std::string> object_implements_;
  std::map<std::string, VarValue> attributes_;

  mutable std::mutex mutex_;
  std::list<std::shared_ptr<const TypeRegistry>> known_types_;  // all that types_ has named
  std::atomic<const std::shared_ptr<const TypeRegistry>*> types_;
  endpoint::PendingTable pending_;
  std::atomic<std::uint16_t> next_message_id_{0};
  bool is_connected_ = false;  // the service knows this client
  bool is_ending_ = false;     // one side has said that the session ends
  std::optional<Error> why_closed_;
  std::string user_;  // who is logged in
  std::unordered_map<std::string, std::weak_ptr<Stub>> stubs_;
  std::vector<std::shared_ptr<client::EventSubscription>> handlers_;
  client::Callbacks callbacks_;  // with a lock of its own
  std::map<std::string, std::string> texts_;
  std::map<std::string, client::DefinitionOutline> outlines_;
  client::Notices notices_;
  client::Pipes pipes_{*this};
  std::uint16_t seen_message_id_ = 0;  // at quiet_since_
  channel::Time quiet_since_;

  endpoint::WireTable wires_;
};

}  // namespace rr
