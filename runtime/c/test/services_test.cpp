// SPDX-License-Identifier: Apache-2.0
// What a service says and asks: definitions, attributes, users, objects of clients' own, memories
// of pods.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "runtime/c/test/den.hpp"
#include "runtime/c/test/silent_service.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing::c {
namespace {

TEST(Definitions, AreTheServicesOwnTexts) {
  Pair pair("pipes");
  rr_data* made = nullptr;
  ASSERT_EQ(rr_client_definitions(pair.client.get(), &made, nullptr), RR_OK);
  const DataHandle data(made);
  const rr_elements texts = rr_data_elements(made);
  EXPECT_EQ(texts.count, 2U);
  unpacked definition{};
  ASSERT_TRUE(unpack(&texts, "test.pipes", &definition));
  const std::string_view begin(reinterpret_cast<const char*>(definition.payload), 18);
  EXPECT_EQ(begin, "service test.pipes");
  EXPECT_TRUE(unpack(&texts, "test.counter", &definition));
  EXPECT_EQ(text(rr_client_object_type(pair.client.get())), "test.pipes.PipeBoard");
  EXPECT_EQ(text(rr_object_path(pair.root.get())), "pipes");
}

TEST(Definitions, ThatDoNotFitAreRefused) {
  ::rr_definition* definition = nullptr;
  EXPECT_EQ(rr_definition_new(view("nothing here\n"), nullptr, 0, &definition, nullptr),
            RR_SERVICE_DEFINITION_ERROR);
  EXPECT_EQ(rr_definition_new(view("service a.b\nimport c.d\n"), nullptr, 0, &definition, nullptr),
            RR_SERVICE_DEFINITION_ERROR);
  ASSERT_EQ(
      rr_definition_new(view("service a.b\nobject C\nend\n"), nullptr, 0, &definition, nullptr),
      RR_OK);
  const DefinitionHandle owner(definition);
  rr_object_type* type = nullptr;
  EXPECT_EQ(
      rr_object_type_new(definition, view("D"), nullptr, 0, sizeof(rr_member), &type, nullptr),
      RR_SERVICE_DEFINITION_ERROR);
  EXPECT_EQ(
      rr_object_type_new(definition, view("C"), nullptr, 1, sizeof(rr_member), &type, nullptr),
      RR_INVALID_ARGUMENT);
}

TEST(Services, AreToldOfTheirClients) {
  struct State {
    std::atomic<std::uint32_t> came = 0;
    std::atomic<std::uint32_t> went = 0;
  } state;
  rr_service_options options{};
  options.size = sizeof options;
  options.context = &state;
  options.on_client_connected = [](void* context, const rr_client_info* client) {
    static_cast<State*>(context)->came = client->client;
  };
  options.on_client_disconnected = [](void* context, const rr_client_info* client) {
    static_cast<State*>(context)->went = client->client;
  };
  SilentService silent(nullptr, &options);
  ASSERT_NE(state.came, 0U);
  std::uint32_t listed = 0;
  ASSERT_EQ(rr_service_clients(
                silent.service.get(), &listed,
                [](void* context, const rr_client_info* client) {
                  *static_cast<std::uint32_t*>(context) = client->client;
                },
                nullptr),
            RR_OK);
  EXPECT_EQ(listed, state.came);
  EXPECT_EQ(text(rr_service_name(silent.service.get())), "silent");
  rr_service_disconnect(silent.service.get(), listed);
  EXPECT_TRUE(eventually([&] { return state.went == listed; }));
  EXPECT_TRUE(eventually([&] { return rr_client_is_open(silent.client.get()) == 0; }));
}

TEST(Services, AreToldThatAClientLeavesWhileItsRequestIsOpen) {
  struct State {
    std::atomic<std::uint64_t> session = 0;
    std::atomic<std::uint64_t> leaves = 0;
    std::atomic<std::uint64_t> left = 0;
    std::atomic<int> count = 0;
  } state;
  rr_service_options options{};
  options.size = sizeof options;
  options.context = &state;
  options.on_client_connected = [](void* context, const rr_client_info* client) {
    static_cast<State*>(context)->session = client->session;
  };
  options.on_client_disconnected = [](void* context, const rr_client_info* client) {
    auto& of = *static_cast<State*>(context);
    EXPECT_EQ(of.leaves, client->session);
    of.left = client->session;
  };
  options.on_client_leaving = [](void* context, const rr_client_info* client) {
    auto& of = *static_cast<State*>(context);
    of.leaves = client->session;
    ++of.count;
  };
  Done done([](rr_status, void*) {});  // still told when the client ends
  SilentService silent(nullptr, &options);
  rr_completion completion = done.completion();
  ASSERT_EQ(rr_object_call_async(silent.root.get(), RR_FUNCTION_CALL, view("ask"), nullptr, nullptr,
                                 &completion, nullptr),
            RR_OK);
  silent.wait_for_requests(1);
  rr_request* const request = silent.take();
  rr_request_info info{};
  info.size = sizeof info;
  rr_request_read(request, &info);
  EXPECT_NE(info.session, 0U);
  EXPECT_EQ(info.session, state.session);
  rr_service_close(silent.service.get());
  EXPECT_TRUE(eventually([&] { return state.leaves == info.session; }));
  EXPECT_TRUE(eventually([&] { return state.left == info.session; }));
  EXPECT_EQ(state.count, 1);
  rr_request_release(request);
  EXPECT_TRUE(eventually([&] { return rr_client_is_open(silent.client.get()) == 0; }));
}

TEST(Services, TellTheirAttributes) {
  Packed level;
  level.number("level", 2.5);
  packer map{};
  pack_nested(&map, "attributes", PACK_DICTIONARY, nullptr, &level.content());
  rr_service_options options{};
  options.size = sizeof options;
  options.attributes = packed(&map);
  SilentService silent(nullptr, &options);
  packer_free(&map);
  rr_data* made = nullptr;
  ASSERT_EQ(rr_client_attributes(silent.client.get(), &made, nullptr), RR_OK);
  const DataHandle data(made);
  const rr_elements attributes = rr_data_elements(made);
  unpacked items{};
  ASSERT_TRUE(unpack(&attributes, nullptr, &items));
  const rr_elements inner{items.payload, items.size, items.count, attributes.version};
  EXPECT_EQ(unpack_double(&inner, "level"), 2.5);
}

TEST(Users, AreAskedForByTheProgram) {
  rr_users_handler handler{};
  handler.size = sizeof handler;
  handler.on_authenticate = [](void*, rr_request* request, const rr_request_info* info) {
    unpacked map{};
    unpack(&info->arguments, nullptr, &map);
    const rr_elements credentials{map.payload, map.size, map.count, info->arguments.version};
    if (text(info->name) == "alice" && unpack_is_text(&credentials, "password", "open")) {
      const rr_str privileges[] = {view("objectlock")};
      rr_request_answer_user(request, info->name, privileges, 1, nullptr);
    } else {
      rr_error_info why{};
      why.size = sizeof why;
      why.code = RR_AUTHENTICATION_ERROR;
      why.message = view("not you");
      rr_request_fail(request, &why, nullptr);
    }
    rr_request_release(request);
  };
  rr_users* users = nullptr;
  ASSERT_EQ(rr_users_new(&handler, &users, nullptr), RR_OK);
  rr_service_options options{};
  options.size = sizeof options;
  options.users = users;
  rr_connect_options connecting{};
  connecting.size = sizeof connecting;
  connecting.username = view("alice");
  connecting.password = view("open");
  SilentService silent(&connecting, &options);
  rr_users_release(users);
  ASSERT_TRUE(silent.client);
  EXPECT_EQ(rr_object_lock(silent.root.get(), 0, nullptr, nullptr), RR_OK);
  EXPECT_EQ(rr_object_unlock(silent.root.get(), nullptr, nullptr), RR_OK);
  connecting.password = view("shut");
  rr_error* error = nullptr;
  EXPECT_FALSE(connect(silent.node, silent.port, "silent", &connecting, &error));
  ASSERT_NE(error, nullptr);
  rr_error_info info{};
  info.size = sizeof info;
  rr_error_read(error, &info);
  EXPECT_EQ(info.code, RR_AUTHENTICATION_ERROR);
  rr_error_release(error);
}

TEST(Users, MayBeATableOfPasswords) {
  rr_data* hash = nullptr;
  ASSERT_EQ(rr_password_hash(view("open"), &hash, nullptr), RR_OK);
  const rr_elements bytes = rr_data_elements(hash);
  const std::string line =
      "alice " + std::string(reinterpret_cast<const char*>(bytes.data), bytes.size) + " _\n";
  rr_data_release(hash);
  rr_users* users = nullptr;
  EXPECT_EQ(rr_users_from_text(view("alice\n"), &users, nullptr), RR_INVALID_CONFIGURATION);
  ASSERT_EQ(rr_users_from_text(view(line), &users, nullptr), RR_OK);
  rr_service_options options{};
  options.size = sizeof options;
  options.users = users;
  rr_connect_options connecting{};
  connecting.size = sizeof connecting;
  connecting.username = view("alice");
  connecting.password = view("open");
  const SilentService silent(&connecting, &options);
  rr_users_release(users);
  EXPECT_TRUE(silent.client);
}

TEST(Objects, OfAClientsOwnGoWithIt) {
  Den den;
  for (int i = 0; i < 2; ++i) {
    const ClientHandle client = connect(den.node, den.port, "den");
    rr_object* found = nullptr;
    ASSERT_EQ(rr_object_find(root_of(client).get(), view("own"), nullptr, view(""), nullptr, &found,
                             nullptr),
              RR_OK);
    const ObjectHandle own(found);
    EXPECT_EQ(text(rr_object_path(found)), "den.own");
    EXPECT_EQ(call(own, "who", nullptr, nullptr, RR_PROPERTY_GET).status, RR_OK);
    EXPECT_EQ(den.made, 2 + i);
  }
  EXPECT_TRUE(eventually([&] { return den.released == 2; }));
}

TEST(Objects, MayBeHadByOneSessionAlone) {
  Den den;
  const ClientHandle first = connect(den.node, den.port, "den");
  const ClientHandle second = connect(den.node, den.port, "den");
  const ObjectHandle mine = root_of(first);
  const ObjectHandle theirs = root_of(second);
  ASSERT_EQ(rr_object_enter_monitor(mine.get(), RR_NO_LIMIT, nullptr, nullptr), RR_OK);
  EXPECT_EQ(den.entered, 1);
  EXPECT_EQ(call(mine, "who", nullptr, nullptr, RR_PROPERTY_GET).status, RR_OK);
  EXPECT_EQ(call(theirs, "who", nullptr, nullptr, RR_PROPERTY_GET).status, RR_INVALID_OPERATION);
  EXPECT_EQ(rr_object_enter_monitor(theirs.get(), 0, nullptr, nullptr), RR_OPERATION_TIMEOUT);
  ASSERT_EQ(rr_object_exit_monitor(mine.get(), nullptr, nullptr), RR_OK);
  EXPECT_TRUE(eventually([&] { return den.entered == 0; }));
  EXPECT_EQ(call(theirs, "who", nullptr, nullptr, RR_PROPERTY_GET).status, RR_OK);
}

TEST(Memories, OfPodsAreTransferredInPieces) {
  Den den;
  rr_node_options options{};
  options.size = sizeof options;
  options.memory_transfer_limit = 600;  // ten points
  for (const std::uint32_t without : {0U, std::uint32_t{RR_WITHOUT_V4}}) {
    options.client_without = without;
    const NodeHandle node = make_node(&options);
    const ClientHandle client = connect(node, den.port, "den");
    const ObjectHandle root = root_of(client);
    rr_memory_type type{};
    type.element = PACK_POD_ARRAY;
    type.transfer_size = 60;
    const std::uint64_t position[] = {5};
    const std::uint64_t count[] = {25};
    struct State {
      int pieces = 0;
      double sum = 0;
    } state;
    rr_memory_pieces pieces{};
    pieces.size = sizeof pieces;
    pieces.context = &state;
    pieces.give = [](void* context, std::uint64_t offset, const std::uint64_t* items, std::size_t,
                     rr_piece* piece) {
      ++static_cast<State*>(context)->pieces;
      packer list{};
      packer data{};
      for (std::uint64_t i = 0; i < items[0]; ++i) {
        packer fields{};
        pack_double(&fields, "x", static_cast<double>(offset + i) + 0.5);
        pack_nested(&list, std::to_string(i).c_str(), 109, nullptr, &fields);
        packer_free(&fields);
      }
      pack_nested(&data, "data", PACK_POD_ARRAY, "test.den.Point", &list);
      const rr_elements elements = packed(&data);
      const rr_status status = rr_piece_set(piece, &elements, nullptr);
      packer_free(&list);
      packer_free(&data);
      return status;
    };
    pieces.take = [](void* context, std::uint64_t, const std::uint64_t* items, std::size_t,
                     const rr_elements* data) {
      auto& of = *static_cast<State*>(context);
      ++of.pieces;
      unpacked array{};
      unpack(data, nullptr, &array);
      EXPECT_EQ(array.count, items[0]);
      const rr_elements list{array.payload, array.size, array.count, data->version};
      for (std::uint64_t i = 0; i < items[0]; ++i) {
        unpacked item{};
        unpack(&list, std::to_string(i).c_str(), &item);
        const rr_elements fields{item.payload, item.size, item.count, data->version};
        of.sum += unpack_double(&fields, "x");
      }
      return rr_status{RR_OK};
    };
    ASSERT_EQ(rr_memory_write_pieces(root.get(), view("points"), &type, position, count, 1, &pieces,
                                     nullptr, nullptr),
              RR_OK);
    EXPECT_EQ(state.pieces, 3);
    EXPECT_EQ(den.points[5], 0.5);
    EXPECT_EQ(den.points[29], 24.5);
    state.pieces = 0;
    ASSERT_EQ(rr_memory_read_pieces(root.get(), view("points"), &type, position, count, 1, &pieces,
                                    nullptr, nullptr),
              RR_OK);
    EXPECT_EQ(state.pieces, 3);
    EXPECT_EQ(state.sum, 24 * 25 / 2.0 + 25 * 0.5);
    // The same without waiting, to its end, and to a failure of the program's.
    const auto later = [&](auto begin) {
      std::atomic<int> ended = -1;
      Done done([&](rr_status status, void*) { ended = status; });
      const rr_completion completion = done.completion();
      EXPECT_EQ(begin(root.get(), view("points"), &type, position, count, 1, &pieces, nullptr,
                      &completion, nullptr),
                RR_OK);
      EXPECT_TRUE(eventually([&] { return ended != -1; }));
      return ended.load();
    };
    state.pieces = 0;
    std::fill(std::begin(den.points), std::end(den.points), 0);
    EXPECT_EQ(later(rr_memory_write_pieces_async), RR_OK);
    EXPECT_EQ(state.pieces, 3);
    EXPECT_EQ(den.points[29], 24.5);
    state.pieces = 0;
    state.sum = 0;
    EXPECT_EQ(later(rr_memory_read_pieces_async), RR_OK);
    EXPECT_EQ(state.pieces, 3);
    EXPECT_EQ(state.sum, 24 * 25 / 2.0 + 25 * 0.5);
    pieces.take = [](void*, std::uint64_t, const std::uint64_t*, std::size_t, const rr_elements*) {
      return rr_status{RR_DATA_TYPE_ERROR};
    };
    EXPECT_EQ(later(rr_memory_read_pieces_async), RR_DATA_TYPE_ERROR);
    EXPECT_EQ(rr_memory_read_pieces(root.get(), view("points"), &type, position, count, 1, &pieces,
                                    nullptr, nullptr),
              RR_DATA_TYPE_ERROR);
  }
}

}  // namespace
}  // namespace rr::testing::c
