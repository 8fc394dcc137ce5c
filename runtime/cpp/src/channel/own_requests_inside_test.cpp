// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rr/error.hpp"
#include "rr/tap.hpp"
#include "runtime/cpp/src/channel/connection_tap.hpp"
#include "runtime/cpp/src/channel/handshake.hpp"
#include "runtime/cpp/src/channel/operations.hpp"
#include "runtime/cpp/src/channel/own_requests.hpp"
#include "runtime/cpp/src/channel/send_queue.hpp"
#include "runtime/cpp/src/channel/testing/quiet_tap.hpp"

namespace rr::channel {
namespace {

// A service's side of a connection that nobody has said anything on.
class OwnRequestsTest : public ::testing::Test {
 protected:
  OwnRequestsTest() { options_.name = "lab"; }

  OwnAnswer answer(EntryType type, std::string_view member, std::string_view receiver_name = {}) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    writer.entry({.type = type, .member = member, .request_id = 7}, 0, writer.position());
    writer.message({.sender_node = client_, .receiver_name = receiver_name}, 1);
    return answer(writer.copy());
  }
  OwnAnswer answer(std::vector<std::byte> request) {
    Message message;
    Entry first;
    EXPECT_TRUE(read_message(request, {}, false, message, first));
    const OwnSide side{options_,           link_,      layers_,   remote_node_,
                       MessageVersion::v2, is_server_, may_share_};
    Writer writer;
    OwnRequests own(side, writer);
    const OwnAnswer result = own.answer(message, first);
    if (must_refuse_) own.refuse(message, first, "not today");
    if (result.is_answer) {
      answer_ = writer.copy();
      EXPECT_TRUE(read_message(answer_, {}, false, answered_, entry_));
    }
    return result;
  }
  std::string text(std::string_view name) {
    Decoder decoder(answered_.version, &answered_.strings);
    Element element;
    const bool is_there =
        find_element(decoder, entry_.elements, entry_.element_count, name, element);
    return is_there ? std::string(element.text()) : std::string();
  }
  [[nodiscard]] ErrorCode error() const { return static_cast<ErrorCode>(entry_.error); }

  const NodeId client_ = NodeId::random();
  NodeOptions options_{.id = NodeId::random()};
  LinkTerms link_ = tcp_terms(options_);
  NodeId remote_node_;
  bool is_server_ = true;
  bool may_share_ = false;
  bool must_refuse_ = false;
  ConnectionTap tap_{options_, false};
  SendQueue sending_{{}, tap_};
  PeerLayers layers_{{.is_server = true}, link_, sending_, nullptr};
  std::vector<std::byte> answer_;
  Message answered_;
  Entry entry_;
};

TEST_F(OwnRequestsTest, AreThoseOfTheConnectionItself) {
  EXPECT_TRUE(is_own(EntryType::stream_op));
  EXPECT_TRUE(is_own(EntryType::connection_test_ret));
  EXPECT_FALSE(is_own(EntryType::property_get_req));
}

TEST_F(OwnRequestsTest, ATestIsAnswered) {
  EXPECT_TRUE(answer(EntryType::connection_test, {}).is_answer);
  EXPECT_EQ(entry_.type, EntryType::connection_test_ret);
  EXPECT_EQ(entry_.request_id, 7U);
}

TEST_F(OwnRequestsTest, AnAnswerIsNot) {
  EXPECT_FALSE(answer(EntryType::connection_test_ret, {}).is_answer);
  EXPECT_FALSE(answer(EntryType::stream_op_ret, create_connection).is_answer);
}

TEST_F(OwnRequestsTest, MemoryIsSharedWhereThatIsAllowed) {
  EXPECT_FALSE(answer(EntryType::stream_op, share_memory).shares_memory);
  EXPECT_EQ(error(), ErrorCode::protocol_error);
  may_share_ = true;
  EXPECT_TRUE(answer(EntryType::stream_op, share_memory).shares_memory);
  EXPECT_EQ(error(), ErrorCode::none);
  EXPECT_EQ(entry_.element_count, 0U);
  must_refuse_ = true;
  EXPECT_TRUE(answer(EntryType::stream_op, share_memory).shares_memory);
  EXPECT_EQ(error(), ErrorCode::out_of_system_resource);
  EXPECT_EQ(text("errorstring"), "not today");
}

TEST_F(OwnRequestsTest, WiresHaveSlotsWhereBothSidesWantThem) {
  may_share_ = true;
  const auto ask = [&](std::uint32_t level) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    const std::size_t end = writer.position();
    write_codes(writer, slots_element, {&level, 1});
    writer.entry({.type = EntryType::stream_op, .member = share_memory}, 1, end);
    writer.message({.sender_node = client_}, 1);
    return answer(writer.copy());
  };
  const auto has_slots = [&] {
    Decoder decoder(answered_.version, &answered_.strings);
    return has_slots_level(decoder, entry_);
  };
  EXPECT_TRUE(ask(slots_level).has_slots);
  EXPECT_TRUE(has_slots());
  EXPECT_FALSE(ask(slots_level + 1).has_slots);
  EXPECT_FALSE(has_slots());
  EXPECT_TRUE(wants_slots(options_));
  options_.tap = std::make_shared<rr::testing::QuietTap>();
  EXPECT_FALSE(wants_slots(options_));
  EXPECT_FALSE(ask(slots_level).has_slots) << "a recording has to have the values";
  EXPECT_FALSE(has_slots());
}

TEST_F(OwnRequestsTest, TheFirstConnectionIsAgreedOn) {
  const OwnAnswer result = answer(EntryType::stream_op, create_connection);
  ASSERT_TRUE(result.agreement.has_value());
  EXPECT_EQ(result.agreement->version, MessageVersion::v2);
  EXPECT_EQ(error(), ErrorCode::none);
  EXPECT_EQ(answered_.sender_node, options_.id);
  EXPECT_EQ(answered_.receiver_node, client_);
}

TEST_F(OwnRequestsTest, AnotherNodeIsNotAgreedWithOnTheSameConnection) {
  remote_node_ = NodeId::random();
  EXPECT_FALSE(answer(EntryType::stream_op, create_connection).agreement.has_value());
  EXPECT_EQ(error(), ErrorCode::node_not_found);
  remote_node_ = client_;  // the same once more
  EXPECT_FALSE(answer(EntryType::stream_op, create_connection).agreement.has_value());
  EXPECT_EQ(error(), ErrorCode::none);
}

TEST_F(OwnRequestsTest, AConnectionForAnotherNodeIsRefused) {
  EXPECT_FALSE(answer(EntryType::stream_op, create_connection, "other").agreement.has_value());
  EXPECT_EQ(error(), ErrorCode::node_not_found);
  EXPECT_TRUE(answer(EntryType::stream_op, create_connection, "lab").agreement.has_value());
}

TEST_F(OwnRequestsTest, WithoutTlsNothingIsAgreedOnWhereItIsRequired) {
  link_.is_tls_required = true;
  EXPECT_FALSE(answer(EntryType::stream_op, create_connection).agreement.has_value());
  EXPECT_EQ(error(), ErrorCode::connection_error);
  EXPECT_EQ(text("errorstring"), "this node serves encrypted connections only");
}

TEST_F(OwnRequestsTest, TlsIsRefusedWithoutACertificate) {
  const OwnAnswer result = answer(EntryType::stream_op, start_tls);
  EXPECT_FALSE(result.begins_tls);
  EXPECT_EQ(error(), ErrorCode::connection_error);
  EXPECT_EQ(text("errorname"), error_name(ErrorCode::connection_error));
}

TEST_F(OwnRequestsTest, TheNodeIdIsToldWithoutAnError) {
  answer(EntryType::stream_op, get_remote_node_id);
  EXPECT_EQ(error(), ErrorCode::none);
  EXPECT_EQ(answered_.sender_node, options_.id);
}

TEST_F(OwnRequestsTest, AnUnknownOperationIsAnError) {
  answer(EntryType::stream_op, "Dance");
  EXPECT_EQ(error(), ErrorCode::protocol_error);
  is_server_ = false;  // a service that asks its client to agree
  answer(EntryType::stream_op, create_connection);
  EXPECT_EQ(error(), ErrorCode::protocol_error);
}

TEST_F(OwnRequestsTest, ATestIsARequestOfTheConnection) {
  const OwnSide side{options_, link_, layers_, remote_node_, MessageVersion::v2, is_server_};
  Writer writer;
  OwnRequests(side, writer).write_test();
  answer_ = writer.copy();
  ASSERT_TRUE(read_message(answer_, {}, false, answered_, entry_));
  EXPECT_TRUE(is_own(entry_.type));
  EXPECT_EQ(answered_.sender_node, options_.id);
}

}  // namespace
}  // namespace rr::channel
