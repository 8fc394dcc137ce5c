// SPDX-License-Identifier: Apache-2.0
#include "cli/live/watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ostream>
#include <rr/error.hpp>
#include <rr/printable.hpp>
#include <string_view>
#include <utility>

#include "cli/live/commands.hpp"
#include "cli/live/connection.hpp"
#include "cli/live/members.hpp"
#include "cli/live/watch_queue.hpp"
#include "compiler/output/json.hpp"

namespace robdef::live {
namespace {

namespace dynamic = rr::dynamic;
using Clock = std::chrono::steady_clock;
using dynamic::List;
using dynamic::MemberDescription;
using dynamic::Value;
using rr::MemberKind;

// As RFC 3339 writes it; what is no such time in seconds.
std::string time_text(const rr::TimeSpec& time) {
  constexpr std::int64_t first_second = -62'167'219'200;  // of the year 0
  constexpr std::int64_t last_second = 253'402'300'799;   // of the year 9999
  if (time.seconds < first_second || time.seconds > last_second) {
    return fmt::format("{}.{:09}", time.seconds, time.nanoseconds);
  }
  const std::chrono::sys_seconds second{std::chrono::seconds(time.seconds)};
  const auto day = std::chrono::floor<std::chrono::days>(second);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss clock(second - day);
  return fmt::format("\"{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:09}Z\"", int(date.year()),
                     unsigned(date.month()), unsigned(date.day()), clock.hours().count(),
                     clock.minutes().count(), clock.seconds().count(), time.nanoseconds);
}

std::string line_of(const std::string& member, const std::string& time, const std::string& value) {
  return "{\"member\":" + json_string(member) + (time.empty() ? "" : ",\"time\":" + time) +
         ",\"value\":" + value + "}";
}

std::string arguments_json(const MemberDescription& event, const List& arguments) {
  std::string text;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const dynamic::ParameterDescription& parameter = event.parameters[i];
    text += (i == 0 ? "" : ",") + json_string(parameter.name) + ":" +
            parameter.type.to_json(arguments[i]);
  }
  return "{" + text + "}";
}

}  // namespace

// What is connected at the newest connection.
struct Watch::Ends {
  std::vector<rr::Subscription> handlers;
  std::vector<dynamic::WireConnection> wires;
  std::vector<dynamic::PipeEndpoint> pipes;
  std::vector<dynamic::Object> objects;  // of events, which last as long

  void close() {
    handlers.clear();
    for (dynamic::WireConnection& wire : wires) wire.close();
    for (dynamic::PipeEndpoint& pipe : pipes) pipe.close();
    wires.clear();
    pipes.clear();
    objects.clear();
  }
};

Watch::Watch(std::span<const std::string> members, const LiveOptions& options)
    : options_(options), queue_(std::make_shared<WatchQueue>()), ends_(std::make_unique<Ends>()) {
  for (const std::string& member : members) {
    members_.emplace_back(member, parse_member_path(member));
  }
}

Watch::~Watch() { close(); }

void Watch::close() {
  queue_->close();  // first, so that no handler waits there
  ends_->close();
}

void Watch::post(std::function<void()> work) { queue_->put_work(std::move(work)); }

void Watch::attach(const dynamic::Object& root) {
  ends_->close();
  for (const auto& [text, path] : members_) attach(object_at(root, path.object), path, text);
}

void Watch::attach(const dynamic::Object& object, const MemberPath& path, const std::string& text) {
  const MemberDescription member = object.member(path.member);
  const auto put = [queue = queue_, text, type = member.type](const Value& value,
                                                              const std::string& time) {
    queue->put_line(line_of(text, time, type.to_json(value)));
  };
  if (member.kind == MemberKind::wire) {
    ends_->wires.push_back(object.wire(member.name).connect());
    ends_->handlers.push_back(ends_->wires.back().on_in(
        [put](const Value& value, const rr::TimeSpec& time) { put(value, time_text(time)); }));
  } else if (member.kind == MemberKind::pipe) {
    ends_->pipes.push_back(object.pipe(member.name).connect());
    ends_->handlers.push_back(
        ends_->pipes.back().on_packet([put](const Value& packet) { put(packet, ""); }));
  } else if (member.kind == MemberKind::event) {
    ends_->objects.push_back(object);
    ends_->handlers.push_back(
        object.on_event(member.name, [queue = queue_, text, member](const List& arguments) {
          queue->put_line(line_of(text, "", arguments_json(member, arguments)));
        }));
  } else {
    throw rr::Error(
        rr::ErrorCode::member_format_mismatch,
        "member " + member.name + ": expected wire, pipe or event, got " + kind_of(member));
  }
}

void Watch::run(const EndSignals& signals, std::ostream& out) {
  // Signals are looked for so often.
  constexpr std::chrono::milliseconds turn{100};
  const auto begin = Clock::now();
  const auto is_over = [&] {
    return options_.duration && Clock::now() - begin >= *options_.duration;
  };
  std::uint64_t count = 0;
  while (out && !is_over() && !signals.has_come() && (!options_.limit || count < *options_.limit)) {
    auto until = Clock::now() + turn;
    if (options_.duration) until = std::min(until, begin + *options_.duration);
    const auto item = queue_->take(until);
    if (!item) continue;
    if (item->work) {
      item->work();
      continue;
    }
    out << rr::printable_json(item->line) << std::endl;
    ++count;
  }
}

ExitStatus watch_service(const std::string& url, std::span<const std::string> members,
                         const LiveOptions& options, std::ostream& out, std::ostream& err) {
  const auto credentials = credentials_of(options);
  const EndSignals signals;
  Watch watch(members, options);
  rr::Node node(node_options(options));
  rr::SubscriptionOptions how{.username = options.user, .credentials = credentials};
  if (options.timeout) how.connect_timeout = *options.timeout;
  rr::ServiceSubscription service = dynamic::subscribe(node, url, std::move(how));

  bool was_connected = false;
  const auto on_first_failure = [&](const rr::Error& why) {
    if (!was_connected) throw rr::Error(why);
  };
  service
      .on_connected([&](const rr::SubscriptionClientId& client) {
        watch.post([&, client] {
          try {
            // It may have gone meanwhile, and come back, which is told too.
            const auto stub = service.client<rr::Stub>(client);
            if (!stub) return;
            watch.attach(dynamic::Object::of(stub));
            if (was_connected) err << "robdef: connected again" << std::endl;
            was_connected = true;
          } catch (const rr::Error& error) {
            on_first_failure(error);
            err << "robdef: " << rr::printable(error.what(), longest_message) << std::endl;
          }
        });
      })
      .detach();
  service
      .on_disconnected([&](const rr::SubscriptionClientId&, const rr::Error& why) {
        watch.post([&, why] {
          err << "robdef: connection lost, trying again: "
              << rr::printable(why.what(), longest_message) << std::endl;
        });
      })
      .detach();
  service
      .on_failed([&](const std::vector<std::string>&, const rr::Error& why) {
        watch.post([&, why] { on_first_failure(why); });
      })
      .detach();

  try {
    watch.run(signals, out);
  } catch (...) {
    watch.close();
    throw;
  }
  watch.close();
  return exit_fine;
}

}  // namespace robdef::live
