// SPDX-License-Identifier: Apache-2.0
#include "cli/inspect_summary.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/output/json.hpp"
#include "runtime/cpp/src/replay/words.hpp"

namespace robdef {
namespace {

using Nanoseconds = std::chrono::nanoseconds;

// The smallest time that `share` of all do not exceed.
Nanoseconds quantile(std::vector<Nanoseconds> times, double share) {
  if (times.empty()) return Nanoseconds(0);
  const double rank = std::ceil(share * static_cast<double>(times.size()));
  const auto place = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(times.begin(), times.begin() + place, times.end());
  return times[static_cast<std::size_t>(place)];
}

double milliseconds(Nanoseconds time) { return static_cast<double>(time.count()) / 1e6; }

std::string full_name(const std::string& type, const std::string& place) {
  return place.empty() ? type : type + " " + place;
}

bool is_request(rr::EntryType type) { return static_cast<unsigned>(type) % 2 == 1; }

rr::Direction back(rr::Direction direction) {
  return direction == rr::Direction::to_service ? rr::Direction::to_client
                                                : rr::Direction::to_service;
}

}  // namespace

void Summary::add(const rr::Record& record) {
  if (const auto* message = std::get_if<rr::RecordedMessage>(&record.what)) {
    add(record, *message);
  } else if (const auto* lost = std::get_if<rr::MessagesLost>(&record.what)) {
    lost_.count += lost->count;
    lost_.bytes += lost->bytes;
  } else if (std::holds_alternative<rr::ConnectionOpened>(record.what)) {
    ++connections_;
  } else if (std::holds_alternative<rr::MessageReplaced>(record.what)) {
    ++replaced_;
  }
}

void Summary::add(const rr::Record& record, const rr::RecordedMessage& message) {
  if (all_.count++ == 0) first_ = record.time;
  last_ = record.time;
  all_.bytes += message.bytes.size();
  rr::MessageTree tree;
  if (!rr::read_tree(message.bytes, tree) || tree.entries.empty()) {
    ++malformed_.count;
    malformed_.bytes += message.bytes.size();
    return;
  }
  // The bytes of a message are those of its first entry: there is hardly ever another one.
  std::uint64_t bytes = message.bytes.size();
  for (const rr::EntryTree& entry : tree.entries) {
    Traffic& traffic = traffic_[{entry.type, rr::replay::place_of(entry)}];
    ++traffic.count;
    traffic.bytes += std::exchange(bytes, 0);
    if (entry.request_id != 0) match(record, message, tree, entry);
  }
}

void Summary::match(const rr::Record& record, const rr::RecordedMessage& message,
                    const rr::MessageTree& tree, const rr::EntryTree& entry) {
  // The service's endpoint is not known to the first requests, so only the client's names them.
  const bool to_service = message.direction == rr::Direction::to_service;
  const std::uint32_t client = to_service ? tree.sender_endpoint : tree.receiver_endpoint;
  if (is_request(entry.type)) {
    open_requests_[{record.connection, message.direction, client, entry.request_id}] = {
        {entry.type, rr::replay::place_of(entry)}, record.time};
    return;
  }
  const auto asked =
      open_requests_.find({record.connection, back(message.direction), client, entry.request_id});
  if (asked == open_requests_.end()) return;
  Exchange& exchange = exchanges_[asked->second.name];
  exchange.times.push_back(record.time - asked->second.time);
  if (entry.error != 0) ++exchange.errors;
  open_requests_.erase(asked);
}

double Summary::span() const { return static_cast<double>((last_ - first_).count()) / 1e9; }

std::map<Summary::Name, std::uint64_t> Summary::unanswered() const {
  std::map<Name, std::uint64_t> result;
  for (const auto& [key, request] : open_requests_) ++result[request.name];
  return result;
}

std::string Summary::text(std::chrono::system_clock::time_point start) const {
  const double seconds = span();
  std::string text = fmt::format(
      "recorded from {:%Y-%m-%d %H:%M:%S} UTC\n"
      "connections: {}, messages: {}, bytes: {}, seconds: {:.6f}\n",
      fmt::gmtime(std::chrono::system_clock::to_time_t(start)), connections_, all_.count,
      all_.bytes, seconds);
  if (malformed_.count != 0) text += fmt::format("{} of them malformed\n", malformed_.count);
  if (replaced_ != 0) {
    text += fmt::format("{} of them never sent: a newer one took their place\n", replaced_);
  }
  if (lost_.count != 0) {
    text += fmt::format("{} messages of {} bytes are missing: the buffer was full\n", lost_.count,
                        lost_.bytes);
  }
  text += fmt::format("\n{:>9} {:>12} {:>10}  entry\n", "count", "bytes", "per s");
  for (const auto& [name, traffic] : traffic_) {
    const double rate = seconds > 0 ? static_cast<double>(traffic.count) / seconds : 0;
    text += fmt::format("{:>9} {:>12} {:>10.1f}  {}\n", traffic.count, traffic.bytes, rate,
                        full_name(rr::replay::name_of(name.first), name.second));
  }
  text += fmt::format("\n{:>9} {:>9} {:>10} {:>10}  request, times in ms\n", "count", "errors",
                      "p50", "p99");
  for (const auto& [name, exchange] : exchanges_) {
    text += fmt::format("{:>9} {:>9} {:>10.3f} {:>10.3f}  {}\n", exchange.times.size(),
                        exchange.errors, milliseconds(quantile(exchange.times, 0.5)),
                        milliseconds(quantile(exchange.times, 0.99)),
                        full_name(rr::replay::name_of_exchange(name.first), name.second));
  }
  for (const auto& [name, count] : unanswered()) {
    text += fmt::format("{:>9} without an answer                 {}\n", count,
                        full_name(rr::replay::name_of_exchange(name.first), name.second));
  }
  return text;
}

std::string Summary::json() const {
  const double seconds = span();
  JsonWriter json;
  json.begin_object().member("connections", connections_).member("messages", all_.count);
  json.member("bytes", all_.bytes).member("seconds", seconds);
  json.member("malformed", malformed_.count).member("replaced", replaced_);
  json.member("lost", lost_.count);
  json.key("entries").begin_array();
  for (const auto& [name, traffic] : traffic_) {
    json.begin_object().member("name", rr::replay::name_of(name.first));
    json.member("place", name.second).member("count", traffic.count);
    json.member("bytes", traffic.bytes).end_object();
  }
  json.end_array().key("requests").begin_array();
  for (const auto& [name, exchange] : exchanges_) {
    json.begin_object().member("name", rr::replay::name_of_exchange(name.first));
    json.member("place", name.second).member("count", exchange.times.size());
    json.member("errors", exchange.errors);
    json.member("p50_ms", milliseconds(quantile(exchange.times, 0.5)));
    json.member("p99_ms", milliseconds(quantile(exchange.times, 0.99))).end_object();
  }
  json.end_array().key("unanswered").begin_array();
  for (const auto& [name, count] : unanswered()) {
    json.begin_object().member("name", rr::replay::name_of_exchange(name.first));
    json.member("place", name.second).member("count", count).end_object();
  }
  json.end_array().end_object();
  return std::move(json).text();
}

}  // namespace robdef
