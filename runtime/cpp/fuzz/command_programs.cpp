// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/end_signals.hpp"
#include "cli/live/commands.hpp"
#include "cli/live/complete.hpp"
#include "cli/live/describe.hpp"
#include "cli/live/members.hpp"
#include "cli/live/watch.hpp"
#include "rr/dynamic.hpp"
#include "rr/printable.hpp"
#include "runtime/cpp/fuzz/client_programs.hpp"

namespace rr::fuzz {
namespace {

namespace live = robdef::live;
using dynamic::Object;

// A service may write for the terminal of whoever reads this.
void check_printed(const std::string& text) {
  promise(printable(text, printable_whole, LineBreaks::kept) == text,
          "what is printed does nothing to a terminal");
}

// What a command does and what it prints; an error as the command line prints it.
template <class Command>
void run(Attempts& attempts, const Command& command) {
  attempts.attempt([&] {
    std::ostringstream out;
    try {
      command(out);
    } catch (const Error& error) {
      check_printed(out.str());
      check_printed(printable(error.what(), robdef::longest_message));
      throw;
    }
    check_printed(out.str());
  });
}

using Use = void(const Object& root, Attempts& attempts);

template <Use* use>
void with_root(Node& node, std::string_view url, Attempts& attempts) {
  dynamic::Client client;
  run(attempts, [&](std::ostream&) { client = dynamic::connect(node, url); });
  if (!client.is_open()) return;
  attempts.watch(client);
  use(client.root(), attempts);
  attempts.attempt([&] { client.close(); });
}

robdef::LiveOptions options() {
  robdef::LiveOptions options;
  options.limit = 3;
  options.duration = std::chrono::milliseconds(1);
  return options;
}

void describe_text(const Object& root, Attempts& attempts) {
  for (const char* const path :
       {"", "title", "child", "props.t_tree", "child.next_child.number", "anything", "none"}) {
    run(attempts, [&](std::ostream& out) { live::describe_text(root, path, out); });
  }
  run(attempts, [&](std::ostream& out) { live::list_members(root, {}, out); });
}

void describe_json(const Object& root, Attempts& attempts) {
  for (const char* const path : {"", "props", "streams.exchange", "anything_by_number[3]"}) {
    run(attempts, [&](std::ostream& out) { live::describe_json(root, path, out); });
  }
}

void get(const Object& root, Attempts& attempts) {
  for (const char* const path :
       {"title", "props.v_double", "props.v_string", "props.v_mode", "props.a_double",
        "props.m_double", "props.l_string", "props.s_stats", "props.t_tree", "props.any",
        "props.p_reading", "props.n_image", "props.failing", "streams.state", "streams.force",
        "by_name[a b].title"}) {
    run(attempts, [&](std::ostream& out) { live::get(root, path, options(), out); });
  }
}

void get_memories(const Object& root, Attempts& attempts) {
  for (const char* const path : {"streams.bytes", "streams.grid", "streams.cells"}) {
    run(attempts, [&](std::ostream& out) { live::get(root, path, options(), out); });
    robdef::LiveOptions part = options();
    part.position = dynamic::Memory::Numbers{1};
    run(attempts, [&](std::ostream& out) { live::get(root, path, part, out); });
  }
}

void set(const Object& root, Attempts& attempts) {
  const std::array<std::pair<const char*, const char*>, 7> values = {
      {{"title", "\"title\""},
       {"props.v_double", "1.5"},
       {"props.a_double", "[1,2,3]"},
       {"props.t_leaf", R"({"name":"a","mode":"idle","stats":{"count":1,"mean":2,"label":"b"}})"},
       {"props.any", "{\"a\":1}"},
       {"streams.force", "[1,2,3]"},
       {"streams.bytes", "[1,2,3]"}}};
  for (const auto& value : values) {
    run(attempts, [&](std::ostream&) { live::set(root, value.first, value.second, options()); });
  }
}

void call(const Object& root, Attempts& attempts) {
  const std::vector<std::pair<const char*, std::vector<std::string>>> calls = {
      {"funcs.nothing", {}},
      {"funcs.add", {"1", "2"}},
      {"funcs.join", {"\"a\"", "\"b\"", "\"c\""}},
      {"funcs.echo_any", {"\"any\""}},
      {"funcs.make_stats", {"1", "2", "\"three\""}},
      {"errs.raise_service_fault", {"\"fault\""}},
      {"errs.raise_unknown_name", {"\"unknown\""}},
      {"streams.count", {"2"}},
      {"streams.take", {"\"ab\"", "1", "2"}},
      {"streams.exchange", {"1", "\"two\""}},
  };
  for (const auto& one : calls) {
    run(attempts, [&](std::ostream& out) {
      live::call(
          root, one.first, one.second, options(),
          []() -> std::optional<std::string> { return std::nullopt; }, out);
    });
  }
}

void complete(const Object& root, Attempts& attempts) {
  for (const char* const word : {"", "pr", "child.", "anything.", "by_name["}) {
    run(attempts, [&](std::ostream& out) {
      for (const std::string& each : live::completions(root, {}, "get", word)) {
        out << printable(each) << '\n';
      }
    });
  }
}

void watch(const Object& root, Attempts& attempts) {
  const std::vector<std::string> members = {"streams.force", "streams.state", "streams.leaves",
                                            "streams.parcels", "streams.fired"};
  run(attempts, [&](std::ostream& out) {
    const robdef::LiveOptions how = options();
    const robdef::EndSignals signals;
    live::Watch watch(members, how);
    watch.attach(root);
    static_cast<void>(root.object("streams").call("fire"));
    watch.run(signals, out);
    watch.close();
  });
}

}  // namespace

std::span<ClientProgram* const> command_programs() {
  static constexpr std::array<ClientProgram*, 8> programs = {
      with_root<describe_text>, with_root<describe_json>, with_root<get>,
      with_root<get_memories>,  with_root<set>,           with_root<call>,
      with_root<complete>,      with_root<watch>};
  return programs;
}

}  // namespace rr::fuzz
