// SPDX-License-Identifier: Apache-2.0
// The memory of a connection, as another process may have made it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <vector>

#include "runtime/cpp/src/channel/shared_rings.hpp"

namespace rr::channel {
namespace {

class SharedRingsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
  }
  // What open() says of a memory of this size that begins with these bytes.
  static std::error_code opened(std::vector<std::uint32_t> header, std::size_t size) {
    platform::Descriptor handle;
    std::error_code error;
    const platform::SharedMemory memory = platform::make_shared_memory(size, handle, error);
    EXPECT_TRUE(memory);
    const auto bytes = std::as_bytes(std::span(header));
    std::copy_n(bytes.begin(), std::min(size, bytes.size()), memory.bytes());
    const SharedRings rings = SharedRings::open(handle, error);
    EXPECT_EQ(static_cast<bool>(rings), !error);
    return error;
  }
  // As the page has it; "RRSHARED", version, kind, size of a ring, where its bytes begin.
  static std::vector<std::uint32_t> header(std::uint32_t ring_size) {
    return {0x48535252, 0x44455241, 1, 1, ring_size, 0x1000};
  }
};

TEST_F(SharedRingsTest, AreThoseOfTheOtherSide) {
  platform::Descriptor handle;
  std::error_code error;
  const SharedRings server = SharedRings::make(8192, handle, error);
  ASSERT_TRUE(server) << error.message();
  EXPECT_EQ(server.size(), 4096U + 2 * 8192U);
  const SharedRings client = SharedRings::open(handle, error);
  ASSERT_TRUE(client) << error.message();
  EXPECT_EQ(client.size(), server.size());
  EXPECT_EQ(client.to_client().size, 8192U);
  client.to_server().words->written = 11;
  client.to_client().words->room = 22;
  EXPECT_EQ(server.to_server().words->written.load(), 11U);
  EXPECT_EQ(server.to_client().words->room.load(), 22U);
  client.to_server().bytes[8191] = std::byte{33};
  client.to_client().bytes[0] = std::byte{44};
  EXPECT_EQ(server.to_server().bytes[8191], std::byte{33});
  EXPECT_EQ(server.to_client().bytes[0], std::byte{44});
  EXPECT_EQ(server.to_server().words->reader.load(), RingReader::Steps::watches);
  EXPECT_EQ(server.to_client().words->reader.load(), RingReader::Steps::runs);
}

// The places that the page names.
TEST_F(SharedRingsTest, HaveTheirWordsWhereThePageSays) {
  platform::Descriptor handle;
  std::error_code error;
  const SharedRings rings = SharedRings::make(4096, handle, error);
  const platform::SharedMemory memory = platform::map_shared_memory(handle, 1 << 20, error);
  ASSERT_TRUE(memory);
  const SharedRing& ring = rings.to_client();
  ring.words->written = 0x0102030405060708;
  ring.words->processor = 0x11121314;
  ring.words->taken = 0x2122232425262728;
  ring.words->reader = 0x31323334;
  ring.words->room = 0x41424344;
  const auto at = [&](std::size_t place) {
    std::uint32_t word = 0;
    std::memcpy(&word, memory.bytes() + place, sizeof word);
    return word;
  };
  EXPECT_EQ(at(0x200), 0x05060708U);
  EXPECT_EQ(at(0x204), 0x01020304U);
  EXPECT_EQ(at(0x208), 0x11121314U);
  EXPECT_EQ(at(0x240), 0x25262728U);
  EXPECT_EQ(at(0x280), 0x31323334U);
  EXPECT_EQ(at(0x2C0), 0x41424344U);
  EXPECT_EQ(at(0x180), RingReader::Steps::watches);
}

TEST_F(SharedRingsTest, AreRefusedWhenTheyAreNotAsThePageSays) {
  constexpr std::size_t right = 4096 + 2 * 4096;
  EXPECT_FALSE(opened(header(4096), right));
  EXPECT_EQ(opened(header(4096), right + 4096), std::errc::invalid_argument);
  EXPECT_EQ(opened(header(8192), right), std::errc::invalid_argument);
  EXPECT_EQ(opened(header(0), 4096), std::errc::invalid_argument);
  EXPECT_EQ(opened(header(4097), right + 2), std::errc::invalid_argument);
  EXPECT_EQ(opened(header(2048), 8192), std::errc::invalid_argument);
  EXPECT_EQ(opened(header(0x80000000), right), std::errc::invalid_argument);
  EXPECT_EQ(opened({}, 4096), std::errc::invalid_argument);
  EXPECT_EQ(opened({}, 10), std::errc::invalid_argument);
  for (std::size_t word = 0; word < header(4096).size(); ++word) {
    for (int bit = 0; bit < 32; ++bit) {
      std::vector<std::uint32_t> changed = header(4096);
      changed[word] ^= std::uint32_t{1} << bit;
      EXPECT_EQ(opened(changed, right), std::errc::invalid_argument) << word << ' ' << bit;
    }
  }
}

TEST_F(SharedRingsTest, AreMadeOfPowersOfTwo) {
  platform::Descriptor handle;
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{100}, std::size_t{5000}, 2 * SharedRings::largest_ring}) {
    std::error_code error;
    EXPECT_FALSE(SharedRings::make(size, handle, error));
    EXPECT_EQ(error, std::errc::invalid_argument);
  }
}

}  // namespace
}  // namespace rr::channel
