// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string_view>
#include <unordered_map>

#include "rr/error.hpp"
#include "runtime/matlab/src/call.hpp"

namespace rr::matlab {

std::chrono::milliseconds to_milliseconds(double seconds) {
  if (std::isnan(seconds)) throw Misfit("expected seconds, got NaN");
  if (seconds < 0 || seconds > 1e12) return std::chrono::milliseconds::max();
  return std::chrono::milliseconds(std::llround(seconds * 1000));
}

std::chrono::milliseconds Call::seconds(std::size_t index) const {
  if (!has(index)) return std::chrono::milliseconds::max();
  return to_milliseconds(read_number<double>((*this)[index]));
}

void run_command(Runtime& runtime, const std::string& name, Call& call) {
  using Table = std::unordered_map<std::string_view, void (*)(Runtime&, Call&)>;
  static const Table table = [] {
    Table all;
    for (const auto& list :
         {session_commands(), object_commands(), async_commands(), dotted_commands(),
          event_commands(), wire_commands(), pipe_commands(), memory_commands(),
          generator_commands(), lock_commands(), definition_commands(), subscription_commands(),
          member_subscription_commands(), discovery_commands(), node_commands(), typed_commands(),
          record_commands(), service_commands(), served_commands()}) {
      for (const Command& command : list) all.emplace(command.name, command.run);
    }
    return all;
  }();
  const auto found = table.find(name);
  if (found == table.end()) {
    throw Error(ErrorCode::invalid_argument, "there is no command `" + name + "`");
  }
  found->second(runtime, call);
}

}  // namespace rr::matlab
