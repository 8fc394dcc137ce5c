// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "runtime/cpp/src/endpoint/ring_terms.hpp"

namespace rr::endpoint {
namespace {

// An entry whose one element `write` writes.
class WrittenRing {
 public:
  explicit WrittenRing(const std::function<void(Writer&)>& write) {
    Writer writer;
    writer.reset(MessageVersion::v4);
    const std::size_t end = writer.position();
    write(writer);
    writer.entry({.type = EntryType::pipe_connect_req}, 1, end);
    writer.message({}, 1);
    bytes_ = writer.copy();
    EXPECT_TRUE(read_message(bytes_, {}, false, message_, entry_));
  }
  template <class Find>
  auto with(const Find& find) const {
    Decoder decoder(message_.version, &message_.strings);
    return find(decoder, entry_);
  }

 private:
  std::vector<std::byte> bytes_;
  Message message_;
  Entry entry_;
};

template <class T>
WrittenRing with_numbers(std::string_view name, ElementType type, const std::vector<T>& numbers) {
  return WrittenRing([&](Writer& writer) {
    const std::size_t end = writer.position();
    writer.prepend_bytes(numbers.data(), numbers.size() * sizeof(T));
    writer.element(name, type, {}, static_cast<std::uint32_t>(numbers.size()), end);
  });
}

auto wish = [](Decoder& decoder, const Entry& entry) {
  return find_ring_wish(decoder, entry, ring_element);
};

TEST(RingTerms, AWishIsOneThatIsKnown) {
  const auto wished = [](std::uint32_t number) {
    return with_numbers<std::uint32_t>(ring_element, ElementType::uint32, {number}).with(wish);
  };
  EXPECT_EQ(wished(0), RingWish::messages);
  EXPECT_EQ(wished(1), RingWish::ring);
  EXPECT_EQ(wished(2), std::nullopt);
  EXPECT_EQ(with_numbers<std::uint32_t>(ring_element, ElementType::uint32, {1, 1}).with(wish),
            std::nullopt);
  EXPECT_EQ(with_numbers<std::uint32_t>(ring_again_element, ElementType::uint32, {1}).with(wish),
            std::nullopt);
}

TEST(RingTerms, AStartIsReadAsItWasWritten) {
  constexpr std::uint64_t large = std::numeric_limits<std::uint64_t>::max();
  const WrittenRing written([](Writer& writer) {
    write_ring(writer, {large, 2, 3, 4, large - 1, 6});
  });
  const channel::PipeRingStart start = written.with(&find_ring);
  EXPECT_EQ(start.id, large);
  EXPECT_EQ(start.position, 2U);
  EXPECT_EQ(start.number, 3U);
  EXPECT_EQ(start.place, 4U);
  EXPECT_EQ(start.turn, large - 1);
  EXPECT_EQ(start.reader, 6U);
}

TEST(RingTerms, AStartOfAnotherSizeIsNone) {
  for (const std::size_t size : {1U, 5U, 7U}) {
    const std::vector<std::uint64_t> numbers(size, 7);
    EXPECT_EQ(with_numbers(ring_element, ElementType::uint64, numbers).with(&find_ring).id, 0U);
  }
  const std::vector<std::uint32_t> small(12, 7);
  EXPECT_EQ(with_numbers(ring_element, ElementType::uint32, small).with(&find_ring).id, 0U);
}

TEST(RingTerms, ANoticeIsReadAsItWasWritten) {
  const WrittenRing written([](Writer& writer) { write_ring_notice(writer, -5); });
  EXPECT_EQ(written.with(&find_ring_notice), -5);
}

TEST(RingTerms, AnotherElementIsNoNotice) {
  for (const std::size_t size : {0U, 2U}) {
    const std::vector<std::uint32_t> numbers(size, 1);
    EXPECT_EQ(with_numbers(ring_element, ElementType::uint32, numbers).with(&find_ring_notice),
              std::nullopt);
  }
  EXPECT_EQ(
      with_numbers<std::uint64_t>(ring_element, ElementType::uint64, {1}).with(&find_ring_notice),
      std::nullopt);
  EXPECT_EQ(with_numbers<std::uint32_t>("1", ElementType::uint32, {1}).with(&find_ring_notice),
            std::nullopt);
}

}  // namespace
}  // namespace rr::endpoint
