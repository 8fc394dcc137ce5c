// SPDX-License-Identifier: Apache-2.0
// Every type of entry in every state of a session. What is expected was written down from the
// specification (07, sections 1, 2, 6, 8, 11, 13 and 14), not from the runtime's table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/cpp/src/node/testing/guarded_client.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

enum State : std::size_t {
  unconnected,
  before_login,
  logged_in,
  logged_out,
  other_user,    // another one has logged in in the same session
  other_client,  // what another client has opened, and objects that are each client's own
  released,      // the object was released after it had been used
  locked,        // by another user, after it had been used
  state_count,
};
constexpr std::array<const char*, state_count> state_names{
    "unconnected", "before login", "logged in", "logged out",
    "other user",  "other client", "released",  "locked"};

// What the session was given before its state changed.
struct Opened {
  std::int32_t pipe = 1;
  std::int32_t generator = 1;
};

struct Situation {
  explicit Situation(State state) {
    path = state == other_client ? "guarded.own" : "guarded.child[a]";
    if (state == unconnected) {
      client.emplace(service);
      return;
    }
    if (state == other_client) {
      // What alice has, bob asks for by the same names and numbers.
      first.emplace(service, "alice");
      open(*first);
      client.emplace(service, "bob");
      return;
    }
    client.emplace(service, state == before_login ? "" : "alice");
    if (state == before_login) {
      object = service.object;
      return;
    }
    open(*client);
    if (state == logged_out) client->log_out();
    if (state == other_user) client->log_in("bob");
    if (state == released) service.service->release_path(path);
    if (state == locked) {
      first.emplace(service, "bob");
      EXPECT_EQ(first->operation("RequestObjectLock", path), 0);
    }
    client->settle();
  }
  void open(GuardedClient& by) {
    EXPECT_EQ(by.ask(EntryType::property_get_req, path, "value"), 0);
    object = service.object->last_child;
    EXPECT_EQ(by.connect_wire(path), 0);
    opened.pipe = by.connect_pipe(path);
    opened.generator = by.open_generator(path);
  }

  GuardedService service;
  std::string path;
  std::optional<GuardedClient> first;
  std::optional<GuardedClient> client;  // the one that asks
  std::shared_ptr<Guarded> object;      // that what is opened belongs to
  Opened opened;
};

constexpr int silence = -1;

struct Row {
  const char* name;
  EntryType type;
  const char* member;
  std::function<RawClient::Elements(const Situation&)> elements;
  // Codes of answers in the order of the states.
  std::array<int, state_count> expected;
  bool is_of_service = false;  // the path is that of the service
};

RawClient::Elements nothing(const Situation&) { return nullptr; }

RawClient::Elements index_of_pipe(const Situation& situation) {
  return element("index", situation.opened.pipe);
}
RawClient::Elements index_of_generator(const Situation& situation) {
  return element("index", situation.opened.generator);
}
RawClient::Elements any_index(const Situation&) { return element<std::int32_t>("index", -1); }
RawClient::Elements value(const Situation&) { return element("value", 1.0); }
RawClient::Elements text(const Situation&) { return element<std::string>("what", "x"); }
RawClient::Elements timed(const Situation&) { return GuardedClient::wire_value(1'000'000'000); }
RawClient::Elements part(const Situation&) {
  return [](Writer& writer) {
    const std::uint64_t one = 1;
    const std::uint64_t zero = 0;
    type_of<std::uint64_t>.write(writer, "count", &one);
    type_of<std::uint64_t>.write(writer, "memorypos", &zero);
    return 2U;
  };
}
RawClient::Elements part_with_data(const Situation&) {
  return [](Writer& writer) {
    const std::uint64_t one = 1;
    const std::uint64_t zero = 0;
    const Array<double> data{1.0};
    type_of<Array<double>>.write(writer, "data", &data);
    type_of<std::uint64_t>.write(writer, "count", &one);
    type_of<std::uint64_t>.write(writer, "memorypos", &zero);
    return 3U;
  };
}
RawClient::Elements length(const Situation&) { return element<std::string>("parameter", "Length"); }
RawClient::Elements alice(const Situation&) {
  return [](Writer& writer) {
    const VarStringMap credentials{{"password", std::string("alice")}};
    const std::string name = "alice";
    type_of<VarStringMap>.write(writer, "credentials", &credentials);
    type_of<std::string>.write(writer, "username", &name);
    return 2U;
  };
}
RawClient::Elements at_once(const Situation&) { return element<std::int32_t>("timeout", 0); }

// 150: "every other entry of an unauthenticated client on a service with requirevaliduser".
const std::vector<Row>& requests() {
  constexpr int S = silence;  // NOLINT(readability-identifier-naming): as wide as a code
  using enum EntryType;
  static const std::vector<Row> rows{
      //                                                    un- bef. in   out  user cli. rel. locked
      {"PropertyGet", property_get_req, "value", nothing, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"PropertySet", property_set_req, "value", value, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"nolock get", property_get_req, "free", nothing, {S, 150, 0, 150, 0, 0, 0, 0}},
      {"FunctionCall", function_call_req, "run", text, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"generator", function_call_req, "count", nothing, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"GeneratorNext",
       generator_next_req,
       "count",
       index_of_generator,
       {S, 150, 0, 150, 17, 17, 17, 151}},
      {"GeneratorNext of a nolock name",
       generator_next_req,
       "free",
       index_of_generator,
       {S, 150, 0, 150, 17, 17, 17, 151}},
      {"PipeConnect", pipe_connect_req, "samples", any_index, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"PipeDisconnect",
       pipe_disconnect_req,
       "samples",
       index_of_pipe,
       {S, 150, 0, 150, 18, 18, 18, 151}},
      {"WireConnect", wire_connect_req, "level", nothing, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"WireDisconnect", wire_disconnect_req, "level", nothing, {S, 150, 0, 150, 8, 8, 8, 151}},
      {"PeekIn", wire_peek_in_value_req, "level", nothing, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"PeekOut", wire_peek_out_value_req, "level", nothing, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"PokeOut", wire_poke_out_value_req, "level", timed, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"MemoryRead", memory_read, "store", part, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"MemoryWrite", memory_write, "store", part_with_data, {S, 150, 0, 150, 0, 0, 0, 151}},
      {"MemoryGetParam", memory_get_param, "store", length, {S, 150, 0, 150, 0, 0, 0, 151}},
      // Without a session it is a question of anybody, who is told of the root object only.
      {"ObjectTypeName", object_type_name, "", nothing, {4, 150, 0, 150, 0, 0, 0, 0}},
      {"KeepAlive", client_keep_alive_req, "", nothing, {S, 0, 0, 0, 0, 0, 0, 0}, true},
      {"ServiceCapability",
       service_check_capability_req,
       "x",
       nothing,
       {S, 150, 0, 150, 0, 0, 0, 0},
       true},
      {"EndpointCapability",
       endpoint_check_capability,
       "x",
       nothing,
       {S, 150, 0, 150, 0, 0, 0, 0},
       true},
      {"AuthenticateUser",
       client_session_op_req,
       "AuthenticateUser",
       alice,
       {S, 0, 0, 0, 0, 0, 0, 0},
       true},
      {"LogoutUser", client_session_op_req, "LogoutUser", nothing, {S, 0, 0, 0, 0, 0, 0, 0}, true},
      {"RequestObjectLock",
       client_session_op_req,
       "RequestObjectLock",
       nothing,
       {S, 150, 0, 150, 0, 0, 0, 151}},
      {"RequestClientObjectLock",
       client_session_op_req,
       "RequestClientObjectLock",
       nothing,
       {S, 150, 0, 150, 0, 0, 0, 151}},
      {"ReleaseObjectLock",
       client_session_op_req,
       "ReleaseObjectLock",
       nothing,
       {S, 150, 0, 150, 0, 0, 0, 151}},
      {"ReleaseClientObjectLock",
       client_session_op_req,
       "ReleaseClientObjectLock",
       nothing,
       {S, 17, 17, 17, 17, 17, 17, 17}},
      {"MonitorEnter",
       client_session_op_req,
       "MonitorEnter",
       at_once,
       {S, 150, 0, 150, 0, 0, 0, 151}},
      {"MonitorContinueEnter",
       client_session_op_req,
       "MonitorContinueEnter",
       nothing,
       {S, 150, 17, 150, 17, 17, 17, 17}},
      {"MonitorExit", client_session_op_req, "MonitorExit", nothing, {S, 150, 0, 150, 0, 0, 0, 0}},
      {"unknown operation", client_session_op_req, "Nothing", nothing, {S, 2, 2, 2, 2, 2, 2, 2}},
      {"unknown type", static_cast<EntryType>(999), "x", nothing, {S, 150, 2, 150, 2, 2, 2, 2}},
      {"EventReq to the service", event_req, "noticed", value, {S, 150, 2, 150, 2, 2, 2, 2}},
      {"PipeClosed to the service",
       pipe_closed,
       "samples",
       index_of_pipe,
       {S, 150, 2, 150, 2, 2, 2, 2}},
      {"WireClosed to the service", wire_closed, "level", nothing, {S, 150, 2, 150, 2, 2, 2, 2}},
      {"CallbackCall to the service",
       callback_call_req,
       "ask",
       nothing,
       {S, 150, 2, 150, 2, 2, 2, 2}},
  };
  return rows;
}

TEST(AccessWalk, EveryRequestInEveryState) {
  for (const Row& row : requests()) {
    for (std::size_t state = 0; state < state_count; ++state) {
      SCOPED_TRACE(std::string(row.name) + ", " + state_names[state]);
      Situation now(static_cast<State>(state));
      const std::string path = row.is_of_service ? "guarded" : now.path;
      if (row.expected[state] != silence) {
        EXPECT_EQ(now.client->ask(row.type, path, row.member, row.elements(now)),
                  row.expected[state]);
        continue;
      }
      now.client->raw().send(row.type, path, row.member, row.elements(now));
      now.client->raw().send(EntryType::get_node_info, "", "");
      const auto answer = now.client->raw().receive();
      ASSERT_TRUE(answer);
      EXPECT_EQ(answer->type, EntryType::get_node_info_ret);
    }
  }
}

// Packets: who gets them counts, and what is said to the sender.
struct PacketRow {
  const char* name;
  EntryType type;
  const char* member;
  std::function<RawClient::Elements(const Situation&)> elements;
  std::atomic<int> Guarded::*arrived;
  std::array<bool, state_count> arrives;
  std::array<int, state_count> expected;
};

const std::vector<PacketRow>& packets() {
  constexpr int S = silence;  // NOLINT(readability-identifier-naming): as wide as a code
  static const std::vector<PacketRow> rows{
      {"WirePacket",
       EntryType::wire_packet,
       "level",
       timed,
       &Guarded::values,
       {false, false, true, false, false, false, false, true},
       {S, 150, S, 150, S, S, S, S}},
      {"PipePacket",
       EntryType::pipe_packet,
       "samples",
       [](const Situation& now) { return GuardedClient::pipe_packet(now.opened.pipe, 1); },
       &Guarded::packets,
       {false, false, true, false, false, false, false, true},
       {S, 150, S, 150, S, S, S, S}},
  };
  return rows;
}

// Alone in a message, which takes the short way, and with another one, which does not.
TEST(AccessWalk, EveryPacketInEveryState) {
  for (const PacketRow& row : packets()) {
    for (std::size_t state = 0; state < state_count; ++state) {
      for (const bool is_alone : {true, false}) {
        SCOPED_TRACE(std::string(row.name) + ", " + state_names[state] +
                     (is_alone ? "" : ", with another"));
        Situation now(static_cast<State>(state));
        const RawClient::Request packet{row.type, now.path, row.member, row.elements(now), 0};
        const std::array<RawClient::Request, 2> both{packet, packet};
        RawClient& raw = now.client->raw();
        raw.send(is_alone ? std::span(both).first(1) : std::span(both));
        raw.send(EntryType::get_node_info, "", "");
        std::vector<RawClient::Answer> answers;
        while (true) {
          auto some = raw.receive_all();
          ASSERT_FALSE(some.empty());
          if (some.front().type == EntryType::get_node_info_ret) break;
          answers.insert(answers.end(), some.begin(), some.end());
        }
        const std::size_t count = row.expected[state] == silence ? 0 : is_alone ? 1 : 2;
        ASSERT_EQ(answers.size(), count);
        for (const RawClient::Answer& each : answers) EXPECT_EQ(each.error, row.expected[state]);
        const auto has_arrived = [&] { return now.object && (*now.object.*row.arrived) != 0; };
        if (row.arrives[state]) {
          EXPECT_TRUE(eventually(has_arrived));
        } else {
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
          EXPECT_FALSE(has_arrived());
        }
      }
    }
  }
}

// What a service sends without being asked.
struct SentRow {
  const char* name;
  std::function<void(const Guarded&)> send;
  EntryType type;
  std::array<bool, state_count> arrives;
};

TEST(AccessWalk, WhatAServiceSendsInEveryState) {
  //                                     un-    bef.   in    out    user   cli.   rel.   locked
  constexpr std::array<bool, state_count> as_opened{false, false, true,  false,
                                                    false, false, false, true};
  const std::vector<SentRow> rows{
      {"value", [](const Guarded& object) { object.level().set_in(4); }, EntryType::wire_packet,
       as_opened},
      {"value of one connection",
       [](const Guarded& object) {
         for (auto& end : object.level().connections()) end.set_in(4);
       },
       EntryType::wire_packet, as_opened},
      {"packet", [](const Guarded& object) { object.samples().send(4); }, EntryType::pipe_packet,
       as_opened},
      {"packet of one endpoint",
       [](const Guarded& object) {
         for (auto& end : object.samples().endpoints()) end.send(4);
       },
       EntryType::pipe_packet, as_opened},
      // Whoever is logged in hears events of objects of all, opened or not.
      {"event",
       [](const Guarded& object) { object.notice(4); },
       EntryType::event_req,
       {false, false, true, false, true, false, false, true}},
  };
  for (const SentRow& row : rows) {
    for (std::size_t state = before_login; state < state_count; ++state) {
      SCOPED_TRACE(std::string(row.name) + ", " + state_names[state]);
      Situation now(static_cast<State>(state));
      row.send(*now.object);
      const std::vector<EntryType> came = now.client->settle();
      EXPECT_EQ(std::count(came.begin(), came.end(), row.type), row.arrives[state] ? 1 : 0);
    }
  }
}

}  // namespace
}  // namespace rr::testing
