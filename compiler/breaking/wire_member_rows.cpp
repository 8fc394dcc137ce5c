// SPDX-License-Identifier: Apache-2.0
// Members: which requests are answered, and what they carry.
#include <mutex>
#include <semaphore>

#include "compiler/breaking/testing.hpp"
#include "compiler/breaking/wire_rows.hpp"
#include "rr/error.hpp"
#include "rr/service.hpp"

namespace robdef::breaking::testing {
namespace {

using rr::dynamic::List;
using rr::dynamic::ServedObject;
using rr::dynamic::StringMap;
using rr::dynamic::Value;

constexpr std::chrono::seconds limit{20};

bool has_member(const std::vector<rr::dynamic::MemberDescription>& all, const std::string& name) {
  for (const auto& member : all) {
    if (member.name == name) return true;
  }
  return false;
}

// A function `f` that gives a number.
void serve_f(const ServedObject& object, bool is_new) {
  static_cast<void>(is_new);
  if (has_member(object.members(), "f")) {
    object.on_call("f", [](const List&) { return Value(5.0); });
  }
}

Use calls(const List& old_arguments, const List& new_arguments) {
  return [=](Meeting& meeting) {
    return meeting.object.call("f", meeting.is_client_new ? new_arguments : old_arguments)
        .to_json();
  };
}

// What a client that knows the member does with it.
Use if_known(const Use& use) {
  return [=](Meeting& meeting) {
    return has_member(meeting.object.members(), "v") ? use(meeting) : std::string("unknown");
  };
}

void serve_v(const ServedObject& object, bool is_new) {
  static_cast<void>(is_new);
  if (has_member(object.members(), "v")) object.store("v", 1.0);
}

// What an event brings before the one that follows it.
std::string hear(Meeting& meeting) {
  std::mutex mutex;
  std::string heard = "nothing";
  std::binary_semaphore is_done{0};
  rr::Subscription first;
  if (has_member(meeting.object.members(), "v")) {
    first = meeting.object.on_event("v", [&](const List& arguments) {
      const std::lock_guard lock(mutex);
      heard = arguments.empty() ? "nothing in it" : arguments.front().to_json();
    });
  } else {
    heard = "unknown";
  }
  const rr::Subscription last =
      meeting.object.on_event("done", [&](const List&) { is_done.release(); });
  if (has_member(meeting.served.members(), "v")) {
    List arguments;
    for (const auto& parameter : meeting.served.member("v").parameters) {
      static_cast<void>(parameter);
      arguments.emplace_back(1.0 + static_cast<double>(arguments.size()));
    }
    meeting.served.fire("v", arguments);
  }
  meeting.served.fire("done");
  if (!is_done.try_acquire_for(limit)) return "no end";
  const std::lock_guard lock(mutex);
  return heard;
}

// The service calls `v` of its client while the client calls `f`.
void serve_calling(const ServedObject& object, bool is_new) {
  static_cast<void>(is_new);
  object.on_call("f", [weak = rr::dynamic::WeakServedObject(object)](const List&) {
    const ServedObject self = weak.lock();
    List arguments;
    for (const auto& parameter : self.member("v").parameters) {
      static_cast<void>(parameter);
      arguments.emplace_back(1.0);
    }
    return self.call_back("v", rr::ServiceContext::current_client(), arguments);
  });
}

std::string be_called(Meeting& meeting) {
  meeting.object.callback("v").set([](const List&) { return Value(7.0); });
  return meeting.object.call("f").to_json();
}

void serve_steps(const ServedObject& object, bool is_new) {
  static_cast<void>(is_new);
  const auto member = object.member("v");
  if (member.generator == rr::GeneratorForm::none) {
    object.on_call("v", [](const List&) { return Value(3.0); });
    return;
  }
  object.on_generate("v", [](const List&) {
    return rr::dynamic::Steps(rr::Function<std::optional<Value>(const Value&)>(
        [](const Value&) -> std::optional<Value> { return Value(3.0); }));
  });
}

std::string step(Meeting& meeting) {
  const auto member = meeting.object.member("v");
  if (member.generator == rr::GeneratorForm::none) return meeting.object.call("v").to_json();
  rr::dynamic::Generator generator = meeting.object.generate("v");
  const bool takes = member.generator != rr::GeneratorForm::returns;
  const auto value = generator.next(takes ? Value(1.0) : Value());
  return value ? value->to_json() : "end";
}

// Packets that arrive before a call that follows them.
std::string send_packet(Meeting& meeting) {
  std::mutex mutex;
  std::string got = "nothing";
  std::vector<rr::Subscription> kept;
  if ((meeting.served.member("v").access & rr::readonly) == 0) {
    meeting.served.pipe("v").on_connect([&](rr::dynamic::PipeEndpoint end) {
      kept.push_back(end.on_packet([&](const Value& packet) {
        const std::lock_guard lock(mutex);
        got = packet.to_json();
      }));
    });
  }
  if ((meeting.object.member("v").access & rr::readonly) != 0) return "none to send";
  rr::dynamic::PipeEndpoint end = meeting.object.pipe("v").connect();
  end.send(1.0);
  meeting.object.call("f");
  const std::lock_guard lock(mutex);
  return got;
}

}  // namespace

std::vector<Row> member_rows() {
  const std::string f = "function double f()";
  const std::string f1 = "function double f(double a)";
  const std::string f2 = "function double f(double a, double b)";
  const std::string done = "event done()\n";
  const std::string call = "\nfunction double f()";
  return {
      members("a property that is gone", "R0703", "property double v", "", serve_v, if_known(get),
              "refused: MemberNotFound", "works"),
      members("a property with another name", "R0703", "property double v", "property double w",
              serve_v, if_known(get), "refused: MemberNotFound", "works"),
      members(
          "a function that is gone", "R0703", f, "", serve_f,
          [](Meeting& meeting) {
            return meeting.is_client_new ? "unknown" : meeting.object.call("f").to_json();
          },
          "refused: MemberNotFound", "works"),
      members("an event that is gone", "R0703", done + "event v(double a)", done, serve_nothing,
              hear, "silent: nothing", "works"),
      members("a wire that is gone", "R0703", "wire double v", "", serve_nothing,
              if_known([](Meeting& meeting) {
                meeting.object.wire("v").connect();
                return std::string("connected");
              }),
              "refused: MemberNotFound", "works"),
      members("a pipe that is gone", "R0703", "pipe double v", "", serve_nothing,
              if_known([](Meeting& meeting) {
                meeting.object.pipe("v").connect();
                return std::string("connected");
              }),
              "refused: MemberNotFound", "works"),
      members(
          "a callback that is gone on the client", "R0703", "callback double v()" + call, call,
          [](const ServedObject& object, bool is_new) {
            if (is_new)
              serve_f(object, is_new);
            else
              serve_calling(object, is_new);
          },
          [](Meeting& meeting) {
            return meeting.is_client_new
                       ? "called: " + std::to_string(meeting.object.call("f").is_null())
                       : be_called(meeting);
          },
          "silent: 5", "refused: MemberNotFound"),
      members(
          "a property that becomes a wire", "R0704", "property double v", "wire double v",
          [](const ServedObject& object, bool is_new) {
            if (is_new) {
              object.wire("v").set_in(1.0);
            } else {
              object.store("v", 1.0);
            }
          },
          [](Meeting& meeting) {
            return meeting.is_client_new ? meeting.object.wire("v").peek_in().value.to_json()
                                         : get(meeting);
          },
          "refused: MemberNotFound", "refused: MemberNotFound"),
      members("a function with another result", "R0705", f, "function single f()", serve_f,
              calls({}, {}), "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
      members("a function that no longer gives a result", "R0705", "function int32 f()",
              "function void f()", serve_f, calls({}, {}), "silent: 0", "works"),
      members("a new parameter", "R0707", f1, f2, serve_f, calls({1}, {1, 2}),
              "refused: MessageElementNotFound", "works"),
      members("a parameter that is gone", "R0708", f2, f1, serve_f, calls({1, 2}, {1}), "works",
              "refused: MessageElementNotFound"),
      members("a parameter with another name", "R0709", f1, "function double f(double x)", serve_f,
              calls({1}, {1}), "refused: MessageElementNotFound",
              "refused: MessageElementNotFound"),
      members("a parameter of another type", "R0705", f1, "function double f(single a)", serve_f,
              calls({1}, {1}), "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
      members("a new parameter of an event", "R0707", done + "event v(double a)",
              done + "event v(double a, double b)", serve_nothing, hear, "works",
              "silent: nothing"),
      members("a parameter of an event that is gone", "R0708", done + "event v(double a, double b)",
              done + "event v(double a)", serve_nothing, hear, "silent: nothing", "works"),
      members("a parameter of an event with another name", "R0709", done + "event v(double a)",
              done + "event v(double b)", serve_nothing, hear, "silent: nothing",
              "silent: nothing"),
      members("a new parameter of a callback", "R0707", "callback double v()" + call,
              "callback double v(double a)" + call, serve_calling, be_called, "works",
              "refused: MessageElementNotFound"),
      members("another result of a callback", "R0705", "callback double v()" + call,
              "callback single v()" + call, serve_calling, be_called, "refused: DataTypeMismatch",
              "refused: DataTypeMismatch"),
      members("a function that becomes a generator", "R0716", "function double v()",
              "function double{generator} v()", serve_steps, step,
              "refused: MessageElementNotFound", "refused: MessageElementNotFound"),
      members("a generator that takes values, too", "R0716", "function double{generator} v()",
              "function double{generator} v(double{generator} x)", serve_steps, step,
              "refused: MessageElementNotFound", "works"),
      members("a generator of another type", "R0705", "function double{generator} v()",
              "function single{generator} v()", serve_steps, step, "refused: DataTypeMismatch",
              "refused: DataTypeMismatch"),
      members(
          "a property that is now readonly", "R0720", "property double v",
          "property double v [readonly]", stores(1.0),
          [](Meeting& meeting) {
            if (!meeting.is_client_new) meeting.object.set("v", 2.0);
            return std::string("set");
          },
          "refused: ReadOnlyMember", "works"),
      members(
          "a property that is now writeonly", "R0720", "property double v",
          "property double v [writeonly]", stores(1.0),
          [](Meeting& meeting) {
            if (!meeting.is_client_new) return get(meeting);
            meeting.object.set("v", 1.0);
            return std::string("set");
          },
          "refused: WriteOnlyMember", "works"),
      members("a pipe that is now readonly", "R0720", "pipe double v" + call,
              "pipe double v [readonly]" + call, serve_f, send_packet, "silent: nothing", "works"),
      members(
          "a wire that is now readonly", "R0720", "wire double v", "wire double v [readonly]",
          [](const ServedObject&, bool) {},
          [](Meeting& meeting) {
            if (!meeting.is_client_new) meeting.object.wire("v").poke_out(1.0);
            return std::string("poked");
          },
          "refused: ReadOnlyMember", "works"),
      members(
          "a memory that is now readonly", "R0720", "memory double[] v",
          "memory double[] v [readonly]",
          [](const ServedObject& object, bool) {
            object.store_memory("v", List{1, 2});
          },
          [](Meeting& meeting) {
            if (!meeting.is_client_new) meeting.object.memory("v").write({0}, List{3});
            return std::string("written");
          },
          "refused: ReadOnlyMember", "works"),
      members(
          "a memory that gets dimensions", "R0705", "memory double[] v", "memory double[*] v",
          [](const ServedObject& object, bool is_new) {
            if (is_new) {
              object.store_memory("v", rr::MultiArray<double>{{1, 2}, {1, 2}});
            } else {
              object.store_memory("v", List{1, 2});
            }
          },
          [](Meeting& meeting) {
            const rr::dynamic::Memory::Numbers position(meeting.is_client_new ? 2 : 1, 0);
            const rr::dynamic::Memory::Numbers count(meeting.is_client_new ? 2 : 1, 1);
            return std::to_string(meeting.object.memory("v").read(position, count).size());
          },
          "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
      members(
          "a wire of another type", "R0705", "wire double v", "wire single v",
          [](const ServedObject& object, bool) { object.wire("v").set_in(1.0); },
          [](Meeting& meeting) { return meeting.object.wire("v").peek_in().value.to_json(); },
          "refused: DataTypeMismatch", "refused: DataTypeMismatch"),
  };
}

}  // namespace robdef::breaking::testing
