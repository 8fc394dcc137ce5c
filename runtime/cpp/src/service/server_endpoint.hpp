// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "rr/service.hpp"
#include "rr/skeleton.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/service/belongings.hpp"
#include "runtime/cpp/src/service/callbacks.hpp"
#include "runtime/cpp/src/service/generators.hpp"
#include "runtime/cpp/src/service/object_tree.hpp"
#include "runtime/cpp/src/service/pipes.hpp"
#include "runtime/cpp/src/service/wires.hpp"

namespace rr::service {

class Directory;
class Gathering;
class ServiceHost;

/// One request of a session, and where its answer goes: into a message of its own, or, when it came
/// with others in one message, into a common one.
struct Question {
  const Message& message;
  const Entry& entry;
  const MemoryRef& owner;
  std::shared_ptr<Gathering> gathering;  ///< null for a single one
  std::size_t place = 0;                 ///< in the gathering
  bool is_urgent = false;                ///< the member is; known once that is found
};

/// The service's end of a connection: answers special requests, and holds the session once a client
/// has connected to a service.
class ServerEndpoint final : public channel::Receiver,
                             public endpoint::Attended,
                             public std::enable_shared_from_this<ServerEndpoint> {
 public:
  ServerEndpoint(std::shared_ptr<Directory> directory,
                 std::shared_ptr<channel::Connection> connection);
  ~ServerEndpoint() override;

  [[nodiscard]] const ServiceClient& client() const { return client_; }
  [[nodiscard]] channel::Connection& connection() const { return *connection_; }
  [[nodiscard]] Callbacks& callbacks() { return callbacks_; }
  [[nodiscard]] Generators& generators() { return generators_; }
  [[nodiscard]] Belongings& belongings() { return belongings_; }
  /// The endpoint whose request this thread handles; null outside of handlers.
  static ServerEndpoint* current();
  /// The path of the object that it asks.
  static std::string_view current_path();

  /// Who is logged in; null for nobody.
  [[nodiscard]] std::shared_ptr<const User> user() const;

  /// Sends something that is not answered. Throws rr::Error for values that cannot be written; what
  /// cannot be sent is reported to the node's log, unless the client is gone.
  void send_packet(const EntryHeader& header, std::span<const Parameter> parameters,
                   const void* const* values, bool is_urgent = false);
  /// Puts the header of a message before an entry of the service's own, and sends it. Throws
  /// rr::Error.
  void send_request(Writer& entry, EntryType type, bool is_urgent);
  /// The service has released the object at a path and those below, for this client at least; who
  /// may hear of it is told.
  void release_path(const std::string& path, bool is_told);
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
  struct LateAnswer;
  void answer_late(const LateAnswer& late, const void* result);
  void answer_late(const LateAnswer& late, const Error& error);
  void answer_late_text(const LateAnswer& late, std::string_view text);

  void take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                   channel::Laters& laters) override;
  bool take_packet(const Message& message, const Entry& entry, const MemoryRef& owner,
                   channel::Laters& laters) override;
  void handle(const Message& message, const Entry& first, const MemoryRef& owner) override;
  void lost(const Error& why, channel::Laters& laters) override;
  void closed() override;
  void attend(channel::Time now) override;

 private:
  friend class Gathering;
  friend class Pipes;

  // Special requests (special_requests.cpp)
  void handle_special(const Message& message);
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
  void check_access(const Question& question);
  void log_in(std::string_view name, const std::map<std::string, VarValue>& credentials);
  std::shared_ptr<const User> need_user() const;
  void answer_session_operation(const Question& question);
  void answer_user_operation(const Question& question);
  void answer_monitor_operation(const Question& question);

  // Memories (memories.cpp)
  void answer_memory(const Question& question);
  void read_memory(const Question& question, Decoder& decoder, const Member& member,
                   MemorySource& memory);
  void write_memory(const Question& question, Decoder& decoder, const Member& member,
                    MemorySource& memory);
  void answer_memory_parameter(const Question& question, Decoder& decoder, const Member& member,
                               const MemorySource& memory);

  void end_members();
  void finish_late(const LateAnswer& late, Writer& writer);
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

  Callbacks callbacks_{*this};
  Generators generators_;
  Belongings belongings_;
  mutable std::mutex user_mutex_;
  std::shared_ptr<const User> user_;

  std::atomic<std::uint16_t> next_message_id_{0};
  std::atomic<channel::Time> last_heard_;

  Pipes pipes_{*this};

  // The object and the member that were asked last, with the dispatch turn. What is released is not
  // kept alive until the next request.
  std::string last_path_;
  std::weak_ptr<const ServedObject> last_object_;
  std::uint32_t last_generation_ = 0;
  const Member* last_member_ = nullptr;

  Wires wires_{*this};
};

/// What a late answer must remember of its question.
struct ServerEndpoint::LateAnswer {
  EntryType request_type;
  std::string path;
  std::string member_name;
  std::uint32_t request_id;
  const Member* member;
  std::shared_ptr<Gathering> gathering;
  std::size_t place;
};

}  // namespace rr::service
