// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <list>

#include "runtime/cpp/src/channel/admission.hpp"
#include "runtime/cpp/src/channel/testing/accepting.hpp"

namespace rr::channel {
namespace {

using rr::testing::Accepting;
using rr::testing::comes_true;
using rr::testing::SocketPair;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::vector<bool> closed(Accepting& accepting, std::size_t count) {
  std::vector<bool> result;
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(accepting.connection(i).is_closed());
  }
  return result;
}

TEST(Admission, TheOldestWithoutASessionGivesWay) {
  Accepting accepting({.max_connections_before_session = 3});
  std::list<SocketPair> peers(5);
  for (SocketPair& peer : peers) {
    accepting.accept(peer);
    if (accepting.admission().size() == 1) accepting.connection(0).set_authorised(true);
  }
  EXPECT_THAT(closed(accepting, 5), ElementsAre(false, true, false, false, false));
  EXPECT_EQ(accepting.admission().size(), 4U);
  EXPECT_EQ(accepting.admission().strangers(), 3U);
  EXPECT_THAT(accepting.warnings(), Contains(HasSubstr("oldest connection without a session")));
}

TEST(Admission, AConnectionThatHasLeftItsSessionIsTheYoungest) {
  Accepting accepting({.max_connections_before_session = 2});
  std::list<SocketPair> peers(4);
  auto peer = peers.begin();
  accepting.accept(*peer++).set_authorised(true);
  accepting.accept(*peer++);
  accepting.connection(0).set_authorised(false);
  accepting.accept(*peer++);
  EXPECT_THAT(closed(accepting, 3), ElementsAre(false, true, false));
  accepting.accept(*peer++);
  EXPECT_THAT(closed(accepting, 4), ElementsAre(true, true, false, false));
}

TEST(Admission, OneAddressHasNoMoreThanItsOwnShare) {
  const auto options = std::make_shared<const NodeOptions>(
      NodeOptions{.max_connections_before_session = 4, .max_connections_per_address = 2});
  const auto admission = std::make_shared<Admission>(options);
  const auto other = admission->enter("10.0.0.1");
  std::list<std::shared_ptr<Admission::Place>> many;
  for (int i = 0; i < 100; ++i) many.push_back(admission->enter("10.0.0.2"));
  EXPECT_EQ(admission->strangers(), 3U);
  EXPECT_TRUE(other->take(nullptr));  // it has its place
  EXPECT_FALSE(many.front()->take(nullptr));
  EXPECT_TRUE(many.back()->take(nullptr));
  many.clear();
  EXPECT_EQ(admission->size(), 1U);
}

TEST(Admission, PlacesOfSessionsAreNotGivenToOthers) {
  Accepting accepting({.max_connections = 2});
  std::list<SocketPair> peers(4);
  auto peer = peers.begin();
  accepting.accept(*peer++).set_authorised(true);
  accepting.accept(*peer++);
  accepting.accept(*peer++).set_authorised(true);  // instead of the second
  EXPECT_THAT(closed(accepting, 3), ElementsAre(false, true, false));
  EXPECT_THROW(accepting.accept(*peer), Error);
  EXPECT_EQ(accepting.admission().size(), 2U);
  accepting.connection(0).close(Error(ErrorCode::connection_error, "the client leaves"));
  EXPECT_TRUE(comes_true([&] { return accepting.admission().size() == 1; }));
}

TEST(Admission, WarnsOnceASecond) {
  Accepting accepting;
  for (int i = 0; i < 1'000; ++i) accepting.admission().warn("too many");
  EXPECT_THAT(accepting.warnings(), SizeIs(1));
}

TEST(Admission, APlaceIsLeftOnce) {
  const auto admission =
      std::make_shared<Admission>(std::make_shared<const NodeOptions>(NodeOptions{}));
  const auto place = admission->enter("10.0.0.1");
  EXPECT_EQ(place->address(), "10.0.0.1");
  EXPECT_EQ(admission->strangers(), 1U);
  place->set_authorised(true);
  EXPECT_EQ(admission->strangers(), 0U);
  EXPECT_EQ(admission->size(), 1U);
  place->set_authorised(false);
  EXPECT_EQ(admission->strangers(), 1U);
  place->leave();
  place->leave();
  EXPECT_EQ(admission->size(), 0U);
}

TEST(Admission, TheOldestStrangerGivesWay) {
  const auto admission =
      std::make_shared<Admission>(std::make_shared<const NodeOptions>(NodeOptions{}));
  EXPECT_FALSE(admission->give_way());
  const auto session = admission->enter("10.0.0.1");
  session->set_authorised(true);
  EXPECT_FALSE(admission->give_way());
  const auto stranger = admission->enter("");
  EXPECT_TRUE(admission->give_way());
  EXPECT_EQ(admission->size(), 1U);
  EXPECT_FALSE(stranger->take(nullptr)) << "the place is another's";
}

}  // namespace
}  // namespace rr::channel
