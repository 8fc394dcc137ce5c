// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <stdexcept>

#include "runtime/cpp/src/client/stub_cache.hpp"

namespace rr::client {
namespace {

class LampStub : public Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override {
    throw std::logic_error("nobody asks for the type");
  }
};

std::shared_ptr<Stub> make_stub() { return std::make_shared<LampStub>(); }

TEST(StubCache, HasOneStubForAPath) {
  StubCache cache;
  const auto first = make_stub();
  EXPECT_EQ(cache.keep("room.lamp", first), first);
  EXPECT_EQ(cache.keep("room.lamp", make_stub()), first);
  EXPECT_EQ(cache.find("room.lamp"), first);
  EXPECT_EQ(cache.find("room"), nullptr);
}

TEST(StubCache, OwnsNone) {
  StubCache cache;
  auto stub = make_stub();
  cache.keep("room.lamp", stub);
  stub.reset();
  EXPECT_EQ(cache.find("room.lamp"), nullptr);
  stub = make_stub();
  EXPECT_EQ(cache.keep("room.lamp", stub), stub);
}

TEST(StubCache, WhatIsReleasedIsNotFoundAndAllBelowIsNotButTheRoot) {
  StubCache cache;
  const auto root = make_stub();
  const auto lamp = make_stub();
  const auto bulb = make_stub();
  const auto lamps = make_stub();
  cache.keep("room", root);
  cache.keep("room.lamp", lamp);
  cache.keep("room.lamp.bulb", bulb);
  cache.keep("room.lamps", lamps);
  cache.release("room.lamp", "room");
  EXPECT_EQ(cache.find("room"), root);
  EXPECT_EQ(cache.find("room.lamp"), nullptr);
  EXPECT_EQ(cache.find("room.lamp.bulb"), nullptr);
  EXPECT_EQ(cache.find("room.lamps"), lamps);
  cache.release("room", "room");
  EXPECT_EQ(cache.find("room"), root);
  EXPECT_EQ(cache.find("room.lamps"), nullptr);
}

// The answer told the type of what was there before.
TEST(StubCache, AnAnswerFromBeforeTheReleaseIsNotKept) {
  StubCache cache;
  const StubCache::Lookup lamp(cache, "room.lamp");
  const StubCache::Lookup bulb(cache, "room.lamp.bulb");
  const StubCache::Lookup other(cache, "room.other");
  cache.release("room.lamp", "room");
  EXPECT_EQ(cache.keep(lamp, make_stub()), nullptr);
  EXPECT_EQ(cache.keep(bulb, make_stub()), nullptr);
  EXPECT_EQ(cache.find("room.lamp"), nullptr);
  const auto stub = make_stub();
  EXPECT_EQ(cache.keep(other, stub), stub);
  const StubCache::Lookup again(cache, "room.lamp");
  EXPECT_EQ(cache.keep(again, stub), stub);
  EXPECT_EQ(cache.find("room.lamp"), stub);
}

TEST(StubCache, ALookupThatHasEndedIsNotMarked) {
  StubCache cache;
  { const StubCache::Lookup lookup(cache, "room.lamp"); }
  cache.release("room.lamp", "room");
  const auto stub = make_stub();
  const StubCache::Lookup lookup(cache, "room.lamp");
  EXPECT_EQ(cache.keep(lookup, stub), stub);
  cache.clear();
  EXPECT_EQ(cache.find("room.lamp"), nullptr);
}

}  // namespace
}  // namespace rr::client
