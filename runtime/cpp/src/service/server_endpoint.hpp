// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/reader.hpp"
#include "rr/service.hpp"
#include "rr/skeleton.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/service/audit_trail.hpp"
#include "runtime/cpp/src/service/callbacks.hpp"
#include "runtime/cpp/src/service/client_scoped_values.hpp"
#include "runtime/cpp/src/service/generators.hpp"
#include "runtime/cpp/src/service/logins.hpp"
#include "runtime/cpp/src/service/object_tree.hpp"
#include "runtime/cpp/src/service/owed_answers.hpp"
#include "runtime/cpp/src/service/pipes.hpp"
#include "runtime/cpp/src/service/session_access.hpp"
#include "runtime/cpp/src/service/wires.hpp"

namespace rr {
class LockKeeper;
}

namespace rr::service {

class DecodedMemory;
class Directory;
class HandlerMemory;
class ResponseBatch;
class ServiceHost;

/// One request of a session, and where its answer goes: into a message of its own, or, when it came
/// with others in one message, into a common one.
struct Question {
  const Message& message;
  const Entry& entry;
  const MemoryRef& owner;
  std::shared_ptr<ResponseBatch> batch;  ///< null for a single one
  std::size_t place = 0;                 ///< in the batch
  bool is_urgent = false;                ///< the member is; known once that is found
  channel::Time begun{};                 ///< when it was taken up; of a node that counts
  mutable bool is_put_off = false;       ///< it is answered later (LateAnswer)
  DecodedMemory* decoded = nullptr;  ///< what its containers are drawn from; null for the wire's
  // How it was admitted (SessionAccess); null before.
  const AccessRow* row = nullptr;
  std::uint32_t standing = 0;
  std::uint32_t login = 0;

  /// A decoder of its elements.
  [[nodiscard]] Decoder decoder(const TypeRegistry* types = nullptr) const;
};

inline Admission admission_of(const Question& question) {
  return {question.row, question.standing, question.login};
}

/// The service's end of a connection: answers special requests, and holds the session once a client
/// has connected to a service.
///
/// Large because each kind of request has a function here, and all go by the same rights, user and
/// object. Pipes, wires, callbacks, generators and the audit trail are parts.
class ServerEndpoint final : public channel::Receiver,
                             public endpoint::Attended,
                             public std::enable_shared_from_this<ServerEndpoint> {
 public:
  ServerEndpoint(std::shared_ptr<Directory> directory,
                 std::shared_ptr<channel::Connection> connection);
  ~ServerEndpoint() override;

  [[nodiscard]] const ServiceClient& client() const { return client_; }
  /// Empty before a client has connected.
  [[nodiscard]] std::string service_name() const;
  [[nodiscard]] channel::Connection& connection() const { return *connection_; }
  [[nodiscard]] Callbacks& callbacks() { return callbacks_; }
  [[nodiscard]] Generators& generators() { return generators_; }
  // How many of each the session may have.
  [[nodiscard]] std::size_t generator_limit() const;
  [[nodiscard]] std::size_t late_answer_limit() const;
  [[nodiscard]] std::size_t callback_limit() const;
  /// Wires and pipe endpoints that the client has connected.
  [[nodiscard]] std::size_t wire_count() const { return wires_.count(); }
  [[nodiscard]] std::size_t pipe_count() const { return pipes_.count(); }
  [[nodiscard]] ClientScopedValues& client_values() { return client_values_; }
  /// The endpoint whose request this thread handles; null outside of handlers.
  static ServerEndpoint* current();
  /// The path of the object that it asks.
  static std::string_view current_path();

  /// Bytes that the containers of one request may take.
  [[nodiscard]] std::size_t container_limit() const;
  /// The requests of this session that are answered later.
  [[nodiscard]] const std::shared_ptr<OwedAnswers>& owed_answers() const { return owed_answers_; }

  /// Throws what the service's lock keeper says against a client that connects a pipe or wire. May
  /// wait, so that what was found before has to be looked for again.
  void ask_keeper_to_connect(const Question& question, const Member& member) const;

  /// Who is logged in; null for nobody.
  [[nodiscard]] std::shared_ptr<const User> user() const;
  /// What that allows.
  [[nodiscard]] const SessionAccess& access() const { return access_; }
  /// Whether what was admitted may go on: the same user may still do it. What is opened for a
  /// request asks this once it is where end_what_is_not_allowed() finds it.
  [[nodiscard]] bool is_still_allowed(const Question& question) const;
  [[nodiscard]] bool is_still_allowed(const Admission& admission, std::string_view path,
                                      std::string_view member) const;
  static Error no_longer_allowed();
  /// The service has other rules. On any thread.
  void renew_rights(ServiceHost& host);

  /// Sends something that is not answered. Throws rr::Error for values that cannot be written; what
  /// cannot be sent is reported to the node's log, unless the client is gone.
  void send_packet(const EntryHeader& header, std::span<const Parameter> parameters,
                   const void* const* values, bool is_urgent = false);
  /// Puts the header of a message before an entry of the service's own, and sends it. Throws
  /// rr::Error.
  void send_request(Writer& entry, EntryType type, bool is_urgent);
  /// The service has released the object at a path and those below, for this client at least; who
  /// may hear of it is told.
  void release_path(const std::string& path);
  /// Sends an entry that is not answered, with metadata in the message header; of which only the
  /// newest counts, unless `newest` is null. Throws rr::Error.
  void send_marked(Writer& writer, std::string_view metadata, const channel::Newest* newest);
  /// Sends a message of one entry, whose elements are in the writer, that is not answered: one of a
  /// stream. Throws rr::Error.
  void stream_packet(Writer& writer, const EntryHeader& header, std::string_view metadata);
  /// Ends the session, and soon the connection.
  void leave();

  // For the members of each kind, with the dispatch turn.
  [[nodiscard]] Wires& wires() { return wires_; }
  [[nodiscard]] const std::shared_ptr<endpoint::Core>& core() const;
  /// Those that varvalues may need. Once a client has connected.
  [[nodiscard]] const std::shared_ptr<const TypeRegistry>& types() const;
  std::shared_ptr<const ServedObject> find_object(std::string_view path);
  const Member& find_member(const ServedObject& object, std::string_view name, MemberKind kind);
  [[nodiscard]] bool is_in_session(const Message& message) const;
  /// A writer for the elements and the entry of an answer, which finish() sends.
  Writer& begin_answer(const Question& question) const;
  void finish(const Question& question, Writer& writer, std::string_view metadata = {});

  // Answers of session requests. What cannot be written throws rr::Error, and nothing is sent.
  void answer_value(const Question& question, std::string_view name, const Type& type,
                    const void* value);
  /// What a member has given.
  void answer_result(const Question& question, const Member& member, HandlerMemory& made,
                     const void* value);
  void answer_values(const Question& question, EntryType type,
                     std::span<const Parameter> parameters, const void* const* values);
  void answer_empty(const Question& question);
  /// An answer whose elements are in the writer.
  void answer_elements(const Question& question, Writer& writer, std::uint32_t element_count,
                       std::string_view metadata = {});
  /// Nothing, for what is not answered.
  void answer_nothing(const Question& question);
  void answer_error(const Question& question, const Error& error);
  /// The same for an answer given later, by what is left of its question then.
  void answer_late(const LateAnswer& late, const void* result);
  void answer_late(const LateAnswer& late, const Error& error);
  void answer_late_text(const LateAnswer& late, std::string_view text);

  void take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                   channel::DeferredCallbacks& deferred) override;
  bool take_packet(const Message& message, const Entry& entry, const MemoryRef& owner,
                   channel::DeferredCallbacks& deferred) override;
  void handle(const Message& message, const Entry& first, const MemoryRef& owner) override;
  void lost(const Error& why, channel::DeferredCallbacks& deferred) override;
  void closed() override;
  void attend(channel::Time now) override;

 private:
  friend class ResponseBatch;
  friend class Pipes;

  // Special requests (special_requests.cpp)
  void handle_special(const Message& message, const Entry& first);
  static void add_refusals(Writer& writer, const Message& message, bool is_for_us);
  void write_special_answer(Writer& writer, const Message& message, const Entry& entry,
                            std::uint32_t& own_endpoint);
  std::uint32_t write_service_definition(Writer& writer, Decoder& decoder, const Entry& entry);
  std::uint32_t write_object_type(Writer& writer, Decoder& decoder, const Entry& entry);
  std::uint32_t write_attributes(Writer& writer, const Entry& entry);
  std::uint32_t connect(Writer& writer, Decoder& decoder, const Message& message,
                        const Entry& entry, std::uint32_t& own_endpoint);
  std::uint32_t disconnect(Decoder& decoder, const Message& message, const Entry& entry);
  std::uint32_t join(const std::shared_ptr<ServiceHost>& host, const Message& message);
  bool let_in(Decoder& decoder, std::string_view user, const Element& credentials);
  void quit();

  // Session requests (session_requests.cpp)
  void handle_session(const Message& message, const Entry& first, const MemoryRef& owner);
  void handle_question(Question question);
  void answer_question(Question& question);
  void answer_session_object_type(const Question& question);
  void answer_member(Question& question, MemberKind kind);
  // Generators (generators.cpp)
  void answer_generator_step(Question& question);
  void step_generator(const Question& question, Decoder& decoder, Generators::Use& generator);
  static void end_generator(ErrorCode wish, Generators::Use& generator);
  void answer_void(const Question& question);
  // Who may do what (access.cpp)
  void check_access(Question& question);
  void check_rights(const Question& question);
  void check_member(const Question& question, const Member& member);
  void check_locks(const Question& question, std::string_view member);
  void become(std::shared_ptr<const User> user);
  void log_out();
  void tell_keeper(const std::string& user);
  void end_what_is_not_allowed(ServiceHost& host, bool is_all);
  std::shared_ptr<const User> need_user() const;
  void answer_session_operation(const Question& question);
  bool ask_keeper(LockKeeper& keeper, const Question& question);
  static LateAnswer late_operation(const Question& question);
  void answer_user_operation(const Question& question);
  void answer_monitor_operation(const Question& question);

  // Logging in (login_requests.cpp)
  bool must_wait_for_login(const Message& message, const Entry& first, const MemoryRef& owner);
  bool begin_login(const Message& message, const Entry& entry, const MemoryRef& owner);
  bool read_login(const Message& message, const Entry& entry, const MemoryRef& owner,
                  std::shared_ptr<ServiceHost>& host, std::string& name, VarStringMap& credentials);
  void forget_login();
  void log_in(std::string_view name);

  // Memories (memories.cpp)
  void answer_memory(const Question& question);
  void read_memory(const Question& question, Decoder& decoder, const Member& member,
                   MemorySource& memory);
  void write_memory(const Question& question, Decoder& decoder, const Member& member,
                    MemorySource& memory);
  void answer_memory_parameter(const Question& question, Decoder& decoder, const Member& member,
                               const MemorySource& memory);

  // A message of which some requests have been handled.
  struct Unfinished {
    std::shared_ptr<ResponseBatch> batch;
    std::size_t next = 0;
    std::size_t offset = 0;  // of the next one, in the message's entries
  };
  Unfinished begin_or_continue(const Message& message);
  [[nodiscard]] bool must_yield();
  bool put_off(const Unfinished& state);

  void end_members();
  void announce_leaving(channel::DeferredCallbacks& deferred);
  void deliver(const Question& question, Writer& writer, std::string_view metadata = {});
  void finish_late(const LateAnswer& late, Writer& writer, ErrorCode code = ErrorCode::none);
  void count(EntryType request, channel::Time begun, ErrorCode code) const;
  enum class Way : std::uint8_t { reply, send, stream };
  void send_answer(Writer& writer, std::uint32_t entry_count, EntryType single_type, Way way,
                   std::string_view metadata = {}, bool is_urgent = false);
  std::uint16_t draw_message_id(std::uint16_t count = 1) {
    return next_message_id_.fetch_add(count, std::memory_order_relaxed);
  }

  const std::shared_ptr<Directory> directory_;
  const std::shared_ptr<channel::Connection> connection_;

  // Set when a client connects, with the dispatch turn, before anybody else knows of this.
  std::shared_ptr<ServiceHost> host_;
  ServiceClient client_;
  std::uint32_t remote_endpoint_ = 0;
  std::atomic<bool> is_member_{false};  // of the host's clients
  bool is_announced_ = false;           // the service was told of it; with the dispatch turn
  bool is_leaving_ = false;             // has said farewell; with the dispatch turn
  SessionAccess access_;                // near the begin: each value that is sent to all asks it

  Callbacks callbacks_{*this};
  Generators generators_;
  ClientScopedValues client_values_;
  mutable Mutex user_mutex_;
  // The host and the client, for whoever has no turn.
  std::pair<std::shared_ptr<ServiceHost>, ServiceClient> session_ RR_GUARDED_BY(user_mutex_);
  std::shared_ptr<ServiceHost> present_at_
      RR_GUARDED_BY(user_mutex_);  // is to be told that the client leaves
  std::shared_ptr<Logins::Attempt> login_
      RR_GUARDED_BY(user_mutex_);  // of the message that is handled
  // With the dispatch turn:
  std::vector<Unfinished> unfinished_;       // the next one is the last
  bool has_outcome_ = false;                 // of login_
  std::shared_ptr<ServiceHost> login_host_;  // that it was checked for
  unsigned failed_logins_ = 0;               // of the connection
  AuditTrail audit_{*this};

  const std::shared_ptr<OwedAnswers> owed_answers_;
  std::atomic<bool> is_told_full_{false};  // the log, that packets are dropped
  std::atomic<std::uint16_t> next_message_id_{0};
  std::atomic<channel::Time> last_heard_;

  Pipes pipes_{*this};

  // The object and the member that were asked last, with the dispatch turn. What is released is not
  // kept alive until the next request.
  std::string last_path_;
  std::weak_ptr<const ServedObject> last_object_;
  std::uint32_t last_generation_ = 0;
  const Member* last_member_ = nullptr;
  // What the rules have said last, with the dispatch turn.
  struct Granted {
    std::uint32_t standing = 0;
    RightSet rights = 0;
    std::string path;
    std::string member;
  };
  Granted granted_;

  Wires wires_{*this};
};

}  // namespace rr::service
