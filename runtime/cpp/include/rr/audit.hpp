// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "rr/node_id.hpp"
#include "rr/visibility.hpp"

/// Who did what with the services of a node (docs/howto/access.md).
namespace RR_VISIBLE rr {

/// What has happened.
enum class AuditKind : std::uint8_t {
  connect,     ///< a client has connected to a service
  disconnect,  ///< its session has ended
  login,       ///< a user has logged in, or was refused
  logout,      ///< a user has logged out, or was replaced by another one
  lock,        ///< an object was locked, or a monitor entered
  unlock,      ///< a lock was released, or a monitor left
  access,      ///< an entry was denied, or handled where AuditOptions::requests says so
  ended,       ///< what a session had opened was ended, because it lost the right to it
};

/// `connect`, `login` and so on.
std::string_view audit_kind_name(AuditKind kind);

/// One thing that has happened. Texts of a peer are as it sent them; credentials are never among
/// them.
struct AuditEvent {
  std::chrono::system_clock::time_point time{};  ///< when it happened
  AuditKind kind = AuditKind::access;            ///< what has happened
  bool is_allowed = true;                        ///< false for what was refused or has failed
  std::string service;                           ///< its name
  std::string path;                              ///< of the object; empty where there is none
  std::string member;                            ///< its name; empty where there is none
  std::string operation;  ///< `get`, `call`, `RequestObjectLock` ...; empty where the kind says all
  std::string user;       ///< the user that is logged in, or wanted to be; may be empty
  NodeId node;            ///< what the client says of itself
  std::string node_name;  ///< as it says; empty for none
  std::uint32_t client = 0;  ///< the number of the session's endpoint in this node
  std::string address;      ///< `10.0.0.5`, `uid 1000` of a local socket, `intra`; empty if unknown
  std::string certificate;  ///< the node id that the client's certificate has proved; empty without
  std::string reason;       ///< why it was refused
  std::size_t left_out = 0;  ///< refusals of the same session before this one that were not told
};

/// Which events are reported, and to whom.
struct AuditOptions {
  /// Called on any thread, under no lock of the runtime, for several events at once. What it throws
  /// goes to the log.
  std::function<void(const AuditEvent&)> on_event{};
  /// Whether each handled request is reported, too: gets, sets, calls, reads and the like;
  /// not packets.
  bool requests = false;
  /// Refused entries of a session that are reported in ten seconds; further ones are counted.
  std::size_t refusals = 50;
};

/// Writes events to a file, one JSON object a line:
///
///   rr::Node node({.audit = {.on_event = rr::AuditLog("/var/log/robot/audit.jsonl")}});
///
/// A line is written with one call of the system when the event happens, and is in the hands of the
/// system then. Copies write to the same file.
class AuditLog {
 public:
  /// How large the files get, and how many are kept.
  struct Options {
    /// A file that would become larger is renamed to `path.1`, that to `path.2` and so on.
    std::size_t max_size = std::size_t{16} * 1024 * 1024;
    /// How many of these are kept.
    unsigned kept_files = 5;
  };

  /// Opens or makes the file, which only its owner may read (0600). Throws rr::Error
  /// (invalid_configuration) when that fails, and for what is no regular file, such as a link.
  explicit AuditLog(std::string path) : AuditLog(std::move(path), Options()) {}
  /// The same with limits of its own.
  AuditLog(std::string path, Options options);
  /// Throws rr::Error (io_error) when the file cannot be written.
  void operator()(const AuditEvent& event) const;

  /// The line of an event, with its line feed.
  static std::string line(const AuditEvent& event);

 private:
  class File;
  std::shared_ptr<File> file_;
};

}  // namespace rr
