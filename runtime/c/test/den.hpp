// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <string>

#include "runtime/c/test/handles.hpp"

namespace rr::testing::c {

/// An object whose child is each client's own, and which has a memory of pods.
class Den {
 public:
  Den() {
    ::rr_definition* definition = nullptr;
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
    rr_object_type* table = nullptr;
    rr_object_type_new(definition, view("Den"), members, 3, sizeof(rr_member), &table, nullptr);
    type.reset(table);
    root = make();
    rr_service_register(server.get(), view("den"), root.get(), nullptr, nullptr, nullptr);
    port = listen(server);
  }

  std::atomic<int> made = 0;
  std::atomic<int> released = 0;
  std::atomic<int> entered = 0;
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
    handler.on_monitor_enter = [](void* context, std::int32_t) {
      return static_cast<Den*>(context)->entered.exchange(1) == 0 ? 1 : 0;
    };
    handler.on_monitor_exit = [](void* context) { static_cast<Den*>(context)->entered = 0; };
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

}  // namespace rr::testing::c
