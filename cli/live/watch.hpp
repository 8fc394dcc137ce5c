// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <rr/dynamic.hpp>
#include <span>
#include <string>
#include <vector>

#include "cli/live/object_path.hpp"
#include "cli/live_options.hpp"
#include "cli/system/end_signals.hpp"
#include "compiler/driver/compile.hpp"

/// Values of wires, packets of pipes and events as they come: an object of JSON a line, with
/// `member` as it was asked for, the sender's `time` where it is sent, and `value`; the parameters
/// of an event are the fields of its value.
namespace robdef::live {

class WatchQueue;

/// The members that are watched, at one connection after the other.
class Watch {
 public:
  /// Throws rr::Error (invalid_argument) for what is no path of a member.
  Watch(std::span<const std::string> members, const LiveOptions& options);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// Something that `run` is to do between two values; from any thread.
  void post(std::function<void()> work);
  /// Connects the members of a service. Throws rr::Error (member_format_mismatch for a member of
  /// another kind).
  void attach(const rr::dynamic::Object& root);
  /// Prints until there are enough, the time is over, the program is to end, or nothing can be
  /// printed any more. Throws what posted work throws.
  void run(const EndSignals& signals, std::ostream& out);
  /// Disconnects the members; what comes now is not printed. To be called before the node ends.
  void close();

 private:
  struct Ends;
  void attach(const rr::dynamic::Object& object, const MemberPath& path, const std::string& text);

  const LiveOptions& options_;
  std::vector<std::pair<std::string, MemberPath>> members_;
  std::shared_ptr<WatchQueue> queue_;
  std::unique_ptr<Ends> ends_;
};

/// Watches members of the service at a URL, and connects again when the connection is lost, which
/// it says on `err`. Throws rr::Error when the first attempt fails.
ExitStatus watch_service(const std::string& url, std::span<const std::string> members,
                         const LiveOptions& options, std::ostream& out, std::ostream& err);

}  // namespace robdef::live
