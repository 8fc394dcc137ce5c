// SPDX-License-Identifier: Apache-2.0
// What clients send is looked at when it comes.
#include <gtest/gtest.h>

#include <cstddef>

#include "runtime/c/test/handles.hpp"

namespace rr::testing::c {
namespace {

// One wire, whose values are doubles.
struct Checked {
  explicit Checked(std::size_t member_size = sizeof(rr_member)) {
    ::rr_definition* definition = nullptr;
    rr_definition_new(view("service test.checked\nobject Checked\n  wire double level\nend\n"),
                      nullptr, 0, &definition, nullptr);
    const DefinitionHandle definition_owner(definition);
    rr_member member{};
    member.name = view("level");
    member.kind = RR_WIRE;
    member.check_context = this;
    member.check = [](void* context, const rr_elements* value) -> rr_status {
      ++static_cast<Checked*>(context)->looked;
      unpacked element{};
      const bool is_double = unpack(value, nullptr, &element) != 0 && element.type == 1;
      return is_double ? RR_OK : RR_DATA_TYPE_MISMATCH;
    };
    rr_object_type* type = nullptr;
    rr_object_type_new(definition, view("Checked"), &member, 1, member_size, &type, nullptr);
    const TypeHandle type_owner(type);
    rr_object_handler handler{};
    handler.size = sizeof handler;
    handler.on_request = [](void*, rr_request* request, const rr_request_info*) {
      rr_request_release(request);
    };
    rr_served_object* made = nullptr;
    rr_served_object_new(type, &handler, &made, nullptr);
    object.reset(made);
    rr_service* offered = nullptr;
    rr_service_register(server.get(), view("checked"), made, nullptr, &offered, nullptr);
    service.reset(offered);
    client = connect(node, listen(server), "checked");
    root = root_of(client);
  }
  rr_status poke(Packed& value) {
    return rr_wire_poke_out(root.get(), view("level"), &value, nullptr, nullptr);
  }

  std::atomic<int> looked = 0;
  NodeHandle server = make_node();
  NodeHandle node = make_node();
  ServedHandle object;
  ServiceHandle service;
  ClientHandle client;
  ObjectHandle root;
};

TEST(Checks, RefuseWhatIsNotOfTheMembersType) {
  Checked checked;
  Packed right;
  right.number("", 2.5);
  Packed wrong;
  wrong.words("", "two and a half");
  EXPECT_EQ(checked.poke(right), RR_OK);
  EXPECT_EQ(checked.poke(wrong), RR_DATA_TYPE_MISMATCH);
  rr_data* data = nullptr;
  ASSERT_EQ(rr_wire_peek_out(checked.root.get(), view("level"), nullptr, &data, nullptr, nullptr),
            RR_OK);
  const DataHandle value(data);
  const rr_elements elements = rr_data_elements(data);
  EXPECT_EQ(unpack_double(&elements, nullptr), 2.5);
  EXPECT_EQ(checked.looked, 2);
}

// A table of version 1.0 of the interface.
TEST(Checks, AreNotMadeForProgramsThatKnowNoneOfThem) {
  Checked checked(offsetof(rr_member, check));
  Packed any;
  any.words("", "two and a half");
  EXPECT_EQ(checked.poke(any), RR_OK);
  EXPECT_EQ(checked.looked, 0);
}

}  // namespace
}  // namespace rr::testing::c
