// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/client.hpp"
#include "rr/definition.hpp"
#include "rr/mutex.hpp"
#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/stub.hpp"
#include "rr/url.hpp"
#include "rr/wire.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/client/callbacks.hpp"
#include "runtime/cpp/src/client/definition_differences.hpp"
#include "runtime/cpp/src/client/definition_texts.hpp"
#include "runtime/cpp/src/client/notices.hpp"
#include "runtime/cpp/src/client/pipes.hpp"
#include "runtime/cpp/src/client/stub_cache.hpp"
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
  bool opens_generator = false;  ///< which is ended if nobody waits for the answer any more
};

/// What is read of its answer: one element, or nothing when the type is null.
struct Incoming {
  std::string_view element;
  const Type* type = nullptr;
  void* value = nullptr;
};

/// What the service may make a session hold, in bytes, and what of definitions.
struct SessionLimits {
  std::size_t held = 0;
  DefinitionLimits definitions{};
  bool has_full_messages = true;  ///< else NodeOptions::size_before_connect stays their limit
};

/// A client's end of a connection: the session of one client with one service.
///
/// Large because all kinds of requests meet here: they take numbers and wait for answers in one
/// table, which one lock guards. Pipes, wires, callbacks, stubs and definitions are parts.
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
  /// The URL came from discovery, whoever asks for the connection. Before it is connected.
  void set_found() { is_found_ = true; }
  /// Other limits than those of the node. Before it is connected.
  void set_limits(const SessionLimits& limits) { limits_ = limits; }
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
  [[nodiscard]] const NodeId& remote_node() const { return known_remote().node; }
  [[nodiscard]] const std::string& remote_name() const { return known_remote().name; }
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
  /// How long a request of a stub with this time waits; zero: that of the session.
  [[nodiscard]] Milliseconds timeout_of(Milliseconds own) const { return timeout_for(own, {}); }
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

  /// Whether the service declares anything otherwise than this program knows it.
  [[nodiscard]] bool has_differences() const {
    return has_differences_.load(std::memory_order_acquire);
  }
  /// Throws rr::Error when that is so for a member of an object.
  void check_member(const Stub& stub, const Member& member) const {
    if (has_differences()) refuse_member(stub.rr_object_type(), member);
  }
  /// Fails a completion for the same reason, and returns true.
  bool refuse_start(const Stub& stub, const Member& member,
                    std::unique_ptr<Completion>& completion);

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
                   channel::DeferredCallbacks& deferred) override;
  bool take_packet(const Message& message, const Entry& entry, const MemoryRef& owner,
                   channel::DeferredCallbacks& deferred) override;
  void foresee(const Message& message) override;
  void handle(const Message& message, const Entry& first, const MemoryRef& owner) override;
  void lost(const Error& why, channel::DeferredCallbacks& deferred) override;
  void closed() override;

  void attend(channel::Time now) override;

 private:
  class Search;

  // Requests (session_calls.cpp)
  [[nodiscard]] Milliseconds timeout_for(Milliseconds timeout, const CallTerms& terms) const;
  void perform(const Outgoing& request, endpoint::BlockingCall& call, Milliseconds timeout);
  // Of the next message, and whom it is for.
  struct Numbers {
    std::uint32_t request = 0;
    std::uint16_t message = 0;
    bool is_connected = false;
    std::uint32_t remote_endpoint = 0;
    NodeId remote_node;
    std::string remote_name;  // where names travel
  };
  [[nodiscard]] Writer& write(const Outgoing& request) const;
  Numbers draw_numbers(bool has_name) RR_REQUIRES(mutex_);
  Numbers draw(endpoint::Pending& call, const Outgoing& request, endpoint::Asked asked);
  Numbers draw(const Outgoing& request, bool has_number);
  void number(const Outgoing& request, Writer& writer, const Numbers& numbers) const;
  void write_packet_message(Writer& writer, const EntryHeader& header, std::uint32_t element_count,
                            std::string_view metadata);
  void fail_all(const Error& why, channel::DeferredCallbacks& deferred);
  void end_abandoned(const Message& message, const Entry& entry, const MemoryRef& owner,
                     const endpoint::Asked::Opening& opening, channel::DeferredCallbacks& deferred);

  // Connecting (session_connect.cpp)
  // The time of several requests that are made one behind the other, and of each.
  struct Patience {
    Milliseconds one;
    channel::Time deadline;
  };
  void establish(const Url& url, const std::function<void()>& check);
  void connect_combined(const Patience& patience);
  void connect_in_steps(const Patience& patience);
  [[nodiscard]] Patience patience_for(Milliseconds timeout) const;
  void ask(const Outgoing& request, const AnswerReader& read, const Patience& patience);
  void authenticate(const std::string& username, const std::map<std::string, VarValue>& credentials,
                    const Patience& patience);
  void take_remote(const Message& message, bool is_success);
  void check_channel(const Url& url, const ChannelTraits& traits);
  void check_credentials() const;

  // Definitions (session_definitions.cpp)
  void pull_definition(const std::string& name, const Patience& patience);
  void pull_imports(const Patience& patience);
  void keep_definition(std::string_view text);
  void compare_definitions(const TypeRegistry& known);
  void refuse_member(const ObjectType& type, const Member& member) const;

  // Objects (session_objects.cpp)
  std::shared_ptr<Stub> make_stub(const std::string& told, const std::string& path,
                                  std::string_view wanted,
                                  const std::vector<std::string>& implements,
                                  const ObjectType* preferred = nullptr);
  [[nodiscard]] std::shared_ptr<Stub> keep_found(const client::StubCache::Lookup& lookup,
                                                 const std::string& told, std::string_view wanted);
  [[nodiscard]] std::vector<std::string> implemented(const std::string& type) const;
  [[nodiscard]] std::vector<std::string> all_types(
      const std::string& told, const std::vector<std::string>& implements) const;
  void pull_type(const std::string& type, Milliseconds timeout);
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
  struct Remote {
    std::uint32_t endpoint = 0;
    NodeId node;
    std::string name;
  };
  // Once connected, when it does not change any more.
  [[nodiscard]] const Remote& known_remote() const RR_NO_THREAD_SAFETY_ANALYSIS { return remote_; }

  const std::shared_ptr<endpoint::Core> core_;
  std::string service_;  // fixed before anything is sent
  std::function<void(const Error&)> on_closed_ RR_GUARDED_BY(mutex_);
  std::function<void(const std::string&)> on_path_released_ RR_GUARDED_BY(mutex_);
  const ConnectOptions options_;  // without these two
  std::shared_ptr<channel::Connection> connection_;
  SessionLimits limits_;  // fixed before it is connected

  // Written while connecting, by one thread, and never again.
  bool is_found_ = false;             // the URL came from discovery
  bool may_send_credentials_ = true;  // or somebody else could read them, or be meant
  std::uint32_t endpoint_ = 0;
  Remote remote_ RR_GUARDED_BY(mutex_);
  bool has_remote_ RR_GUARDED_BY(mutex_) = false;
  std::string object_type_;
  std::vector<std::string> object_implements_;
  std::map<std::string, VarValue> attributes_;

  mutable Mutex mutex_;
  std::list<std::shared_ptr<const TypeRegistry>> known_types_
      RR_GUARDED_BY(mutex_);  // all that types_ has named
  std::atomic<const std::shared_ptr<const TypeRegistry>*> types_;
  endpoint::PendingTable pending_ RR_GUARDED_BY(mutex_);
  std::atomic<std::uint16_t> next_message_id_{0};
  bool is_connected_ RR_GUARDED_BY(mutex_) = false;  // the service knows this client
  bool is_ending_ RR_GUARDED_BY(mutex_) = false;     // one side has said that the session ends
  std::atomic<bool> is_given_up_{false};             // what waits to be handled is dropped
  std::optional<Error> why_closed_ RR_GUARDED_BY(mutex_);
  std::string user_ RR_GUARDED_BY(mutex_);  // who is logged in
  client::StubCache stubs_;                 // with a lock of its own
  std::vector<std::shared_ptr<client::EventSubscription>> handlers_ RR_GUARDED_BY(mutex_);
  client::Callbacks callbacks_;  // with a lock of its own
  client::DefinitionTexts texts_ RR_GUARDED_BY(mutex_);
  client::DefinitionDifferences differences_ RR_GUARDED_BY(mutex_);
  std::atomic<bool> has_differences_{false};
  std::atomic<bool> has_told_foreign_{false};  // answers to something else are logged once
  client::Notices notices_;
  client::Pipes pipes_{*this};
  std::uint16_t seen_message_id_ RR_GUARDED_BY(mutex_) = 0;  // at quiet_since_
  channel::Time quiet_since_ RR_GUARDED_BY(mutex_);

  endpoint::WireTable wires_;
};

}  // namespace rr
