// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rr/users.hpp"
#include "rr/visibility.hpp"

/// What each user may do with a service (docs/howto/access.md).
namespace RR_VISIBLE rr {

/// What can be done with a member or an object. Each is a bit of a RightSet.
enum class Right : std::uint16_t {
  get = 1 << 0,        ///< get a property
  set = 1 << 1,        ///< set a property
  call = 1 << 2,       ///< call a function, step through its generator
  connect = 1 << 3,    ///< connect a pipe or a wire, and receive what the service sends by it
  send = 1 << 4,       ///< send by a connected pipe or wire
  peek = 1 << 5,       ///< ask for the value of a wire without connecting
  poke = 1 << 6,       ///< set the value of a wire without connecting
  read = 1 << 7,       ///< read a memory
  write = 1 << 8,      ///< write a memory
  event = 1 << 9,      ///< receive an event
  callback = 1 << 10,  ///< be called by the service
  lock = 1 << 11,      ///< lock an object, enter its monitor
  describe = 1 << 12,  ///< ask for the type of an object, which following an objref does
};

/// Rights, as bits.
using RightSet = std::uint16_t;
/// Both rights.
constexpr RightSet operator|(Right a, Right b) {
  return static_cast<RightSet>(static_cast<RightSet>(a) | static_cast<RightSet>(b));
}
/// These rights and one more.
constexpr RightSet operator|(RightSet a, Right b) {
  return static_cast<RightSet>(a | static_cast<RightSet>(b));
}
/// Whether a set has a right.
constexpr bool has_right(RightSet rights, Right right) {
  return (rights & static_cast<RightSet>(right)) != 0;
}
/// The set that has every right.
inline constexpr RightSet all_rights = (1U << 13) - 1;

/// `get`, `call` and so on, as rules say it.
std::string_view right_name(Right right);

/// Rules that say what users may do. The first rule that matches decides; what no rule matches is
/// denied. As text, one rule a line, `#` begins a comment:
///
///   allow role:operator path arm.** access get,call,connect,describe
///   deny  user:guest    path arm.tools[*] member speed,force access set
///   allow anyone        path arm member status access get
///
/// Who: `anyone`, `user:*` (every user that is logged in), `user:NAME`, or `role:NAME`, which is a
/// privilege of the user. `path`: objects as the protocol names them, beginning with the service;
/// `*` is any step or any index, `**` at the end is the object and all below it. `member`: names,
/// or
/// `*`. `access`: names of rights, or `*`. What a rule leaves out is everything: `path **`,
/// `member *`, `access *`. Lists are separated by commas.
///
/// A rule that allows anything allows `describe` too, of its objects and of those on the way to
/// them.
class Rights {
 public:
  /// A rule in its parts, as rules are written.
  struct Rule {
    bool is_allowed = true;      ///< `allow`; false: `deny`
    std::string who = "anyone";  ///< `anyone`, `user:NAME` or `role:NAME`
    std::string path = "**";     ///< of objects
    std::string member = "*";    ///< names, or `*`
    std::string access = "*";    ///< names of rights, or `*`
  };

  /// Throws rr::Error (invalid_configuration) whose message begins `source:line:column:`.
  explicit Rights(std::string_view text, const std::string& source = "rights");
  /// Throws the same, naming the number of the rule.
  explicit Rights(const std::vector<Rule>& rules);
  /// Throws as well when the file cannot be read, or has more than 1 MiB.
  static std::shared_ptr<const Rights> from_file(const std::string& path);
  ~Rights();
  Rights(const Rights&) = delete;
  Rights& operator=(const Rights&) = delete;

  /// What a user may do with a member of the object at a path. `user` is null for a client that is
  /// not logged in, `member` empty for the object itself.
  [[nodiscard]] RightSet of(const User* user, std::string_view path, std::string_view member) const;

  /// For the runtime: a rule that has been read.
  struct Line;  // internal: a rule that has been read
  /// For the runtime: the rules in their order.
  [[nodiscard]] const std::vector<Line>& rr_lines() const { return lines_; }

 private:
  std::vector<Line> lines_;
};

}  // namespace rr
