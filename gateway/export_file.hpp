// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/broker_options.hpp"

/// What of which service goes out to a broker: a file in TOML (docs/howto/fleet.md). What it does
/// not list stays inside.
namespace rr::gateway {

/// What a rule allows, added up.
enum Allowed : std::uint8_t {
  reading = 1,  ///< properties, values of wires, packets of pipes, events, memories
  writing = 2,  ///< properties, values for wires, memories
  calling = 4,  ///< functions and callbacks
  locking = 8,  ///< locks and monitors of the objects, whatever the members
};

/// An entry of the allow list: `[[service.allow]]`.
struct ExportRule {
  std::string path;                  ///< of objects, with `*` for any part of a step; empty: root
  std::vector<std::string> members;  ///< names, with `*` for any part of them
  std::uint8_t access = 0;           ///< Allowed, added up
  std::vector<std::string> users;    ///< of the broker; empty: all
  /// The shortest time between two values of a wire; 0: each value.
  std::chrono::nanoseconds period{0};
  /// How long the value of a wire counts; nothing: for ever.
  std::optional<std::chrono::seconds> lifespan;
};

/// A user of the broker, or a client that has logged in at that user's serving gateway.
struct BrokerUser {
  std::string name;
  std::string client{};  ///< the name in that login; empty: the user itself
  auto operator<=>(const BrokerUser&) const = default;
};

/// Who such a user is for the service: `[[service.user]]`.
struct MappedUser {
  std::string name;      ///< of the service
  std::string password;  ///< from the file that the export file names
};

/// `[[service]]`.
struct ExportedServiceOptions {
  std::string name;                  ///< the level in topics
  std::string url;                   ///< where the robot offers it
  MappedUser login;                  ///< who the gateway itself is there; no name: nobody
  std::vector<std::string> readers;  ///< streams are kept until these have confirmed
  std::uint64_t log_bytes = std::uint64_t{256} * 1024 * 1024;  ///< of each stream
  std::chrono::seconds log_age = std::chrono::hours(24 * 7);   ///< of the oldest record
  /// A far client's own session at the robot ends when its gateway has said nothing for so long.
  std::chrono::seconds session_limit{30};
  std::vector<ExportRule> rules;
  std::map<BrokerUser, MappedUser> users;  ///< see login_of()
};

/// A whole export file.
struct ExportFile {
  std::string site;
  std::string node;
  std::string state_folder;  ///< where streams and calls are logged
  BrokerOptions broker;
  std::vector<ExportedServiceOptions> services;
};

/// Whether the files of passwords are read: their users need them, lists of rights do not.
enum class Secrets { read, ignored };

/// Reads an export file. Throws rr::Error (invalid_configuration) with a line
/// `file:line:column: what is wrong` for each mistake, and resource_not_found for a file that
/// cannot be read. Paths in it are relative to its folder.
ExportFile read_export_file(const std::string& path, Secrets secrets = Secrets::read);
/// The same for a text; `name` stands for the file in errors.
ExportFile parse_export_file(const std::string& name, std::string text,
                             Secrets secrets = Secrets::read);

/// Whether `text` fits `pattern`, in which `*` stands for any letters.
bool fits(std::string_view pattern, std::string_view text);
/// The same for paths of objects, where `*` stands for letters of one step: `tools[*]` is no object
/// below a tool.
bool path_fits(std::string_view pattern, std::string_view path);
/// The first rule that allows any of `access`, which is Allowed, added up; null when none does. For
/// `locking` alone the member does not matter. `user` is empty for what is published to all: then
/// rules for single users do not count.
const ExportRule* find_rule(const ExportedServiceOptions& service, std::string_view user,
                            std::string_view path, std::string_view member, unsigned access);

/// Who a user is at the service: the entry of the client, without one that of the broker's user,
/// without that the login of the gateway itself.
const MappedUser& login_of(const ExportedServiceOptions& service, const BrokerUser& user);

/// Whether any rule is for a user of the broker.
bool is_user(const ExportedServiceOptions& service, std::string_view user);

/// The content of a file without the line break at its end. Throws rr::Error (resource_not_found).
std::string read_secret(const std::string& path);

}  // namespace rr::gateway
