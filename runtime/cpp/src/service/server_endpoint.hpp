// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
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
#include "runtime/cpp/src/service/object_tree.hpp"
#include "runtime/cpp/src/service/pipes.hpp"

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
  /// The endpoint whose request this thread handles; null outside of handlers.
  static ServerEndpoint* current();

  /// Sends something that is not answered. Failures are ignored.
  void send_packet(const EntryHeader& header, std::span<const Parameter> parameters,
                   const void* const* values);
  /// Sends a message of one entry, whose elements are in the writer, that is not answered: one of a
  /// stream. Throws rr::Error.
  void stream_packet(Writer& writer, const EntryHeader& header, std::string_view metadata);
  /// The object at a path is released.
  void release(std::string_view path) { pipes_.release(path); }
  /// Ends the session, and soon the connection.
  void leave();

  // Answers of session requests. What cannot be written throws rr::Error, and nothing is sent.
  void answer_value(const Question& question, std::string_view name, const Type& type,
                    const void* value);
  void answer_empty(const Question& question);
  /// An answer whose elements are in the writer.
  void answer_elements(const Question& question, Writer& writer, std::uint32_t element_count,
                       std::string_view metadata = {});
  /// Nothing, for what is not answered.
  void answer_nothing(const Question& question);
  /// The thread's writer, ready for the elements of an answer.
  [[nodiscard]] Writer& answer_writer(const Question& question) const;
  void answer_error(const Question& question, const Error& error);
  /// The same for an answer given later, by what is left of its question then.
  struct LateAnswer;
  void answer_late(const LateAnswer& late, const void* result);
  void answer_late(const LateAnswer& late, const Error& error);

  void take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
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
  void quit();

  // Session requests (session_requests.cpp)
  void handle_session(const Message& message, const Entry& first, const MemoryRef& owner);
  void handle_question(const Question& question);
  void answer_question(const Question& question);
  void answer_session_object_type(const Question& question);
  void answer_session_operation(const Question& question);
  void answer_member(const Question& question, MemberKind kind);
  void answer_unserved(const Question& question);
  std::shared_ptr<const ServedObject> find_object(std::string_view path);
  const Member& find_member(const ServedObject& object, std::string_view name, MemberKind kind);

  void finish(const Question& question, Writer& writer, std::string_view metadata = {});
  void finish_late(const LateAnswer& late, Writer& writer);
  enum class Way : std::uint8_t { reply, send, stream };
  void send_answer(Writer& writer, std::uint32_t entry_count, EntryType single_type, Way way,
                   std::string_view metadata = {});
  [[nodiscard]] bool is_in_session(const Message& message) const;
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
  bool is_leaving_ = false;             // has said farewell; with the dispatch turn

  std::atomic<std::uint16_t> next_message_id_{0};
  std::atomic<channel::Time> last_heard_;

  Pipes pipes_{*this};

  // The object and the member that were asked last, with the dispatch turn.
  std::string last_path_;
  std::shared_ptr<const ServedObject> last_object_;
  std::uint32_t last_generation_ = 0;
  const Member* last_member_ = nullptr;
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
