// SPDX-License-Identifier: Apache-2.0
// What a service says and asks: definitions, attributes, users, objects of clients' own, memories
// of pods.
#include <gtest/gtest.h>

#include <cstring>
#include <mutex>

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
  rr_definition* definition = nullptr;
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

// An object whose child is each client's own, and a memory of pods.
class Den {
 public:
  Den() {
    rr_definition* definition = nullptr;
    rr_definition_new(view(definition_text), nullptr, 0, &definition, nullptr);
    const DefinitionHandle definition_owner(definition);
    rr_member members[3] = {};
    members[0].name = view("own");
    members[0].kind = RR_OBJREF;
    members[0].object_type = view("test.den.Den");
    members[1].name = view("points");
    members[1].kind = RR_MEMORY;
    members[1].memory.element = PACK_POD_ARRAY;
    members[1].memory.transfer_size = 60;
    members[2].name = view("who");
    members[2].kind = RR_PROPERTY;
    members[2].access = RR_READONLY;
    rr_object_type* made = nullptr;
    rr_object_type_new(definition, view("Den"), members, 3, sizeof(rr_member), &made, nullptr);
    type.reset(made);
    root = make();
    rr_service_register(server.get(), view("den"), root.get(), nullptr, nullptr, nullptr);
    port = listen(server);
  }

  std::atomic<int> made = 0;
  std::atomic<int> released = 0;
  std::mutex mutex;
  double points[50] = {};
  TypeHandle type;
  ServedHandle root;
  NodeHandle server = make_node();
  NodeHandle node = make_node();
  std::uint16_t port = 0;

 private:
  static constexpr std::string_view definition_text =
      "service test.den\n"
      "stdver 0.10\n"
      "pod Point\n"
      "  field double x\n"
      "end\n"
      "object Den\n"
      "  objref Den own\n"
      "  memory Point[] points\n"
      "  property uint32 who [readonly]\n"
      "end\n";

  ServedHandle make() {
    rr_object_handler handler{};
    handler.size = sizeof handler;
    handler.context = this;
    handler.on_request = [](void* context, rr_request* request, const rr_request_info* info) {
      static_cast<Den*>(context)->answer(request, *info);
    };
    handler.on_released = [](void* context, rr_str) { ++static_cast<Den*>(context)->released; };
    rr_served_object* object = nullptr;
    rr_served_object_new(type.get(), &handler, &object, nullptr);
    rr_memory_source source{};
    source.size = sizeof source;
    source.context = this;
    source.dims = [](void*, std::uint64_t* dims, std::size_t, std::size_t* count) {
      dims[0] = 50;
      *count = 1;
      return rr_status{RR_OK};
    };
    source.read_piece = [](void* context, const std::uint64_t* position, const std::uint64_t* count,
                           std::size_t, rr_piece* piece) {
      return static_cast<Den*>(context)->read(position[0], count[0], piece);
    };
    source.write_piece = [](void* context, const std::uint64_t* position,
                            const std::uint64_t* count, std::size_t, const rr_elements* data) {
      return static_cast<Den*>(context)->write(position[0], count[0], data);
    };
    EXPECT_EQ(rr_served_memory_set(object, 1, &source, nullptr), RR_OK);
    ++made;
    return ServedHandle(object);
  }

  void answer(rr_request* request, const rr_request_info& info) {
    if (info.kind == RR_REQUEST_FIND) {
      EXPECT_EQ(rr_request_answer_object(request, make().get(), 1, nullptr), RR_OK);
    } else {
      EXPECT_EQ(info.client, rr_current_client());
      packer value{};
      pack_uint32(&value, "value", info.client);
      const rr_elements elements = packed(&value);
      EXPECT_EQ(rr_request_answer(request, &elements, nullptr), RR_OK);
      packer_free(&value);
    }
    rr_request_release(request);
  }

  rr_status read(std::uint64_t position, std::uint64_t count, rr_piece* piece) {
    const std::lock_guard lock(mutex);
    packer items{};
    packer data{};
    for (std::uint64_t i = 0; i < count; ++i) {
      packer fields{};
      pack_double(&fields, "x", points[position + i]);
      pack_nested(&items, std::to_string(i).c_str(), 109, nullptr, &fields);
      packer_free(&fields);
    }
    pack_nested(&data, "data", PACK_POD_ARRAY, "test.den.Point", &items);
    const rr_elements elements = packed(&data);
    const rr_status status = rr_piece_set(piece, &elements, nullptr);
    packer_free(&items);
    packer_free(&data);
    return status;
  }

  rr_status write(std::uint64_t position, std::uint64_t count, const rr_elements* data) {
    const std::lock_guard lock(mutex);
    unpacked array{};
    unpack(data, nullptr, &array);
    if (array.count != count) return RR_OUT_OF_RANGE;
    const rr_elements items{array.payload, array.size, array.count, data->version};
    for (std::uint64_t i = 0; i < count; ++i) {
      unpacked item{};
      if (!unpack(&items, std::to_string(i).c_str(), &item)) return RR_DATA_TYPE_ERROR;
      const rr_elements fields{item.payload, item.size, item.count, data->version};
      points[position + i] = unpack_double(&fields, "x");
    }
    return RR_OK;
  }
};

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
    EXPECT_EQ(state.sum, 24 * 25 / 2 + 25 * 0.5);
    pieces.take = [](void*, std::uint64_t, const std::uint64_t*, std::size_t, const rr_elements*) {
      return rr_status{RR_DATA_TYPE_ERROR};
    };
    EXPECT_EQ(rr_memory_read_pieces(root.get(), view("points"), &type, position, count, 1, &pieces,
                                    nullptr, nullptr),
              RR_DATA_TYPE_ERROR);
  }
}

}  // namespace
}  // namespace rr::testing::c
