// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Names on a broker: `rr/<site>/<node>/<service>/<path>/<member>`, one level for each step of an
/// object's path. Levels hold letters, digits, `_`, `-`, `[`, `]` and `%XX` for any other byte, so
/// that they are levels of MQTT and of NATS alike.
namespace rr::gateway {

/// One service of one robot, as a fleet names it.
struct ServiceAddress {
  std::string site;     ///< a plant, a hall
  std::string node;     ///< the robot
  std::string service;  ///< as the robot offers it

  /// Whether both are the same service.
  bool operator==(const ServiceAddress&) const = default;
};

/// The parts of a text between separators, empty ones too; at least one. They are of that text.
std::vector<std::string_view> parts_of(std::string_view text, char separator);

/// One step of an object's path: an objref, and its index.
struct PathStep {
  std::string name;                  ///< of the objref
  std::optional<std::string> index;  ///< as the program has it, not encoded; nothing for none
};

/// The steps of a path below the root object: `tools[left%20arm].axis`, empty for the root. Throws
/// rr::Error (invalid_argument) for what is no path.
std::vector<PathStep> path_steps(std::string_view path);
/// The path of an object below another.
std::string path_below(std::string_view path, const PathStep& step);

/// Whether a text may be a site, node, service, reader or user in topics: 1 to 64 letters, digits,
/// `_`, `-`.
bool is_level_name(std::string_view text);

/// What a request asks for, and the level in its topic. Names are those of `verb_name`.
enum class Verb : std::uint8_t {
  get,      ///< the value of a property, or a part of a memory
  set,      ///< a property or a part of a memory gets a value
  call,     ///< a function
  poke,     ///< a value for a wire
  send,     ///< packets for a pipe
  next,     ///< a step of a generator, or its end
  object,   ///< the type of the object at a path
  stream,   ///< records of a stream from a number on
  confirm,  ///< a reader has a stream up to a number
  connect,  ///< whether a lock keeps a client from connecting a wire
  lock,     ///< an object is locked or released, or its monitor is entered or left
  session,  ///< begin and end of a client's session at the robot, and that it is in use
};
/// All of them.
inline constexpr std::array all_verbs{Verb::get,     Verb::set,     Verb::call,   Verb::poke,
                                      Verb::send,    Verb::next,    Verb::object, Verb::stream,
                                      Verb::confirm, Verb::connect, Verb::lock,   Verb::session};
/// Packets that one request to send some may have.
inline constexpr std::size_t most_packets = 256;
/// Items of a memory that one request may read; gateways ask for less at a time.
inline constexpr std::uint64_t most_items = 1'048'576;
/// `get` for Verb::get.
std::string_view verb_name(Verb verb);

/// `rr/<site>/<node>`.
std::string node_topic(std::string_view site, std::string_view node);
/// `rr/<site>/<node>/<service>`.
std::string service_topic(const ServiceAddress& address);
/// Where the values, packets and events of a member are. `path` as for path_steps.
std::string member_topic(const ServiceAddress& address, std::string_view path,
                         std::string_view member);

/// What the topic of a request says. A broker can hold users to it: each user may publish only
/// below `$<verb>/<user>`.
struct RequestTopic {
  Verb verb = Verb::get;
  std::string user;    ///< of the broker
  std::string path;    ///< of the object; empty for Verb::session
  std::string member;  ///< empty for Verb::object, Verb::lock, Verb::session
};
/// `<service topic>/$<verb>/<user>/<path>/<member>`.
std::string request_topic(const ServiceAddress& address, const RequestTopic& request);
/// The reverse. Nothing for a topic that is no request to the service.
std::optional<RequestTopic> parse_request_topic(const ServiceAddress& address,
                                                std::string_view topic);
/// What to subscribe to for all requests of a verb.
std::string request_filter(const ServiceAddress& address, Verb verb);

/// Where a user's answers go: below `rr/$reply/<user>/`.
std::string reply_topic(std::string_view user, std::string_view instance);
/// Whether answers to `user` may go there.
bool is_reply_topic(std::string_view topic, std::string_view user);

/// Whether messages of a topic or filter may be retained: not requests, claims and answers.
bool may_be_retained(std::string_view filter);

/// Whether a topic fits a filter of MQTT (`+`, `#`).
bool topic_matches(std::string_view filter, std::string_view topic);

}  // namespace rr::gateway
