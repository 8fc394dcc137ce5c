// SPDX-License-Identifier: Apache-2.0
#include "cli/live/top.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <ostream>
#include <rr/dynamic.hpp>
#include <rr/error.hpp>
#include <rr/mutex.hpp>
#include <rr/printable.hpp>
#include <rr/url.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "cli/live/commands.hpp"
#include "cli/live/connection.hpp"
#include "cli/live/members.hpp"
#include "cli/live/node_metrics.hpp"
#include "cli/live/object_path.hpp"
#include "cli/system/end_signals.hpp"
#include "cli/system/terminal.hpp"

namespace robdef::live {
namespace {

namespace dynamic = rr::dynamic;
using Clock = std::chrono::steady_clock;
using dynamic::MemberDescription;
using dynamic::Value;
using rr::MemberKind;

// Of the newest value, in columns.
constexpr std::size_t longest_value = 60;

/// One member: what has come of it. Handlers of the node's threads write.
class Row {
 public:
  Row(std::string path, MemberDescription description)
      : path_(std::move(path)), description_(std::move(description)) {}

  void take(std::string value) {
    const rr::MutexLock lock(mutex_);
    ++count_;
    newest_ = std::move(value);
  }
  struct Now {
    std::uint64_t count = 0;
    std::string newest;
  };
  [[nodiscard]] Now now() const {
    const rr::MutexLock lock(mutex_);
    return {count_, newest_};
  }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const MemberDescription& description() const { return description_; }

 private:
  const std::string path_;
  const MemberDescription description_;
  mutable rr::Mutex mutex_;
  std::uint64_t count_ RR_GUARDED_BY(mutex_) = 0;
  std::string newest_ RR_GUARDED_BY(mutex_);
};

// JSON of a peer's value, of one line, for a column.
std::string shortened(const std::string& json) {
  const std::string text = rr::printable_json(json);
  return text.size() <= longest_value ? text : rr::printable(text, longest_value);
}

bool sends(const MemberDescription& member) {
  if (member.kind == MemberKind::event) return true;
  const bool is_stream = member.kind == MemberKind::wire || member.kind == MemberKind::pipe;
  return is_stream && (member.access & rr::writeonly) == 0;
}

/// What is connected at the newest connection.
class Ends {
 public:
  ~Ends() { close(); }
  void attach(const dynamic::Object& object, const std::shared_ptr<Row>& row) {
    const MemberDescription& member = row->description();
    const auto take = [row, type = member.type](const Value& value) {
      row->take(type.to_json(value));
    };
    if (member.kind == MemberKind::wire) {
      wires_.push_back(object.wire(member.name).connect());
      handlers_.push_back(
          wires_.back().on_in([take](const Value& value, const rr::TimeSpec&) { take(value); }));
    } else if (member.kind == MemberKind::pipe) {
      pipes_.push_back(object.pipe(member.name).connect());
      handlers_.push_back(pipes_.back().on_packet(take));
    } else {
      objects_.push_back(object);
      handlers_.push_back(
          object.on_event(member.name, [row](const dynamic::List&) { row->take(""); }));
    }
  }
  void close() {
    handlers_.clear();
    for (dynamic::WireConnection& wire : wires_) wire.close();
    for (dynamic::PipeEndpoint& pipe : pipes_) pipe.close();
    wires_.clear();
    pipes_.clear();
    objects_.clear();
  }

 private:
  std::vector<rr::Subscription> handlers_;
  std::vector<dynamic::WireConnection> wires_;
  std::vector<dynamic::PipeEndpoint> pipes_;
  std::vector<dynamic::Object> objects_;  // of events, which last as long
};

/// The rows of the table, kept from one connection to the next.
class Members {
 public:
  /// Throws rr::Error.
  void attach(const dynamic::Object& root, std::span<const std::string> wanted, Ends& ends) {
    if (wanted.empty()) {
      for (const MemberDescription& member : root.members()) {
        if (sends(member)) ends.attach(root, row_of(member.name, member));
      }
      return;
    }
    for (const std::string& text : wanted) {
      const MemberPath path = parse_member_path(text);
      const dynamic::Object object = object_at(root, path.object);
      const MemberDescription member = object.member(path.member);
      if (!sends(member)) {
        throw rr::Error(rr::ErrorCode::member_format_mismatch,
                        "member " + text + " sends nothing: a wire, a pipe or an event does");
      }
      ends.attach(object, row_of(text, member));
    }
  }
  [[nodiscard]] const std::vector<std::shared_ptr<Row>>& rows() const { return rows_; }

 private:
  std::shared_ptr<Row> row_of(const std::string& path, const MemberDescription& member) {
    for (const auto& row : rows_) {
      if (row->path() == path) return row;
    }
    return rows_.emplace_back(std::make_shared<Row>(path, member));
  }

  std::vector<std::shared_ptr<Row>> rows_;
};

std::string duration_text(double seconds) {
  if (seconds > 1e6) return "> 10 s";
  if (seconds >= 1) return fmt::format("<= {:.1f} s", seconds);
  return seconds >= 1e-3 ? fmt::format("<= {:g} ms", seconds * 1e3)
                         : fmt::format("<= {:g} us", seconds * 1e6);
}

std::string bytes_text(double bytes) {
  if (bytes >= 1e6) return fmt::format("{:.1f} MB/s", bytes / 1e6);
  return bytes >= 1e3 ? fmt::format("{:.1f} kB/s", bytes / 1e3) : fmt::format("{:.0f} B/s", bytes);
}

/// The line about the node, from one look to the next.
class NodeLine {
 public:
  explicit NodeLine(const std::string& url) : url_(url), service_(rr::Url::parse(url).service) {
    before_ = ask_for_metrics(url_);
  }

  // A node that tells nothing is not asked again: it would log each request.
  std::string text(double seconds) {
    if (!before_) return "the node tells no metrics (--robotraconteur-metrics)";
    auto now = ask_for_metrics(url_);
    if (!now) return "the node does not answer";
    const auto rate = [&](double before, double after) {
      return std::max(0.0, after - before) / seconds;
    };
    const auto sum = [&](const char* name) { return rate(before_->sum(name), now->sum(name)); };
    const auto bytes = [&](const std::string& direction) {
      const std::string sample = "robdef_message_bytes_total{direction=\"" + direction + "\"}";
      return bytes_text(rate(before_->value(sample), now->value(sample)));
    };
    const auto slowest = latency(*before_, *now, 0.95);
    std::string line = fmt::format(
        "clients {:.0f}, requests {:.1f}/s, errors {:.1f}/s, 95 % in {}, sent {}, received {}",
        now->value("robdef_server_sessions{robdef_service=\"" + service_ + "\"}"),
        sum("robdef_server_requests_total"), sum("robdef_server_errors_total"),
        slowest ? duration_text(*slowest) : "-", bytes("sent"), bytes("received"));
    before_ = std::move(now);
    return line;
  }

 private:
  const std::string url_;
  const std::string service_;
  std::optional<NodeMetrics> before_;
};

/// Prints the table; rates are those since it was printed last.
class Table {
 public:
  Table(const Members& members, std::ostream& out)
      : members_(members),
        out_(out),
        is_terminal_(&out == &std::cout && system::writes_to_terminal()) {}

  void print(const std::string& head, double seconds) {
    constexpr const char* clear_screen = "\x1b[H\x1b[J";
    if (is_terminal_) out_ << clear_screen;
    std::size_t width = 6;
    for (const auto& row : members_.rows()) width = std::max(width, row->path().size());
    out_ << head << "\n\n"
         << fmt::format("{:<{}}  {:<5}  {:>9}  {:>10}  {}\n", "MEMBER", width, "KIND", "PER SECOND",
                        "COUNT", "NEWEST");
    counts_.resize(members_.rows().size());
    for (std::size_t i = 0; i != counts_.size(); ++i) {
      const Row& row = *members_.rows()[i];
      const Row::Now now = row.now();
      const double rate = static_cast<double>(now.count - counts_[i]) / seconds;
      counts_[i] = now.count;
      out_ << fmt::format("{:<{}}  {:<5}  {:>10.1f}  {:>10}  {}", row.path(), width,
                          kind_of(row.description()), rate, now.count, shortened(now.newest))
           << '\n';
    }
    out_ << (is_terminal_ ? "" : "\n") << std::flush;
  }

 private:
  const Members& members_;
  std::ostream& out_;
  const bool is_terminal_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace

ExitStatus top(const std::string& url, std::span<const std::string> members,
               const LiveOptions& options, std::ostream& out) {
  const EndSignals signals;
  Connection connection(options, url);
  Members rows;
  Ends ends;
  rows.attach(connection.root(), members, ends);
  NodeLine node(url);
  Table table(rows, out);
  const std::chrono::milliseconds period = options.period.value_or(std::chrono::seconds(1));
  const auto begin = Clock::now();
  auto last = begin;
  std::uint64_t printed = 0;
  while (out && !signals.has_come() && (!options.limit || printed < *options.limit)) {
    constexpr std::chrono::milliseconds turn{100};  // signals are looked for so often
    if (options.duration && Clock::now() - begin >= *options.duration) break;
    if (Clock::now() - last < period) {
      std::this_thread::sleep_for(std::min(turn, period));
      continue;
    }
    std::string state = "connected";
    if (!connection.is_open()) {
      try {
        ends.close();
        connection.connect();
        rows.attach(connection.root(), members, ends);
        state = "connected again";
      } catch (const rr::Error& error) {
        state = "lost: " + rr::printable(error.message());
      }
    }
    const auto now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - std::exchange(last, now)).count();
    table.print(rr::printable(url) + "  " + state + "\n" + node.text(seconds), seconds);
    ++printed;
  }
  ends.close();
  return exit_fine;
}

}  // namespace robdef::live
